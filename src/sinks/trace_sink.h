#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "pipeline/runtime/schedule.h"
#include "src/sinks/sink.h"
#include "src/sinks/trace_file.h"

namespace cgsr::sinks {

/// A trace of the run for ui.perfetto.dev: a slice for every frame with its stages inside, what was skipped, overran or faulted, the
/// cycles of the motion loop, and an arrow for what the rings handed over: image (capture to vision), goal (vision to the first cycle that
/// had it) and report (vision to housekeeping).
///
/// Time is that of the images' stamps: a capture is a point at the stamp of its image, and there the frame's slice begins. Stages follow one another
/// with the durations that were measured; in lock-step on a slow machine, where they would reach into the next image, all of a frame
/// shrink alike, and `elapsed_us` says what was measured. An arrow is drawn when both of its ends are known: what was lost on its way has none.
class TraceSink final : public Sink {
 public:
  static Result<std::unique_ptr<TraceSink>> create(const std::string& path, const runtime::Schedule& schedule);

  Result<void> on_image(const ImageReport& report) override;
  Result<void> on_missing_image(const runtime::FrameRecord& record) override;
  Result<void> on_control_cycle(const MotionStatus& status) override;
  Result<void> finish() override { return file_.close(); }

 private:
  /// A frame as it was drawn; its goal waits in sent_ for the cycle that has it.
  struct DrawnFrame {
    MonoTime stamp{};
    MonoTime begin{};
    MonoTime end{};
    std::uint64_t image = 0;
  };
  /// The first cycle that had the goal of an image.
  struct TakenGoal {
    MonoTime stamp{};
    MonoTime cycle{};
  };

  TraceSink(TraceFile file, const runtime::Schedule& schedule) : file_(std::move(file)), schedule_(schedule) {}
  Result<DrawnFrame> add_frame(const runtime::FrameRecord& record);
  Result<void> add_stage(const runtime::StageRecord& stage, const std::string& name, MonoTime begin, Duration shown);
  Result<void> add_capture(const DrawnFrame& frame);
  Result<void> add_report(const DrawnFrame& frame, MonoTime taken_at);
  Result<void> add_events(const DrawnFrame& drawn, const stages::FrameResult& frame);
  Result<void> add_goals();

  TraceFile file_;
  runtime::Schedule schedule_;
  std::uint64_t frames_ = 0;
  MonoTime last_frame_end_{};
  MonoTime last_capture_{};
  MonoTime last_report_{};
  MonoTime last_cycle_{};
  MonoTime last_goal_ = MonoTime::min();
  StopCause cause_ = StopCause::kNone;
  std::deque<DrawnFrame> sent_;  // both in the order of their stamps; either may be known first
  std::deque<TakenGoal> taken_;
};

}  // namespace cgsr::sinks
