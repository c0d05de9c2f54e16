#include "pipeline/behavior/follow.h"

#include <algorithm>
#include <cmath>

#include "pipeline/behavior/ramp.h"

namespace cgsr::behavior {

namespace {

/// \return `error` less the dead band around zero, so that the answer starts from zero at its edge.
double beyond_band(double error, double band) {
  return error - std::clamp(error, -band, band);
}

bool sensible(const Sighting& sighting) {
  const Box& box = sighting.box;
  return std::isfinite(box.x) && std::isfinite(box.y) && std::isfinite(box.width) && std::isfinite(box.height) &&
         !box.empty() && sighting.image_width_px > 0 && sighting.image_height_px > 0 && sighting.fx_px > 0.0 &&
         std::isfinite(sighting.fx_px) && std::isfinite(sighting.cx_px) && sighting.age >= Duration::zero();
}

/// Which sides of the box are shorter than the object because the image ends there.
struct Cut {
  bool across;
  bool upright;
};

Cut cut_by_image(const Sighting& sighting) {
  constexpr double kMargin_px = 1.0;
  const Box& box = sighting.box;
  return {box.x < kMargin_px || box.x + box.width > sighting.image_width_px - kMargin_px,
          box.y < kMargin_px || box.y + box.height > sighting.image_height_px - kMargin_px};
}

/// How many times farther than the reference the object is; 0 where the image's edge leaves no side to tell it by.
double times_farther(const LearnedSize& reference, const Box& box, Cut cut) {
  if (cut.across && cut.upright) return 0.0;
  if (cut.across) return reference.height_px / box.height;
  if (cut.upright) return reference.width_px / box.width;
  return std::sqrt(reference.width_px * reference.height_px / box.area());
}

}  // namespace

std::string_view to_string(FollowState state) {
  switch (state) {
    case FollowState::kWaiting:
      return "waiting for a first sight";
    case FollowState::kFollowing:
      return "following";
    case FollowState::kStanding:
      return "lost, standing";
    case FollowState::kSearching:
      return "lost, searching";
    case FollowState::kLost:
      return "lost, given up";
  }
  return "unknown";
}

std::string_view to_string(FollowReason reason) {
  switch (reason) {
    case FollowReason::kSeen:
      return "seen";
    case FollowReason::kSeenAtEdge:
      return "seen, too near the image's corner to tell its distance";
    case FollowReason::kNotFound:
      return "not found";
    case FollowReason::kStale:
      return "last found too long ago";
    case FollowReason::kBadInput:
      return "the sighting makes no sense";
  }
  return "unknown";
}

Follow::Follow(const FollowParameters& parameters, std::optional<LearnedSize> learned, const DriveLimits& limits)
    : parameters_(parameters),
      limits_(limits),
      reference_distance_m_(parameters.distance_m),
      motion_(parameters.confirm_s) {
  const bool stated =
      learned && learned->width_px > 0.0 && learned->height_px > 0.0 && parameters.learned_distance_m > 0.0;
  if (!stated) return;
  reference_ = learned;
  reference_distance_m_ = parameters.learned_distance_m;
}

FollowDecision Follow::decide(const Sighting& sighting, Duration elapsed) {
  elapsed = std::max(elapsed, Duration::zero());
  motion_.turned(goal_.left_radps, to_seconds(elapsed));
  FollowDecision decision;
  decision.reason = judge(sighting);
  if (decision.reason == FollowReason::kSeen) {
    measure(sighting, decision);
    decision.state = FollowState::kFollowing;
    ever_seen_ = true;
    unseen_for_ = {};
    last_bearing_rad_ = decision.bearing_rad;
    motion_.seen(decision.bearing_rad);
  } else {
    decision.state = state_when_unseen(elapsed);
    if (to_seconds(unseen_for_) > parameters_.max_box_age_s) motion_.lost();
    decision.bearing_rad = last_bearing_rad_;
    decision.halt = true;
  }
  if (decision.halt) goal_.forward_mps = 0.0;

  const Velocity target = wanted(decision);
  // A long gap between images must not become a jump of speed.
  const double elapsed_s = std::min(to_seconds(elapsed), parameters_.max_box_age_s);
  const double turn_ramp = limits_.max_turn_acceleration_radps2;
  goal_.forward_mps = ramp(goal_.forward_mps, target.forward_mps, limits_.max_acceleration_mps2,
                           limits_.max_deceleration_mps2, elapsed_s);
  goal_.left_radps = ramp(goal_.left_radps, target.left_radps, turn_ramp, turn_ramp, elapsed_s);
  decision.goal = goal_;
  return decision;
}

FollowReason Follow::judge(const Sighting& sighting) const {
  if (!sighting.found) return FollowReason::kNotFound;
  if (!sensible(sighting)) return FollowReason::kBadInput;
  if (sighting.age > seconds(parameters_.max_box_age_s)) return FollowReason::kStale;
  return FollowReason::kSeen;
}

void Follow::measure(const Sighting& sighting, FollowDecision& decision) {
  const Box& box = sighting.box;
  decision.bearing_rad = std::atan((sighting.cx_px - (box.x + 0.5 * box.width)) / sighting.fx_px);

  const Cut cut = cut_by_image(sighting);
  if (!reference_ && !cut.across && !cut.upright) reference_ = LearnedSize{box.width, box.height};
  if (cut.across && cut.upright) decision.reason = FollowReason::kSeenAtEdge;
  if (reference_) decision.distance_m = reference_distance_m_ * times_farther(*reference_, box, cut);
}

FollowState Follow::state_when_unseen(Duration elapsed) {
  if (!ever_seen_) return FollowState::kWaiting;
  unseen_for_ += elapsed;
  const double unseen_s = to_seconds(unseen_for_);
  if (unseen_s <= parameters_.search_after_s) return FollowState::kStanding;
  if (unseen_s <= parameters_.search_after_s + parameters_.max_search_s) return FollowState::kSearching;
  return FollowState::kLost;
}

// Positive: to the left. A loss without anything confirmed before it leaves the last bearing.
double Follow::search_side() const {
  if (!motion_.confirmed()) return last_bearing_rad_;
  const double rate_radps = motion_.rate_radps();
  return std::abs(rate_radps) >= parameters_.min_motion_radps ? rate_radps : motion_.bearing_rad();
}

Velocity Follow::wanted(const FollowDecision& decision) const {
  Velocity velocity;
  if (decision.state == FollowState::kSearching) {
    velocity.left_radps = std::copysign(parameters_.search_turn_radps, search_side());
  }
  if (decision.state != FollowState::kFollowing) return velocity;

  const double bearing = beyond_band(decision.bearing_rad, parameters_.bearing_band_rad);
  velocity.left_radps = std::clamp(parameters_.turn_per_s * bearing, -limits_.max_turn_radps, limits_.max_turn_radps);

  if (decision.distance_m <= 0.0) return velocity;  // not known: only turn
  const double error_m = beyond_band(decision.distance_m - parameters_.distance_m, parameters_.distance_band_m);
  const double facing = std::max(0.0, 1.0 - std::abs(decision.bearing_rad) / parameters_.max_driving_bearing_rad);
  velocity.forward_mps =
      std::clamp(parameters_.approach_per_s * error_m * facing, -limits_.max_backward_mps, limits_.max_forward_mps);
  return velocity;
}

}  // namespace cgsr::behavior
