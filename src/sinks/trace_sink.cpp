#include "src/sinks/trace_sink.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "src/sinks/event_text.h"

namespace cgsr::sinks {
namespace {

constexpr int kCapture = 1;
constexpr int kVision = 2;
constexpr int kMotion = 3;
constexpr int kHousekeeping = 4;
constexpr std::size_t kMaxGoals = 64;  // that wait for their other end

double microseconds_of(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) * 1e-3;
}

}  // namespace

Result<std::unique_ptr<TraceSink>> TraceSink::create(const std::string& path, const runtime::Schedule& schedule) {
  auto file = TraceFile::create(path, "cgsr run");
  if (!file) return tl::unexpected(file.error());
  for (const auto& [thread, name] : std::initializer_list<std::pair<int, std::string_view>>{
           {kCapture, "capture"}, {kVision, "vision"}, {kMotion, "motion"}, {kHousekeeping, "housekeeping"}}) {
    if (auto named = file->name_thread(thread, name); !named) return tl::unexpected(named.error());
  }
  return std::unique_ptr<TraceSink>(new TraceSink(std::move(*file), schedule));
}

Result<void> TraceSink::on_image(const ImageReport& report) {
  const auto frame = add_frame(report.record);
  if (!frame) return tl::unexpected(frame.error());
  if (auto added = add_capture(*frame); !added) return added;
  if (auto added = add_report(*frame, report.taken_at); !added) return added;
  if (auto added = add_events(*frame, report.frame); !added) return added;
  sent_.push_back(*frame);
  return add_goals();
}

Result<void> TraceSink::on_missing_image(const runtime::FrameRecord& record) {
  const auto frame = add_frame(record);
  if (!frame) return tl::unexpected(frame.error());
  return add_report(*frame, frame->end);
}

// What capture gave to vision.
Result<void> TraceSink::add_capture(const DrawnFrame& frame) {
  const MonoTime at = std::max(frame.stamp, last_capture_);
  last_capture_ = at;
  auto added =
      file_.slice(kCapture, "image", at, Duration::zero(), {{"image", static_cast<std::int64_t>(frame.image)}});
  if (added) added = file_.flow_start(kCapture, "image", frame.image, at);
  if (added) added = file_.flow_end(kVision, "image", frame.image, std::max(frame.begin, at));
  return added;
}

// At the end of the frame: the record does not say when within it.
Result<void> TraceSink::add_events(const DrawnFrame& drawn, const stages::FrameResult& frame) {
  Result<void> added;
  stages::for_each_event(frame, [&](const stages::Event& event) {
    if (added) added = file_.instant(kVision, text_of(event), drawn.end, {{"reason", event.reason}});
  });
  return added;
}

// What vision reported to housekeeping. In lock-step housekeeping takes it at the time of the stamp: it is drawn where the frame ends.
Result<void> TraceSink::add_report(const DrawnFrame& frame, MonoTime taken_at) {
  const MonoTime at = std::max({taken_at, frame.end, last_report_});
  last_report_ = at;
  const std::uint64_t number = frames_++;
  auto added = file_.slice(kHousekeeping, "report", at, Duration::zero());
  if (added) added = file_.flow_start(kVision, "report", number, frame.end);
  if (added) added = file_.flow_end(kHousekeeping, "report", number, at);
  return added;
}

// Goals whose frame and whose first cycle are both known. In lock-step a cycle may have the goal while the frame is still drawn.
Result<void> TraceSink::add_goals() {
  Result<void> added;
  while (added && !sent_.empty() && !taken_.empty()) {
    const DrawnFrame sent = sent_.front();
    const TakenGoal taken = taken_.front();
    if (sent.stamp <= taken.stamp) sent_.pop_front();
    if (taken.stamp <= sent.stamp) taken_.pop_front();
    if (sent.stamp != taken.stamp || taken.cycle < sent.begin) continue;
    added = file_.flow_start(kVision, "goal", sent.image, std::min(sent.end, taken.cycle));
    if (added) added = file_.flow_end(kMotion, "goal", sent.image, taken.cycle);
  }
  while (sent_.size() > kMaxGoals) sent_.pop_front();
  while (taken_.size() > kMaxGoals) taken_.pop_front();
  return added;
}

Result<TraceSink::DrawnFrame> TraceSink::add_frame(const runtime::FrameRecord& record) {
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
  if (!added) return tl::unexpected(added.error());
  return DrawnFrame{record.stamp, begin, last_frame_end_, record.image_sequence};
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
                            {"stop_cause", to_string(status.cause)}});
  if (added && status.cause != std::exchange(cause_, status.cause)) {
    added = file_.instant(kMotion, status.cause == StopCause::kNone ? "free to move" : to_string(status.cause),
                          status.stamp);
  }
  if (!added || status.goal_stamp <= last_goal_) return added;
  last_goal_ = status.goal_stamp;
  taken_.push_back({status.goal_stamp, status.stamp});
  return add_goals();
}

}  // namespace cgsr::sinks
