#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pipeline/motion/motion_status.h"
#include "pipeline/runtime/frame_record.h"
#include "pipeline/runtime/histogram.h"
#include "pipeline/runtime/schedule.h"

namespace cgsr::sinks {

/// Where the time of a run goes: each stage against its budget, the frame against the time between two images, and the
/// way from the start of an exposure to the first wheel command that was decided on it.
///
/// Threads: one. add does not allocate.
class Profile {
 public:
  explicit Profile(const runtime::Schedule& schedule);

  void add(const runtime::FrameRecord& record);
  void add(const MotionStatus& status);

  /// \return "images", "stages", "frame", "exposure_to_command", "motion" and "stop_causes".
  [[nodiscard]] nlohmann::ordered_json json() const;

 private:
  static constexpr std::size_t kCauses = 16;
  static constexpr int kBins = 20;  ///< of a tenth of the period each; the last one holds all that took longer.

  struct Stage {
    std::string name;
    int budget_us = 0;
    std::uint64_t runs = 0, not_due = 0, skips = 0, overruns = 0, faults = 0, ended_by_budget = 0;
    runtime::Histogram times;
  };

  std::vector<Stage> stages_;
  Duration period_;
  std::uint64_t frames_ = 0, without_image_ = 0, late_ = 0;
  runtime::Histogram frame_times_;
  std::array<std::uint64_t, kBins> frame_bins_{};
  runtime::Histogram to_command_;
  MonoTime last_goal_ = MonoTime::min();
  std::uint64_t cycles_ = 0, late_cycles_ = 0;
  std::array<std::uint64_t, kCauses> causes_{};  ///< control cycles by StopCause.
  MotionStatus last_motion_;
};

/// \param profile  as Profile::json() gives it, with "rings" beside where they are known. \return tables and a histogram
/// for a terminal; what is missing is left out.
std::string profile_text(const nlohmann::ordered_json& profile);

}  // namespace cgsr::sinks
