#include "pipeline/stages/probes_stage.h"

#include <cmath>

namespace cgsr::stages {

using illumination::CheckedLamp;
using illumination::CheckState;
using illumination::LampStatus;
using illumination::ObservationStatus;

namespace {

/// Why a check speaks against what the probes say; empty when it does not.
std::string_view doubt_of(const illumination::CheckReport& check, std::string_view failed) {
  if (check.state == CheckState::kFault) return illumination::to_string(check.verdict);
  return check.state == CheckState::kFailed ? failed : std::string_view();
}

std::string_view source_of(CheckedLamp lamp) {
  return lamp == CheckedLamp::kProbeLamp ? "check by the probe lamp" : "check by the room lamp";
}

/// Adds the end of a check; while it runs there is nothing to tell.
void add_end(CheckedLamp lamp, const illumination::CheckReport& check, Events& events) {
  if (check.state != CheckState::kPassed && check.state != CheckState::kFailed && check.state != CheckState::kFault) {
    return;
  }
  events.add({source_of(lamp),
              illumination::to_string(check.state),
              illumination::to_string(check.verdict),
              {{{"pairs", static_cast<double>(check.tries), ""}}},
              1});
}

}  // namespace

bool LampReport::trusted() const {
  return doubt_of(probes_check, "failed").empty() && doubt_of(lamp_proof, "failed").empty();
}

std::string_view reason_of(const LampReport& report) {
  if (!report.has_board) return "no probe board";
  if (report.switching()) return "a lamp is switched";
  if (const auto doubt = doubt_of(report.probes_check, "the probes failed their check"); !doubt.empty()) return doubt;
  if (const auto doubt = doubt_of(report.lamp_proof, "not the room lamp's shadow"); !doubt.empty()) return doubt;
  if (report.observation != ObservationStatus::kSeen) return illumination::to_string(report.observation);
  if (report.cone_missing) return "a cone is missing";
  if (report.single_image.status != LampStatus::kFound) return illumination::to_string(report.single_image.status);
  return report.pose_known ? "" : "robot pose unknown";
}

std::string_view LampReport::outcome() const {
  const auto reason = reason_of(*this);
  return reason.empty() ? "seen" : reason;
}

PlacedRobot robot_of(const geometry::Pose& X_WC, const geometry::Matrix6d& camera_covariance,
                     const geometry::Pose& X_CR) {
  PlacedRobot robot;
  robot.X_WR = X_WC * X_CR;
  // A turn about the camera's place moves the robot's by w x r.
  const Eigen::Vector3d r = robot.X_WR.translation() - X_WC.translation();
  geometry::Matrix6d J = geometry::Matrix6d::Identity();
  J.topRightCorner<3, 3>() << 0.0, r.z(), -r.y(), -r.z(), 0.0, r.x(), r.y(), -r.x(), 0.0;
  robot.covariance = J * camera_covariance * J.transpose();
  return robot;
}

ProbesStage::ProbesStage(const illumination::Board& board, const illumination::ProbesParameters& probes,
                         const illumination::LampParameters& lamp, const geometry::Pose& X_RC,
                         const CheckParameters& check)
    : lamp_(lamp),
      probe_lamp_(check.probe_lamp),
      X_CR_(X_RC.inverse()),
      observer_(board, probes, lamp.height_m - board.X_RB.translation().z()),
      filter_(board, lamp),
      probe_lamp_check_(check.has_probe_lamp, board, probes,
                        check.probe_lamp.position_m[2] - board.X_RB.translation().z()),
      room_lamp_check_(check.has_room_lamp, board, probes, lamp.height_m - board.X_RB.translation().z()) {
  last_.has_board = true;
}

LampReport ProbesStage::update(const ImageView& image, const runtime::Aged<PoseEstimate>& pose, const LampLines& lines,
                               const Requests& requests) {
  const PoseEstimate* const now = pose.within(Duration::zero());
  if (now == nullptr || !now->known()) return update(image, nullptr, lines, requests);
  const PlacedRobot robot = robot_of(now->camera.X_WC, now->camera.covariance, X_CR_);
  return update(image, &robot, lines, requests);
}

LampReport ProbesStage::update(const ImageView& image, const PlacedRobot* robot, const LampLines& lines,
                               const Requests& requests) {
  if (requests.check) begin_check(*requests.check, robot);
  probe_lamp_check_.look(image, lines[static_cast<std::size_t>(LampLine::kProbeLamp)]);
  room_lamp_check_.look(image, lines[static_cast<std::size_t>(LampLine::kRoomLamp)]);
  // With a lamp switched, shadows are not those of the lamps that are looked for.
  if (probe_lamp_check_.running() || room_lamp_check_.running()) {
    last_.change = {};
  } else {
    last_ = {};
    last_.has_board = true;
    observe(image, robot, last_);
  }
  last_.probes_check = probe_lamp_check_.report();
  last_.lamp_proof = room_lamp_check_.report();
  last_.known = last_.known && last_.trusted();
  last_.requests_probe_lamp = probe_lamp_check_.wants_on();
  last_.requests_room_lamp = room_lamp_check_.wants_on();
  last_.events = changes();
  reported_ = state();
  return last_;
}

ProbesStage::State ProbesStage::state() const {
  const bool visible =
      last_.observation == ObservationStatus::kSeen || last_.observation == ObservationStatus::kNoShadow;
  return {visible, last_.known, last_.probes_check.state, last_.lamp_proof.state};
}

Events ProbesStage::changes() const {
  Events events;
  const State now = state();
  if (now.probes_check != reported_.probes_check) add_end(CheckedLamp::kProbeLamp, last_.probes_check, events);
  if (now.lamp_proof != reported_.lamp_proof) add_end(CheckedLamp::kRoomLamp, last_.lamp_proof, events);
  if (now.visible != reported_.visible) {
    events.add({"probes", now.visible ? "visible" : illumination::to_string(last_.observation), {}});
  }
  if (now.known && !reported_.known) {
    const auto& p = last_.lamp.p_WL;
    const double sigma_m = std::sqrt(last_.lamp.covariance.trace());
    events.add({"lamp",
                "located",
                {},
                {{{"x", p.x(), "m"}, {"y", p.y(), "m"}, {"z", p.z(), "m"}, {"sigma", sigma_m, "m"}}},
                4});
  } else if (!now.known && reported_.known) {
    events.add({"lamp", "lost", reason_of(last_)});
  }
  return events;
}

void ProbesStage::begin_check(CheckedLamp lamp, const PlacedRobot* robot) {
  if (lamp == CheckedLamp::kProbeLamp) {
    const auto& p = probe_lamp_.position_m;
    probe_lamp_check_.begin({p[0], p[1], p[2]}, probe_lamp_.sigma_m);
  } else if (last_.known && robot != nullptr) {
    const double variance =
        last_.lamp.covariance.diagonal().maxCoeff() + robot->covariance.diagonal().head<3>().maxCoeff();
    room_lamp_check_.begin(robot->X_WR.inverse() * last_.lamp.p_WL, std::sqrt(variance));
  }
}

void ProbesStage::observe(const ImageView& image, const PlacedRobot* robot, LampReport& report) {
  const auto observation = observer_.observe(image);
  report.observation = observation.status;
  report.cone_missing = observation.missing != 0;
  report.pose_known = robot != nullptr;
  if (!report.cone_missing) {
    report.single_image = illumination::locate_lamps(observer_.board(), lamp_, observation);
    if (robot != nullptr) report.change = filter_.update(observation, robot->X_WR, robot->covariance);
  }
  for (int i = 0; i < filter_.count(); ++i) {
    if (filter_.lamp(i).steady) report.lamps.add(filter_.lamp(i));
  }
  report.known = report.lamps.count > 0;
  if (report.known) report.lamp = report.lamps.lamp.front();
  // Another lamp is another question.
  if (report.change.gone && !report.known) room_lamp_check_.reopen();
}

}  // namespace cgsr::stages
