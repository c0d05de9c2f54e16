#pragma once

#include <memory>
#include <string>

#include "pipeline/runtime/schedule.h"
#include "src/sinks/sink.h"
#include "src/sinks/trace_file.h"

namespace cgsr::sinks {

/// A trace of the run for ui.perfetto.dev: a slice for every frame with its stages inside, what was skipped, overran or faulted, and the
/// cycles of the motion loop.
///
/// Time is that of the images' stamps: a frame's slice begins at the stamp of its image. Stages follow one another with the durations that
/// were measured; in lock-step on a slow machine, where they would reach into the next image, all of a frame shrink alike, and `elapsed_us`
/// says what was measured.
class TraceSink final : public Sink {
 public:
  static Result<std::unique_ptr<TraceSink>> create(const std::string& path, const runtime::Schedule& schedule);

  Result<void> on_image(const ImageReport& report) override { return add_frame(report.record); }
  Result<void> on_missing_image(const runtime::FrameRecord& record) override { return add_frame(record); }
  Result<void> on_control_cycle(const MotionStatus& status) override;
  Result<void> finish() override { return file_.close(); }

 private:
  TraceSink(TraceFile file, const runtime::Schedule& schedule) : file_(std::move(file)), schedule_(schedule) {}
  Result<void> add_frame(const runtime::FrameRecord& record);
  Result<void> add_stage(const runtime::StageRecord& stage, const std::string& name, MonoTime begin, Duration shown);

  TraceFile file_;
  runtime::Schedule schedule_;
  MonoTime last_frame_end_{};
  MonoTime last_cycle_{};
  StopCause cause_ = StopCause::kNone;
};

}  // namespace cgsr::sinks
