#include "pipeline/behavior/seek_lamp.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "pipeline/behavior/ramp.h"

namespace cgsr::behavior {
namespace {

using illumination::CheckedLamp;
using illumination::CheckState;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kWorthGoing_m = 0.15;  // a shorter way is none
constexpr double kHold_s = 0.8;         // for a shadow to become sure
constexpr double kTired_s = 2.0;        // before another one is stood still for
constexpr double kLampGone_s = 2.0;
constexpr int kHeadings = 24;
constexpr double kCalm_s = 1.0;       // until a base that stopped does not rock any more
constexpr double kCheckMost_s = 8.0;  // a check that is not over by then never will be

double bearing_of(const PlanarPose& here, const Place& place) {
  return std::remainder(std::atan2(place.y_m - here.y_m, place.x_m - here.x_m) - here.heading_rad, kTurn);
}

double way_between(const PlanarPose& here, const Place& place) {
  return std::hypot(place.x_m - here.x_m, place.y_m - here.y_m);
}

bool moves(SeekState state) {
  return state == SeekState::kExploring || state == SeekState::kApproaching || state == SeekState::kLocating ||
         state == SeekState::kProving || state == SeekState::kBackingOff;
}

}  // namespace

std::string_view to_string(SeekState state) {
  switch (state) {
    case SeekState::kWaiting:
      return "waiting";
    case SeekState::kChecking:
      return "checking the probes";
    case SeekState::kExploring:
      return "exploring";
    case SeekState::kApproaching:
      return "approaching the lamp";
    case SeekState::kLocating:
      return "locating the lamp";
    case SeekState::kProving:
      return "proving the lamp";
    case SeekState::kBackingOff:
      return "backing off";
    case SeekState::kShading:
      return "finding shaded regions";
    case SeekState::kTracking:
      return "tracking";
    case SeekState::kAmbient:
      return "tracking, ambient light only";
    case SeekState::kStopped:
      return "stopped";
  }
  return "unknown";
}

std::string_view to_string(SeekReason reason) {
  switch (reason) {
    case SeekReason::kBegun:
      return "begun";
    case SeekReason::kPoseKnown:
      return "where it is is known";
    case SeekReason::kShadowSeen:
      return "the probes throw a shadow";
    case SeekReason::kSteepEnough:
      return "the light comes from high enough";
    case SeekReason::kNoWayNearer:
      return "no free way nearer";
    case SeekReason::kLampKnown:
      return "the lamp is known well enough";
    case SeekReason::kTimeIsUp:
      return "time is up, the lamp is known roughly";
    case SeekReason::kLampGone:
      return "the lamp is gone";
    case SeekReason::kFarEnough:
      return "as far as it should";
    case SeekReason::kNoWayFarther:
      return "no free way farther";
    case SeekReason::kMasked:
      return "there are masks";
    case SeekReason::kNoMask:
      return "no masks in time";
    case SeekReason::kNoShadow:
      return "explored without a shadow";
    case SeekReason::kNoBoard:
      return "no probe board";
    case SeekReason::kBoardUnreadable:
      return "the probe board cannot be read";
    case SeekReason::kPoseLost:
      return "robot pose lost";
    case SeekReason::kNoPose:
      return "robot pose unknown";
    case SeekReason::kProbesAgree:
      return "the probes are as calibrated";
    case SeekReason::kProbesDoubted:
      return "the probes failed their check";
    case SeekReason::kLampProven:
      return "the shadows are the room lamp's";
    case SeekReason::kOtherShadow:
      return "the shadows are not the room lamp's";
    case SeekReason::kSwitchFault:
      return "a lamp does not switch";
    case SeekReason::kNoCheck:
      return "no check in time";
  }
  return "unknown";
}

void SeekLamp::go_on(SeekState state, SeekReason reason) {
  state_ = state;
  reason_ = reason;
  in_state_s_ = 0.0;
  held_s_ = 0.0;
  on_the_way_ = false;
  turned_rad_ = 0.0;
  leg_ = Leg::kChoose;
}

SeekDecision SeekLamp::decide(const PlanarPose& here, const LampBelief& lamp, Duration elapsed) {
  elapsed_s_ = std::clamp(to_seconds(elapsed), 0.0, 0.2);
  in_state_s_ += elapsed_s_;
  without_pose_s_ = here.known ? 0.0 : without_pose_s_ + elapsed_s_;
  unreadable_s_ = lamp.readable ? 0.0 : unreadable_s_ + elapsed_s_;
  unknown_s_ = lamp.known ? 0.0 : unknown_s_ + elapsed_s_;
  if (lamp.known) {
    lamp_ = {lamp.x_m, lamp.y_m};
    lamp_z_m_ = lamp.z_m;
  }

  SeekDecision decision;
  if (moves(state_) && without_pose_s_ > parameters_.max_pose_loss_s) go_on(SeekState::kStopped, SeekReason::kPoseLost);
  const bool needs_board = state_ == SeekState::kWaiting || state_ == SeekState::kExploring ||
                           state_ == SeekState::kApproaching || state_ == SeekState::kLocating;
  if (needs_board && unreadable_s_ > parameters_.max_probes_loss_s) {
    go_on(SeekState::kAmbient, SeekReason::kBoardUnreadable);
  }
  const Velocity target = moves(state_) && !here.known ? Velocity{} : wanted(here, lamp);
  decision.halt = state_ == SeekState::kStopped || (moves(state_) && !here.known);
  if (decision.halt) {
    goal_ = {};
  } else {
    goal_.forward_mps = ramp(goal_.forward_mps, target.forward_mps, limits_.max_acceleration_mps2,
                             limits_.max_deceleration_mps2, elapsed_s_);
    goal_.left_radps = ramp(goal_.left_radps, target.left_radps, limits_.max_turn_acceleration_radps2,
                            limits_.max_turn_acceleration_radps2, elapsed_s_);
  }
  decision.goal = goal_;
  decision.state = state_;
  decision.reason = reason_;
  if (in_state_s_ >= kCalm_s) {
    if (state_ == SeekState::kChecking && lamp.probes_check == CheckState::kOpen) {
      decision.make_sure = CheckedLamp::kProbeLamp;
    } else if (state_ == SeekState::kProving && lamp.lamp_proof == CheckState::kOpen) {
      decision.make_sure = CheckedLamp::kRoomLamp;
    }
  }
  decision.places = visits_;
  return decision;
}

Velocity SeekLamp::wanted(const PlanarPose& here, const LampBelief& lamp) {
  switch (state_) {
    case SeekState::kWaiting:
      if (!lamp.has_board) {
        go_on(SeekState::kAmbient, SeekReason::kNoBoard);
      } else if (here.known) {
        begin(here, lamp);
      } else if (without_pose_s_ > parameters_.max_pose_loss_s) {
        go_on(SeekState::kAmbient, SeekReason::kNoPose);
      }
      return {};
    case SeekState::kChecking:
      check(lamp.probes_check);
      return {};
    case SeekState::kExploring:
      return explore(here, lamp);
    case SeekState::kApproaching:
      return approach(here, lamp);
    case SeekState::kLocating:
      return locate(here, lamp);
    case SeekState::kProving:
      prove(lamp);
      return {};
    case SeekState::kBackingOff:
      return back_off(here, lamp);
    case SeekState::kShading:
      return shade(lamp);
    case SeekState::kTracking:
    case SeekState::kStopped:
      return {};
    case SeekState::kAmbient:
      if (reason_ == SeekReason::kNoPose && here.known) {
        begin(here, lamp);
        return {};
      }
      // Somebody switched it on.
      if (lamp.has_board && lamp.readable && lamp.known && here.known)
        go_on(SeekState::kLocating, SeekReason::kShadowSeen);
      middle_rad_ = here.heading_rad;
      return {};
  }
  return {};
}

void SeekLamp::begin(const PlanarPose& here, const LampBelief& lamp) {
  start_ = here;
  last_heading_rad_ = here.heading_rad;
  go_on(lamp.probes_check == CheckState::kOpen ? SeekState::kChecking : SeekState::kExploring, SeekReason::kPoseKnown);
}

Velocity SeekLamp::explore(const PlanarPose& here, const LampBelief& lamp) {
  if (lamp.known) {
    go_on(SeekState::kApproaching, SeekReason::kShadowSeen);
    return {};
  }
  tired_s_ = std::max(0.0, tired_s_ - elapsed_s_);
  if (held_s_ > 0.0 || (lamp.seen && tired_s_ <= 0.0)) {
    held_s_ += elapsed_s_;
    if (held_s_ < kHold_s) return {};
    held_s_ = 0.0;
    tired_s_ = kTired_s;
  }
  turned_rad_ += std::abs(std::remainder(here.heading_rad - last_heading_rad_, kTurn));
  last_heading_rad_ = here.heading_rad;
  if (on_the_way_) {
    if (way_between(here, next_) > parameters_.reached_m) return towards(here, next_);
    on_the_way_ = false;
    turned_rad_ = 0.0;
  }
  if (turned_rad_ < kTurn) return {0.0, parameters_.explore_turn_radps};
  if (visits_ < kMostVisited) visited_[static_cast<std::size_t>(visits_)] = {here.x_m, here.y_m};
  ++visits_;
  if (visits_ >= std::min(parameters_.max_explore_places, kMostVisited)) {
    go_on(SeekState::kAmbient, SeekReason::kNoShadow);
    return {};
  }
  choose_next_place(here);
  return {};
}

/// As far from all places that were looked at as a step can lead.
void SeekLamp::choose_next_place(const PlanarPose& here) {
  double best = -1.0;
  next_ = {here.x_m, here.y_m};
  for (int i = 0; i < kHeadings; ++i) {
    const double heading = here.heading_rad + kTurn * i / kHeadings;
    const double way = way_m(here, heading, parameters_.explore_step_m);
    if (way < kWorthGoing_m) continue;
    const Place place{here.x_m + way * std::cos(heading), here.y_m + way * std::sin(heading)};
    double nearest = way;
    for (int k = 0; k < visits_; ++k) {
      const Place& other = visited_[static_cast<std::size_t>(k)];
      nearest = std::min(nearest, std::hypot(other.x_m - place.x_m, other.y_m - place.y_m));
    }
    // Where there is much floor beyond, the next steps lead on.
    const double score = nearest + 0.1 * way_m(here, heading, 4.0 * parameters_.explore_step_m);
    if (score <= best) continue;
    best = score;
    next_ = place;
  }
  on_the_way_ = true;
}

double SeekLamp::board_to_lamp_m(const PlanarPose& here) const {
  const double x = here.x_m + board_.forward_m * std::cos(here.heading_rad);
  const double y = here.y_m + board_.forward_m * std::sin(here.heading_rad);
  return std::hypot(lamp_.x_m - x, lamp_.y_m - y);
}

Velocity SeekLamp::approach(const PlanarPose& here, const LampBelief& /*lamp*/) {
  if (unknown_s_ > kLampGone_s) {
    go_on(SeekState::kExploring, SeekReason::kLampGone);
    return {};
  }
  const auto measure = [&](SeekReason reason) {
    go_on(SeekState::kLocating, reason);
    middle_rad_ = here.heading_rad;
    return Velocity{};
  };
  const double good_m =
      std::max(parameters_.min_distance_m,
               (lamp_z_m_ - board_.height_m) * std::tan(parameters_.max_locate_angle_deg * kRadPerDeg));
  if (board_to_lamp_m(here) <= good_m) return measure(SeekReason::kSteepEnough);
  const double left_m = way_between(here, lamp_) - board_.forward_m - good_m;
  const double heading = here.heading_rad + bearing_of(here, lamp_);
  const double way = way_m(here, heading, std::max(0.0, left_m) + parameters_.reached_m);
  if (way < kWorthGoing_m) return measure(left_m < kWorthGoing_m ? SeekReason::kSteepEnough : SeekReason::kNoWayNearer);
  next_ = {here.x_m + way * std::cos(heading), here.y_m + way * std::sin(heading)};
  return towards(here, next_);
}

Velocity SeekLamp::locate(const PlanarPose& here, const LampBelief& lamp) {
  if (unknown_s_ > kLampGone_s) {
    go_on(SeekState::kExploring, SeekReason::kLampGone);
    return {};
  }
  const bool good = lamp.known && lamp.sigma_m <= parameters_.max_located_sigma_m;
  if (good && in_state_s_ >= parameters_.min_locate_s) {
    measured(lamp, SeekReason::kLampKnown);
    return {};
  }
  if (in_state_s_ >= parameters_.max_locate_s) {
    measured(lamp, SeekReason::kTimeIsUp);
    return {};
  }
  bool there = false;
  const double aside = parameters_.locate_turn_deg * kRadPerDeg;
  const Velocity turn = facing(here, middle_rad_ + (to_the_left_ ? aside : -aside), there);
  if (there) to_the_left_ = !to_the_left_;
  return turn;
}

void SeekLamp::measured(const LampBelief& lamp, SeekReason reason) {
  go_on(lamp.lamp_proof == CheckState::kOpen ? SeekState::kProving : SeekState::kBackingOff, reason);
}

void SeekLamp::check(CheckState state) {
  if (state == CheckState::kPassed) {
    go_on(SeekState::kExploring, SeekReason::kProbesAgree);
  } else if (state == CheckState::kFailed) {
    go_on(SeekState::kAmbient, SeekReason::kProbesDoubted);
  } else if (state == CheckState::kFault) {
    go_on(SeekState::kAmbient, SeekReason::kSwitchFault);
  } else if (in_state_s_ > kCheckMost_s) {
    go_on(SeekState::kAmbient, SeekReason::kNoCheck);
  }
}

void SeekLamp::prove(const LampBelief& lamp) {
  if (lamp.lamp_proof == CheckState::kPassed) {
    go_on(SeekState::kBackingOff, SeekReason::kLampProven);
  } else if (lamp.lamp_proof == CheckState::kFailed) {
    go_on(SeekState::kAmbient, SeekReason::kOtherShadow);
  } else if (lamp.lamp_proof == CheckState::kFault) {
    go_on(SeekState::kAmbient, SeekReason::kSwitchFault);
  } else if (unknown_s_ > kLampGone_s) {
    go_on(SeekState::kExploring, SeekReason::kLampGone);
  } else if (in_state_s_ > kCheckMost_s) {
    go_on(SeekState::kAmbient, SeekReason::kNoCheck);
  }
}

void SeekLamp::choose_way_back(const PlanarPose& here) {
  const double straight = std::atan2(here.y_m - lamp_.y_m, here.x_m - lamp_.x_m);
  double best = -1.0;
  double way_there = 0.0;
  away_rad_ = straight;
  for (int i = -kHeadings / 2; i <= kHeadings / 2; ++i) {
    const double aside = 2.0 * i * parameters_.max_back_off_turn_deg * kRadPerDeg / kHeadings;
    const double way = way_m(here, straight + aside, parameters_.back_off_m);
    const double score = way * std::cos(0.5 * aside);
    if (score <= best) continue;
    best = score;
    away_rad_ = straight + aside;
    way_there = way;
  }
  far_enough_ = way_there >= parameters_.back_off_m - parameters_.reached_m;
  next_ = {here.x_m + way_there * std::cos(away_rad_), here.y_m + way_there * std::sin(away_rad_)};
  leg_ = way_there < kWorthGoing_m ? Leg::kTurnBack : Leg::kTurnAway;
}

Velocity SeekLamp::back_off(const PlanarPose& here, const LampBelief& /*lamp*/) {
  if (leg_ == Leg::kChoose) choose_way_back(here);
  bool there = false;
  if (leg_ == Leg::kTurnAway) {
    const Velocity turn = facing(here, away_rad_, there);
    if (!there) return turn;
    leg_ = Leg::kDrive;
  }
  if (leg_ == Leg::kDrive) {
    if (way_between(here, next_) > parameters_.reached_m &&
        std::abs(bearing_of(here, next_)) < std::numbers::pi / 2.0) {
      return towards(here, next_);
    }
    leg_ = Leg::kTurnBack;
  }
  const Velocity turn = facing(here, here.heading_rad + bearing_of(here, lamp_), there);
  if (there) go_on(SeekState::kShading, far_enough_ ? SeekReason::kFarEnough : SeekReason::kNoWayFarther);
  return there ? Velocity{} : turn;
}

Velocity SeekLamp::shade(const LampBelief& lamp) {
  if (lamp.masked) {
    go_on(SeekState::kTracking, SeekReason::kMasked);
  } else if (in_state_s_ >= parameters_.max_shade_wait_s) {
    go_on(SeekState::kTracking, SeekReason::kNoMask);
  }
  return {};
}

bool SeekLamp::in_area(double x_m, double y_m) const {
  if (!area_.enabled) return true;
  const double c = std::cos(start_.heading_rad);
  const double s = std::sin(start_.heading_rad);
  const double dx = x_m - start_.x_m;
  const double dy = y_m - start_.y_m;
  const double x = c * dx + s * dy;
  const double y = c * dy - s * dx;
  return x >= area_.min_x_m && x <= area_.max_x_m && y >= area_.min_y_m && y <= area_.max_y_m;
}

double SeekLamp::way_m(const PlanarPose& here, double heading_rad, double longest_m) const {
  if (!floor_) return 0.0;
  const double free = floor_->way_m(here.x_m, here.y_m, heading_rad, longest_m);
  const double dx = std::cos(heading_rad);
  const double dy = std::sin(heading_rad);
  double way = 0.0;  // the area is convex
  constexpr double kStep_m = 0.05;
  while (way < free && in_area(here.x_m + (way + kStep_m) * dx, here.y_m + (way + kStep_m) * dy)) way += kStep_m;
  return std::min(way, free);
}

Velocity SeekLamp::towards(const PlanarPose& here, const Place& place) const {
  const double bearing = bearing_of(here, place);
  const double ahead = std::max(0.0, 1.0 - std::abs(bearing) / parameters_.max_driving_bearing_rad);
  const double way = way_between(here, place);
  return {std::min({parameters_.forward_mps, limits_.max_forward_mps, parameters_.approach_per_s * way}) * ahead,
          std::clamp(parameters_.turn_per_s * bearing, -limits_.max_turn_radps, limits_.max_turn_radps)};
}

Velocity SeekLamp::facing(const PlanarPose& here, double heading_rad, bool& done) const {
  const double off = std::remainder(heading_rad - here.heading_rad, kTurn);
  done = std::abs(off) <= parameters_.facing_deg * kRadPerDeg;
  // Slower than this the base would not turn at all.
  const double rate = std::min(limits_.max_turn_radps, std::max(parameters_.turn_per_s * std::abs(off), 0.08));
  return {0.0, std::copysign(rate, off)};
}

}  // namespace cgsr::behavior
