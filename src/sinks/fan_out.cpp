#include "src/sinks/fan_out.h"

#include <spdlog/spdlog.h>

namespace cgsr::sinks {

template <class Call>
void FanOut::each(Call call) {
  for (auto sink = sinks_.begin(); sink != sinks_.end();) {
    const Result<void> done = call(**sink);
    if (done) {
      ++sink;
      continue;
    }
    // The robot goes on without this output; whoever started it is told at once, and again by the exit code.
    spdlog::error("{}; nothing more is written there", done.error().message);
    if (problem_.empty()) problem_ = done.error().message;
    ended_.push_back(std::move(*sink));
    sink = sinks_.erase(sink);
  }
}

void FanOut::on_image(const ImageReport& report) {
  each([&](Sink& sink) { return sink.on_image(report); });
}

void FanOut::on_missing_image(const runtime::FrameRecord& record) {
  each([&](Sink& sink) { return sink.on_missing_image(record); });
}

void FanOut::on_control_cycle(const MotionStatus& status) {
  each([&](Sink& sink) { return sink.on_control_cycle(status); });
}

void FanOut::on_switching(const SwitchRecord& record) {
  each([&](Sink& sink) { return sink.on_switching(record); });
}

void FanOut::finish() {
  each([](Sink& sink) { return sink.finish(); });
}

Summary FanOut::summary() const {
  Summary summary;
  for (const auto& sink : sinks_) sink->summarize(summary);
  for (const auto& sink : ended_) sink->summarize(summary);
  return summary;
}

}  // namespace cgsr::sinks
