#include "src/sinks/log_sink.h"

#include <cmath>

#include <spdlog/spdlog.h>

namespace cgsr::sinks {
namespace {

double seconds_of(MonoTime stamp) {
  return to_seconds(stamp.time_since_epoch());
}

bool ended(illumination::CheckState state) {
  using illumination::CheckState;
  return state == CheckState::kPassed || state == CheckState::kFailed || state == CheckState::kFault;
}

void log_fault(const runtime::FrameRecord& record) {
  if (const auto fault = runtime::fault_of(record); !fault.empty()) spdlog::error("vision: {}", fault);
}

}  // namespace

Result<void> LogSink::on_image(const ImageReport& report) {
  log_fault(report.record);
  log_task(report);
  log_pose(report);
  log_lamp(report);
  return {};
}

Result<void> LogSink::on_missing_image(const runtime::FrameRecord& record) {
  log_fault(record);
  return {};
}

void LogSink::log_task(const ImageReport& report) {
  const stages::Decision& decision = report.frame.decision.value;
  if (decision.state == task_state_) return;
  spdlog::info("image {} ({:.1f} s): task: {}{}{}", report.record.image_sequence, seconds_of(report.record.stamp),
               decision.state, decision.reason.empty() ? "" : ": ", decision.reason);
  task_state_ = decision.state;
}

void LogSink::log_pose(const ImageReport& report) {
  const stages::PoseEstimate& pose = report.frame.pose.value;
  if (!pose.has_map || pose.camera.state == pose_) return;
  const auto reason = to_string(pose.camera.correction.reason);
  spdlog::info("image {}: pose: {} -> {}{}{}", report.record.image_sequence, to_string(pose_),
               to_string(pose.camera.state), reason.empty() ? "" : ": ", reason);
  pose_ = pose.camera.state;
}

void LogSink::log_check(const ImageReport& report, illumination::CheckedLamp lamp,
                        const illumination::CheckReport& check) {
  auto& before = checks_[static_cast<std::size_t>(lamp)];
  if (check.state == before) return;
  before = check.state;
  if (!ended(check.state)) return;
  spdlog::info("image {}: check by the {}: {} ({})", report.record.image_sequence, to_string(lamp),
               to_string(check.state), to_string(check.verdict));
}

void LogSink::log_lamp(const ImageReport& report) {
  const stages::LampReport& lamp = report.frame.lamp.value;
  const auto image = report.record.image_sequence;
  if (report.frame.shade.value.status != shade_) {
    spdlog::info("image {}: shadow masks: {} -> {}", image, to_string(shade_),
                 to_string(report.frame.shade.value.status));
    shade_ = report.frame.shade.value.status;
  }
  if (!lamp.has_board) return;
  log_check(report, illumination::CheckedLamp::kProbeLamp, lamp.probes_check);
  log_check(report, illumination::CheckedLamp::kRoomLamp, lamp.lamp_proof);
  const bool visible = lamp.observation == illumination::ObservationStatus::kSeen ||
                       lamp.observation == illumination::ObservationStatus::kNoShadow;
  if (visible != probes_visible_) {
    spdlog::info("image {}: probes: {}", image, visible ? "visible" : to_string(lamp.observation));
  }
  probes_visible_ = visible;
  if (lamp.known == lamp_known_) return;
  lamp_known_ = lamp.known;
  if (!lamp.known) return spdlog::info("image {}: lamp: lost: {}", image, reason_of(lamp));
  const auto& p = lamp.lamp.p_WL;
  spdlog::info("image {}: lamp: at ({:.2f}, {:.2f}, {:.2f}) m, sigma {:.3f} m", image, p.x(), p.y(), p.z(),
               std::sqrt(lamp.lamp.covariance.trace()));
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
