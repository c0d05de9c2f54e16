#include "src/robot/housekeeping_task.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

namespace cgsr::robot {
namespace {

/// Empty without a map: a column that means nothing says nothing.
std::string pose_columns(const Whereabouts& where) {
  if (!where.has_map) return ",,,,,,";
  const auto& camera = where.camera;
  return fmt::format("{},{},{},{:.4f},{:.4f},{:.5f},{:.4f}", name_of(camera.state), camera.correction.corrected ? 1 : 0,
                     name_of(camera.correction.reason), where.robot.x_m, where.robot.y_m, where.robot.heading_rad,
                     std::sqrt(camera.covariance.topLeftCorner<2, 2>().trace()));
}

/// Empty without a board.
std::string light_columns(const Decision& decision) {
  const LampSight& sight = decision.lamp;
  if (!sight.has_board) return ",,,,,";
  const auto reason = reason_of(sight);
  std::string columns = fmt::format("\"{}\",", reason.empty() ? "seen" : reason);
  if (sight.known) {
    const auto& p = sight.lamp.p_WL;
    columns +=
        fmt::format("{:.4f},{:.4f},{:.4f},{:.4f}", p.x(), p.y(), p.z(), std::sqrt(sight.lamp.covariance.trace()));
  } else {
    columns += ",,,";
  }
  return columns + fmt::format(",\"{}\"", name_of(decision.shade.status));
}

/// By what was really there; empty where nobody knows it.
std::string error_columns(const std::optional<PoseError>& off) {
  if (!off) return ",,";
  return fmt::format(",{:.4f},{:.3f}", off->position_m, off->direction_rad * 180.0 / std::numbers::pi);
}

std::string_view state_of(const Decision& decision, config::TaskKind task) {
  switch (task) {
    case config::TaskKind::kFollow:
      return behavior::text(decision.follow.state);
    case config::TaskKind::kRoute:
      return behavior::text(decision.route.state);
    case config::TaskKind::kLamp:
      return behavior::text(decision.seek.state);
  }
  return "unknown";
}

std::string row_of(const VisionReport& report, const MotionStatus& motion, config::TaskKind task) {
  const auto& object = report.decision.object;
  std::string row =
      fmt::format("{},{:.6f},", report.record.image_sequence, to_seconds(report.record.stamp.time_since_epoch()));
  if (object.found) {
    row += fmt::format("1,{:.2f},{:.2f},{:.2f},{:.2f},{:.5f},{:.3f},{:.3f},{:.3f},", object.box.x, object.box.y,
                       object.box.width, object.box.height, object.divergence, object.light.r, object.light.g,
                       object.light.b);
  } else {
    row += "0,,,,,,,,,";
  }
  row += fmt::format("\"{}\",{:.4f},{:.4f},{:.4f},{:.4f},{},\"{}\",", state_of(report.decision, task),
                     report.decision.goal.forward_mps, report.decision.goal.left_radps, motion.commanded.forward_mps,
                     motion.commanded.left_radps, motion.armed ? 1 : 0, text(motion.cause));
  return row + pose_columns(report.decision.where) + "," + light_columns(report.decision);
}

std::string stage_times(const runtime::FrameRecord& record, const runtime::StageTable& table) {
  std::string line = "stages, us:";
  const auto stages = table.stages();
  for (std::size_t i = 0; i < stages.size(); ++i) {
    line += fmt::format("  {} {:.0f}", stages[i].name, static_cast<double>(record.stages[i].elapsed_ns) * 1e-3);
  }
  return line;
}

}  // namespace

std::string run_csv_head() {
  return "frame,stamp_s,found,x,y,width,height,divergence,light_r,light_g,light_b,state,goal_mps,goal_radps,"
         "commanded_mps,commanded_radps,armed,stop_cause,pose,corrected,reason,x_m,y_m,heading_rad,sigma_m,"
         "probes,lamp_x_m,lamp_y_m,lamp_z_m,lamp_sigma_m,shade,camera_off_m,camera_off_deg";
}

void HousekeepingTask::step() {
  while (const auto status = links_.motions.pop()) take(*status);
  while (const auto record = links_.switchings.pop()) take(*record);
  while (const auto report = links_.reports.pop()) take(*report);
}

void HousekeepingTask::finish() {
  if (outputs_.video) note(outputs_.video->close());
}

void HousekeepingTask::take(const MotionStatus& status) {
  const MotionStatus& before = tally_.last_motion;
  if (tally_.beats > 0 && status.armed != before.armed) spdlog::info("motion: {}", status.armed ? "armed" : "disarmed");
  if (tally_.beats == 0 || status.cause != before.cause) {
    spdlog::info("motion: {}", status.cause == StopCause::kNone ? "free to move" : text(status.cause));
  }
  ++tally_.beats;
  const bool moves = status.sent && (status.commanded.forward_mps != 0.0 || status.commanded.left_radps != 0.0);
  tally_.beats_in_motion += moves ? 1 : 0;
  tally_.fastest_mps = std::max(tally_.fastest_mps, std::abs(status.commanded.forward_mps));
  tally_.fastest_radps = std::max(tally_.fastest_radps, std::abs(status.commanded.left_radps));
  tally_.last_motion = status;
}

void HousekeepingTask::take(const VisionReport& report) {
  ++tally_.frames;
  table_.add(report.record);
  if (const auto fault = runtime::fault_of(report.record); !fault.empty()) spdlog::error("vision: {}", fault);
  if (!report.record.has_image) {
    ++tally_.without_image;
    return;
  }
  const auto& decision = report.decision;
  if (decision.follow.state != state_) {
    spdlog::info("image {}: {} -> {} ({})", report.record.image_sequence, behavior::text(state_),
                 behavior::text(decision.follow.state), behavior::text(decision.follow.reason));
    state_ = decision.follow.state;
  }
  decisions_.add_image(report.record.image_sequence, decision);
  watch_pose(report);
  watch_light(report);
  watch_seek(report);
  tally_.found += decision.object.found ? 1 : 0;
  const auto light =
      lights_.add(report.record.stamp, decision.object.found ? std::optional(decision.object.light) : std::nullopt);
  std::optional<hal::ImageTruth> truth;
  std::optional<PoseError> off;
  if (outputs_.simulation != nullptr) truth = outputs_.simulation->truth(report.record.stamp);
  if (truth) {
    truths_.add(*truth, decision.object, tally_.last_motion);
    off = poses_.add(*truth, decision.where, tally_.last_motion.odometry);
  }
  lights_seen_.add(decision, truth);
  write_row(report, off);
  if (auto picture = picture_of(report.record.image_sequence)) {
    ++tally_.pictures;
    const ImageView& view = picture->view();
    for (int y = 0; y < view.height_px; ++y) {
      inputs_sum_.add(view.row(y), static_cast<std::size_t>(view.width_px) * 2);
    }
    draw(report, *picture, light, truth);
    if (outputs_.witness) outputs_.witness(picture->view(), report, truth);
  }
}

void HousekeepingTask::watch_pose(const VisionReport& report) {
  const auto& decision = report.decision;
  tally_.last_where = decision.where;
  if (decision.route.state != route_) {
    spdlog::info("image {}: route: {} -> {}", report.record.image_sequence, behavior::text(route_),
                 behavior::text(decision.route.state));
    route_ = decision.route.state;
  }
  const auto& camera = decision.where.camera;
  if (!decision.where.has_map || camera.state == pose_) return;
  spdlog::info("image {}: pose: {} -> {}{}{}", report.record.image_sequence, name_of(pose_), name_of(camera.state),
               camera.correction.reason == localization::Reason::kNone ? "" : ": ", name_of(camera.correction.reason));
  pose_ = camera.state;
}

void HousekeepingTask::watch_seek(const VisionReport& report) {
  if (outputs_.task != config::TaskKind::kLamp) return;
  const auto& seek = report.decision.seek;
  if (!tally_.seek.empty() && tally_.seek.back().state == seek.state) return;
  const auto image = report.record.image_sequence;
  const double at_s = to_seconds(report.record.stamp.time_since_epoch());
  spdlog::info("image {} ({:.1f} s): {} ({})", image, at_s, behavior::text(seek.state), behavior::text(seek.reason));
  tally_.seek.push_back({seek.state, seek.reason, image, at_s});
}

void HousekeepingTask::take(const SwitchRecord& record) {
  const SwitchAnswer& answer = record.answer;
  decisions_.add_request(answer.request);
  tally_.switchings.push_back(record);
  const auto what =
      fmt::format("{} {}, asked at {:.3f} s", name_of(answer.request.line), answer.request.on ? "on" : "off",
                  to_seconds(answer.request.asked_at.time_since_epoch()));
  if (answer.done) {
    spdlog::info("switches: {}, done at {:.3f} s", what, to_seconds(answer.at.time_since_epoch()));
  } else {
    spdlog::error("switches: {}: {}", what, record.problem.data());
  }
}

void HousekeepingTask::watch_check(illumination::CheckedLamp lamp, const illumination::CheckReport& check,
                                   const runtime::FrameRecord& record) {
  illumination::CheckState& before = checks_[static_cast<std::size_t>(lamp)];
  if (check.state == before) return;
  before = check.state;
  using illumination::CheckState;
  if (check.state != CheckState::kPassed && check.state != CheckState::kFailed && check.state != CheckState::kFault)
    return;
  tally_.checks.push_back({lamp, check, record.image_sequence, to_seconds(record.stamp.time_since_epoch())});
  spdlog::info("image {}: check by the {}: {} ({})", record.image_sequence, name_of(lamp), name_of(check.state),
               name_of(check.verdict));
}

void HousekeepingTask::watch_light(const VisionReport& report) {
  const LampSight& sight = report.decision.lamp;
  if (!sight.has_board) return;
  watch_check(illumination::CheckedLamp::kProbeLamp, sight.probes_check, report.record);
  watch_check(illumination::CheckedLamp::kRoomLamp, sight.lamp_proof, report.record);
  const auto image = report.record.image_sequence;
  const bool fit = sight.observation == illumination::ObservationStatus::kSeen ||
                   sight.observation == illumination::ObservationStatus::kNoShadow;
  if (fit != probes_fit_) spdlog::info("image {}: probes: {}", image, fit ? "well seen" : name_of(sight.observation));
  probes_fit_ = fit;
  if (sight.known != lamp_known_) {
    if (sight.known) {
      const auto& p = sight.lamp.p_WL;
      spdlog::info("image {}: lamp: at ({:.2f}, {:.2f}, {:.2f}) m, sigma {:.3f} m", image, p.x(), p.y(), p.z(),
                   std::sqrt(sight.lamp.covariance.trace()));
    } else {
      spdlog::info("image {}: lamp: gone: {}", image, reason_of(sight));
    }
    lamp_known_ = sight.known;
  }
  if (report.decision.shade.status == shade_) return;
  spdlog::info("image {}: shade: {} -> {}", image, name_of(shade_), name_of(report.decision.shade.status));
  shade_ = report.decision.shade.status;
}

std::optional<ImageLease> HousekeepingTask::picture_of(std::uint64_t sequence) {
  for (;;) {
    if (!next_picture_) next_picture_ = links_.pictures.pop();
    if (!next_picture_ || next_picture_->sequence() > sequence) return std::nullopt;
    auto picture = std::exchange(next_picture_, std::nullopt);
    if (picture->sequence() == sequence) return picture;
  }
}

void HousekeepingTask::write_row(const VisionReport& report, const std::optional<PoseError>& off) {
  const std::string row = row_of(report, tally_.last_motion, outputs_.task);
  outputs_sum_.add(row.data(), row.size());
  if (outputs_.csv) note(outputs_.csv->add_line(row + error_columns(off)));
}

void HousekeepingTask::draw(const VisionReport& report, const ImageLease& picture,
                            const std::optional<color::Light>& light, const std::optional<hal::ImageTruth>& truth) {
  if (!outputs_.video) return;
  const auto& decision = report.decision;
  app::OverlayFacts facts;
  facts.image_number = report.record.image_sequence;
  if (decision.object.found) facts.box = decision.object.box;
  facts.light = light;
  facts.divergence = decision.object.divergence;
  const MotionStatus& motion = tally_.last_motion;
  facts.lines.push_back(fmt::format("{}   commanded {:+.2f} m/s {:+.2f} rad/s   {}", state_of(decision, outputs_.task),
                                    motion.commanded.forward_mps, motion.commanded.left_radps,
                                    motion.cause == StopCause::kNone ? "free to move" : text(motion.cause)));
  if (decision.where.has_map) {
    const auto& camera = decision.where.camera;
    facts.lines.push_back(fmt::format("pose {}   x {:.2f} y {:.2f} m  heading {:.1f} deg   {} matches",
                                      name_of(camera.state), decision.where.robot.x_m, decision.where.robot.y_m,
                                      decision.where.robot.heading_rad * 180.0 / std::numbers::pi,
                                      camera.correction.matches));
  }
  const LampSight& sight = decision.lamp;
  if (sight.has_board) {
    const auto reason = reason_of(sight);
    std::string line = fmt::format("probes: {}   ", reason.empty() ? "shadows seen" : reason);
    if (sight.known) {
      const auto& p = sight.lamp.p_WL;
      line += fmt::format("lamp {:.2f} {:.2f} {:.2f} m, sigma {:.3f}   ", p.x(), p.y(), p.z(),
                          std::sqrt(sight.lamp.covariance.trace()));
    }
    facts.lines.push_back(line + fmt::format("shade: {}", name_of(decision.shade.status)));
  }
  if (decision.shade.status == ShadeStatus::kMasked) facts.shade = &decision.shade.picture;
  facts.lines.push_back(stage_times(report.record, table_));
  if (truth && truth->in_view) facts.truth = truth->box;
  const cv::Mat& overlay = outputs_.overlay->draw(picture.view(), facts);
  if (!outputs_.plan) return note(outputs_.video->add(overlay));
  app::PlanFacts plan;
  if (truth) plan.truth = *truth;
  plan.found = decision.object.found;
  plan.commanded = motion.commanded;
  plan.set_distance_m = outputs_.set_distance_m;
  if (decision.where.has_map) {
    plan.believed =
        hal::FloorPose{decision.where.robot.x_m, decision.where.robot.y_m, decision.where.robot.heading_rad};
  }
  cv::hconcat(overlay, outputs_.plan->draw(plan), side_by_side_);
  note(outputs_.video->add(side_by_side_));
}

void HousekeepingTask::note(const Result<void>& outcome) {
  if (outcome || !tally_.output_problem.empty()) return;
  // The robot goes on without its files; whoever started it learns at once and again from the exit code.
  tally_.output_problem = outcome.error().message;
  spdlog::error("{}; nothing more is written", tally_.output_problem);
  outputs_.csv.reset();
  outputs_.video.reset();
}

}  // namespace cgsr::robot
