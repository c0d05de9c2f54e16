#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/runtime/frame_record.h"
#include "pipeline/runtime/histogram.h"
#include "pipeline/runtime/schedule.h"

namespace cgsr::runtime {

/// One row as people and JSON get it.
struct StageSummary {
  std::string name;
  int budget_us = 0;
  std::uint64_t runs = 0;
  std::uint64_t not_due = 0;
  std::uint64_t skips = 0;
  std::uint64_t overruns = 0;
  std::uint64_t faults = 0;
  std::uint64_t refusals = 0;  ///< runs that the budget ended.
  double mean_us = 0.0;
  double p99_us = 0.0;  ///< at most 1/16 too large.
  double worst_us = 0.0;
};

struct FrameSummary {
  std::uint64_t frames = 0;  ///< without the warm-up.
  std::uint64_t without_image = 0;
  std::uint64_t late = 0;
  double mean_us = 0.0;
  double p99_us = 0.0;
  double worst_us = 0.0;
};

/// The statistics of every stage, summed over the records of frames. The loop's own table sees every frame;
/// housekeeping keeps another from the records that reach it, so that nobody locks the loop to look.
class StageTable {
 public:
  explicit StageTable(const Schedule& schedule);

  /// Adds one frame; a warm-up frame adds nothing. Does not allocate.
  void add(const FrameRecord& record);

  [[nodiscard]] FrameSummary frames() const;
  [[nodiscard]] std::vector<StageSummary> stages() const;

 private:
  struct Row {
    StageSummary counts;  ///< its times are filled in by stages().
    Histogram times;
  };
  std::vector<Row> rows_;
  FrameSummary frames_;
  Histogram frame_times_;
};

/// \return the table as text: a line per stage, the frames below.
std::string to_text(const StageTable& table);

}  // namespace cgsr::runtime
