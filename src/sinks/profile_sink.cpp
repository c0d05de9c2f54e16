#include "src/sinks/profile_sink.h"

#include <spdlog/spdlog.h>

#include "src/output/text_file.h"

namespace cgsr::sinks {
namespace {

constexpr Duration kWriteEvery = seconds(1.0);

}  // namespace

Result<void> ProfileSink::on_image(const ImageReport& report) {
  profile_.add(report.record);
  return {};
}

Result<void> ProfileSink::on_missing_image(const runtime::FrameRecord& record) {
  profile_.add(record);
  return {};
}

Result<void> ProfileSink::on_control_cycle(const MotionStatus& status) {
  profile_.add(status);
  write_if_due(status.stamp);
  return {};
}

Result<void> ProfileSink::finish() {
  if (!file_.empty()) write();
  return {};
}

void ProfileSink::summarize(Summary& summary) {
  summary.json["profile"] = json();
}

nlohmann::ordered_json ProfileSink::json() const {
  nlohmann::ordered_json json = profile_.json();
  json["rings"] = rings_();
  return json;
}

void ProfileSink::write_if_due(MonoTime now) {
  if (file_.empty() || (written_at_ && now - *written_at_ < kWriteEvery)) return;
  written_at_ = now;
  write();
}

void ProfileSink::write() {
  const auto written = app::write_file(file_, json().dump() + "\n");
  if (!written && !failed_) spdlog::error("status for cgsr top: {}", written.error().message);
  failed_ = !written;
}

}  // namespace cgsr::sinks
