#include "pipeline/where_is_the_lamp.h"

#include <cmath>

namespace cgsr {

using illumination::CheckedLamp;
using illumination::CheckState;
using illumination::LampStatus;
using illumination::ObservationStatus;

namespace {

/// Why a check speaks against what the probes say; empty when it does not.
std::string_view doubt_of(const illumination::CheckReport& report, std::string_view failed) {
  if (report.state == CheckState::kFault) return illumination::name_of(report.verdict);
  return report.state == CheckState::kFailed ? failed : std::string_view();
}

}  // namespace

bool LampSight::trusted() const {
  return doubt_of(probes_check, "failed").empty() && doubt_of(lamp_proof, "failed").empty();
}

std::string_view reason_of(const LampSight& sight) {
  if (!sight.has_board) return "no probe board";
  if (sight.switching()) return "a lamp is switched";
  if (const auto doubt = doubt_of(sight.probes_check, "the probes failed their check"); !doubt.empty()) return doubt;
  if (const auto doubt = doubt_of(sight.lamp_proof, "not the room lamp's shadow"); !doubt.empty()) return doubt;
  if (sight.observation != ObservationStatus::kSeen) return illumination::name_of(sight.observation);
  if (sight.cone_missing) return "a cone is missing";
  if (sight.seen.status != LampStatus::kFound) return illumination::name_of(sight.seen.status);
  return sight.placed ? "" : "where the robot is is not known";
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

WhereIsTheLamp::WhereIsTheLamp(const illumination::Board& board, const illumination::ProbesParameters& probes,
                               const illumination::LampParameters& lamp, const CheckParameters& check)
    : lamp_(lamp),
      probe_lamp_(check.probe_lamp),
      observer_(board, probes, lamp.height_m - board.X_RB.translation().z()),
      filter_(board, lamp),
      probe_lamp_check_(check.probe_lamp_there, board, probes,
                        check.probe_lamp.position_m[2] - board.X_RB.translation().z()),
      room_lamp_check_(check.room_lamp_there, board, probes, lamp.height_m - board.X_RB.translation().z()) {
  last_.has_board = true;
}

LampSight WhereIsTheLamp::look(const ImageView& image, const PlacedRobot* robot, const CheckedLines& lines) {
  if (asked_) begin_check(*asked_, robot);
  asked_.reset();
  probe_lamp_check_.look(image, lines.probe_lamp);
  room_lamp_check_.look(image, lines.room_lamp);
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
  return last_;
}

void WhereIsTheLamp::begin_check(CheckedLamp lamp, const PlacedRobot* robot) {
  if (lamp == CheckedLamp::kProbeLamp) {
    const auto& p = probe_lamp_.position_m;
    probe_lamp_check_.begin({p[0], p[1], p[2]}, probe_lamp_.sigma_m);
  } else if (last_.known && robot != nullptr) {
    const double variance =
        last_.lamp.covariance.diagonal().maxCoeff() + robot->covariance.diagonal().head<3>().maxCoeff();
    room_lamp_check_.begin(robot->X_WR.inverse() * last_.lamp.p_WL, std::sqrt(variance));
  }
}

void WhereIsTheLamp::observe(const ImageView& image, const PlacedRobot* robot, LampSight& sight) {
  const auto observation = observer_.observe(image);
  sight.observation = observation.status;
  sight.cone_missing = observation.missing != 0;
  const auto lamps = illumination::locate_lamps(observer_.board(), lamp_, observation);
  if (!sight.cone_missing) sight.seen.status = lamps.status;
  if (lamps.count > 0 && !sight.cone_missing) sight.seen = lamps.lamp[0];
  sight.placed = robot != nullptr;
  if (robot != nullptr && !sight.cone_missing)
    sight.change = filter_.update(observation, robot->X_WR, robot->covariance);
  for (int i = 0; i < filter_.count(); ++i) {
    if (!filter_.lamp(i).steady) continue;
    if (!sight.known) sight.lamp = filter_.lamp(i);
    sight.known = true;
    ++sight.lamps;
  }
  // Another lamp is another question.
  if (sight.change.gone && !sight.known) room_lamp_check_.reopen();
}

}  // namespace cgsr
