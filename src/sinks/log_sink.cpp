#include "src/sinks/log_sink.h"

#include <spdlog/spdlog.h>

#include "src/sinks/event_text.h"

namespace cgsr::sinks {
namespace {

double seconds_of(MonoTime stamp) {
  return to_seconds(stamp.time_since_epoch());
}

void log_fault(const runtime::FrameRecord& record) {
  if (const auto fault = runtime::fault_of(record); !fault.empty()) spdlog::error("vision: {}", fault);
}

}  // namespace

Result<void> LogSink::on_image(const ImageReport& report) {
  log_fault(report.record);
  stages::for_each_event(report.frame, [&report](const stages::Event& event) {
    spdlog::info("image {} ({:.1f} s): {}", report.record.image_sequence, seconds_of(report.record.stamp),
                 text_of(event));
  });
  return {};
}

Result<void> LogSink::on_missing_image(const runtime::FrameRecord& record) {
  log_fault(record);
  return {};
}

Result<void> LogSink::on_control_cycle(const MotionStatus& status) {
  const bool first = !cycled_;
  if (!first && status.armed != motion_.armed) spdlog::info("motion: {}", status.armed ? "armed" : "disarmed");
  if (first || status.cause != motion_.cause) {
    spdlog::info("motion: {}", status.cause == StopCause::kNone ? "free to move" : to_string(status.cause));
  }
  cycled_ = true;
  motion_ = status;
  return {};
}

Result<void> LogSink::on_switching(const SwitchRecord& record) {
  const stages::SwitchAnswer& answer = record.answer;
  const auto what = fmt::format("{} {}, requested at {:.3f} s", to_string(answer.request.line),
                                answer.request.on ? "on" : "off", seconds_of(answer.request.asked_at));
  if (answer.done) {
    spdlog::info("switches: {}, done at {:.3f} s", what, seconds_of(answer.at));
  } else {
    spdlog::error("switches: {}: {}", what, record.problem.data());
  }
  return {};
}

}  // namespace cgsr::sinks
