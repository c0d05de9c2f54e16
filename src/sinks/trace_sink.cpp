#include "src/sinks/trace_sink.h"

#include <algorithm>
#include <utility>

namespace cgsr::sinks {
namespace {

constexpr int kVision = 1;
constexpr int kMotion = 2;

double microseconds_of(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) * 1e-3;
}

}  // namespace

Result<std::unique_ptr<TraceSink>> TraceSink::create(const std::string& path, const runtime::Schedule& schedule) {
  auto file = TraceFile::create(path, "cgsr run");
  if (!file) return tl::unexpected(file.error());
  if (auto named = file->name_thread(kVision, "vision"); !named) return tl::unexpected(named.error());
  if (auto named = file->name_thread(kMotion, "motion"); !named) return tl::unexpected(named.error());
  return std::unique_ptr<TraceSink>(new TraceSink(std::move(*file), schedule));
}

Result<void> TraceSink::add_frame(const runtime::FrameRecord& record) {
  const MonoTime begin = std::max(record.stamp, last_frame_end_);
  const Duration measured = record.finished - record.started;
  const Duration shown = std::min(measured, schedule_.frame_period());
  const double shrunk = measured > Duration::zero() ? to_seconds(shown) / to_seconds(measured) : 1.0;
  last_frame_end_ = begin + shown;
  auto added = file_.slice(kVision, record.has_image ? "frame" : "frame without image", begin, shown,
                           {{"image", static_cast<std::int64_t>(record.image_sequence)},
                            {"elapsed_us", microseconds_of(measured.count())},
                            {"late", std::string_view(record.late ? "yes" : "no")}});
  MonoTime next = begin;
  for (std::size_t i = 0; added && i < schedule_.rows().size(); ++i) {
    const runtime::StageRecord& stage = record.stages[i];
    const Duration duration{static_cast<std::int64_t>(static_cast<double>(stage.elapsed_ns) * shrunk)};
    added = add_stage(stage, schedule_.rows()[i].name, next, std::min(duration, last_frame_end_ - next));
    next = std::min(next + duration, last_frame_end_);
  }
  return added;
}

Result<void> TraceSink::add_stage(const runtime::StageRecord& stage, const std::string& name, MonoTime begin,
                                  Duration shown) {
  using runtime::StageOutcome;
  if (stage.outcome == StageOutcome::kSkipped) return file_.instant(kVision, name + ": skipped", begin);
  if (stage.outcome != StageOutcome::kRan && stage.outcome != StageOutcome::kFaulted) return {};
  auto added = file_.slice(
      kVision, name, begin, shown,
      {{"elapsed_us", microseconds_of(stage.elapsed_ns)}, {"units", static_cast<std::int64_t>(stage.granted)}});
  if (added && stage.outcome == StageOutcome::kFaulted) added = file_.instant(kVision, name + ": fault", begin + shown);
  if (added && stage.overran) added = file_.instant(kVision, name + ": overrun", begin + shown);
  return added;
}

Result<void> TraceSink::on_control_cycle(const MotionStatus& status) {
  if (status.stamp < last_cycle_) return {};
  last_cycle_ = status.stamp;
  auto added = file_.slice(kMotion, "control cycle", status.stamp, Duration::zero(),
                           {{"forward_mps", status.commanded.forward_mps},
                            {"left_radps", status.commanded.left_radps},
                            {"stop_cause", text(status.cause)}});
  if (added && status.cause != std::exchange(cause_, status.cause)) {
    added =
        file_.instant(kMotion, status.cause == StopCause::kNone ? "free to move" : text(status.cause), status.stamp);
  }
  return added;
}

}  // namespace cgsr::sinks
