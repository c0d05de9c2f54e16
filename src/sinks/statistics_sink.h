#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/runtime/stage_table.h"
#include "platform/description.h"
#include "src/sinks/sink.h"

namespace cgsr::sinks {

/// An event and when it happened.
struct EventRecord {
  stages::Event event;
  std::uint64_t image = 0;
  double at_s = 0.0;
};

/// How often a field of an output was what, over the images in which its stage gave a new one.
struct FieldStatistics {
  std::string name;
  Field::Kind kind = Field::Kind::kNumber;
  bool optional = false;
  std::uint64_t images = 0;                    ///< in which it was there; of a flag: in which it was set.
  std::map<std::string, std::uint64_t> words;  ///< of a text or a choice: images by what it said.
};

/// What a described output came to.
struct OutputStatistics {
  std::string_view name;
  std::uint64_t updates = 0;            ///< images in which its stage gave a new one.
  std::string last;                     ///< the last one, as JSON.
  std::vector<FieldStatistics> fields;  ///< as it describes them, without those of lists.
};

/// What a run came to.
struct RunStatistics {
  std::uint64_t frames = 0;
  std::uint64_t without_image = 0;
  std::uint64_t found = 0;
  std::uint64_t control_cycles = 0;
  std::uint64_t cycles_in_motion = 0;  ///< a command other than zero went to the base.
  double fastest_mps = 0.0;
  double fastest_radps = 0.0;
  MotionStatus last_motion;
  stages::PoseEstimate last_pose;
  std::deque<EventRecord> events;         ///< in order: what was said, and the last ones up to kMaxEvents.
  std::uint64_t earlier_events = 0;       ///< that are not among them.
  std::vector<SwitchRecord> switchings;   ///< of lamps, in order.
  std::vector<OutputStatistics> outputs;  ///< in the order of for_each_output.

  static constexpr std::size_t kMaxEvents = 2000;
};

/// Counts what happened in a run, and what each stage took.
class StatisticsSink final : public Sink {
 public:
  explicit StatisticsSink(const runtime::Schedule& schedule) : table_(schedule) {}

  Result<void> on_image(const ImageReport& report) override;
  Result<void> on_missing_image(const runtime::FrameRecord& record) override;
  Result<void> on_control_cycle(const MotionStatus& status) override;
  Result<void> on_switching(const SwitchRecord& record) override;
  void summarize(Summary& summary) override;

  [[nodiscard]] const RunStatistics& run() const { return run_; }
  [[nodiscard]] const runtime::StageTable& table() const { return table_; }

 private:
  void count_outputs(const ImageReport& report);
  void keep_events(const ImageReport& report);

  runtime::StageTable table_;
  RunStatistics run_;
};

}  // namespace cgsr::sinks
