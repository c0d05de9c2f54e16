#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "pipeline/runtime/stage_table.h"
#include "src/sinks/sink.h"

namespace cgsr::sinks {

/// A change of the task's state.
struct TaskStep {
  std::string_view state;
  std::string_view reason;
  std::uint64_t image = 0;
  double at_s = 0.0;
};

/// A check by switching that ended.
struct CheckEnd {
  illumination::CheckedLamp lamp = illumination::CheckedLamp::kProbeLamp;
  illumination::CheckReport report;
  std::uint64_t image = 0;
  double at_s = 0.0;
};

/// What the stages of chapter 5 came to in a run.
struct LampStatistics {
  std::uint64_t looks = 0;                               ///< images whose probes were examined.
  std::map<std::string_view, std::uint64_t> unanswered;  ///< of these, by why they said nothing of a lamp.
  std::uint64_t known = 0;                               ///< images in which a lamp was known.
  std::uint64_t masked = 0;                              ///< images with masks.
  std::optional<illumination::KnownLamp> last;           ///< the last lamp that was known.
};

/// What a described output came to.
struct OutputStatistics {
  std::string_view name;
  std::uint64_t updates = 0;  ///< images in which its stage gave a new one.
  std::string last;           ///< the last one, as JSON.
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
  LampStatistics lamp;
  std::vector<TaskStep> task;             ///< in order.
  std::vector<SwitchRecord> switchings;   ///< of lamps, in order.
  std::vector<CheckEnd> checks;           ///< by switching, in order.
  std::vector<OutputStatistics> outputs;  ///< in the order of for_each_output.
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
  void count_lamp(const ImageReport& report);
  void count_check(const ImageReport& report, illumination::CheckedLamp lamp, const illumination::CheckReport& check);

  runtime::StageTable table_;
  RunStatistics run_;
  std::array<illumination::CheckState, 2> checks_{};  // by CheckedLamp
};

}  // namespace cgsr::sinks
