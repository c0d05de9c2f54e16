#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/drive.h"
#include "platform/box.h"
#include "platform/parameters.h"
#include "platform/time.h"

namespace cgsr::behavior {

/// How close, how fast, and what to do when the object is gone.
struct FollowParameters {
  double distance_m = 1.5;
  double learned_distance_m = 0.0;
  double distance_band_m = 0.15;
  double approach_per_s = 0.5;
  double forward_limit_mps = 0.3;
  double backward_limit_mps = 0.0;
  double acceleration_limit_mps2 = 0.3;
  double deceleration_limit_mps2 = 0.6;
  double bearing_band_rad = 0.03;
  double turn_per_s = 1.2;
  double turn_limit_radps = 0.8;
  double turn_acceleration_limit_radps2 = 1.5;
  double turn_first_rad = 0.5;
  double stale_after_s = 0.3;
  double search_after_s = 1.0;
  double search_for_s = 20.0;
  double search_turn_radps = 0.4;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("distance_m", self.distance_m, {0.3, 5.0}, "m", "distance to keep from the object");
    visit.number(
        "learned_distance_m", self.learned_distance_m, {0.0, 10.0}, "m",
        "how far the object was when its size was learned; 0: not known, the first box seen counts as distance_m");
    visit.number("distance_band_m", self.distance_band_m, {0.0, 1.0}, "m",
                 "an error of the distance this small is none");
    visit.number("approach_per_s", self.approach_per_s, {0.0, 3.0}, "1/s", "speed for each metre of error");
    visit.number("forward_limit_mps", self.forward_limit_mps, {0.0, 1.5}, "m/s", "fastest approach");
    visit.number("backward_limit_mps", self.backward_limit_mps, {0.0, 0.5}, "m/s",
                 "fastest retreat from an object that comes too near; the robot is blind backwards");
    visit.number("acceleration_limit_mps2", self.acceleration_limit_mps2, {0.05, 3.0}, "m/s²",
                 "steepest gain of speed");
    visit.number("deceleration_limit_mps2", self.deceleration_limit_mps2, {0.05, 3.0}, "m/s²",
                 "steepest loss of speed");
    visit.number("bearing_band_rad", self.bearing_band_rad, {0.0, 0.5}, "rad",
                 "a bearing this small is straight ahead");
    visit.number("turn_per_s", self.turn_per_s, {0.0, 5.0}, "1/s", "turn rate for each radian of bearing");
    visit.number("turn_limit_radps", self.turn_limit_radps, {0.0, 2.0}, "rad/s", "fastest turn towards the object");
    visit.number("turn_acceleration_limit_radps2", self.turn_acceleration_limit_radps2, {0.1, 10.0}, "rad/s²",
                 "steepest change of the turn rate");
    visit.number("turn_first_rad", self.turn_first_rad, {0.05, 3.2}, "rad",
                 "bearing at which the robot only turns; the speed falls linearly on the way there");
    visit.number("stale_after_s", self.stale_after_s, {0.05, 2.0}, "s",
                 "a box from an older image counts as not found");
    visit.number("search_after_s", self.search_after_s, {0.0, 10.0}, "s", "how long to stand before the search starts");
    visit.number("search_for_s", self.search_for_s, {0.0, 120.0}, "s",
                 "how long to search before the object is given up");
    visit.number("search_turn_radps", self.search_turn_radps, {0.0, 1.0}, "rad/s", "turn rate of the search");
  }
};

/// What the tracker and the camera say about this image.
struct Sighting {
  bool found = false;
  Box box;         ///< [px]; read only when found.
  Duration age{};  ///< since the image in which it was found: a stage that was skipped hands on its last output.
  int image_width_px = 0;
  int image_height_px = 0;
  double fx_px = 0.0;  ///< focal length along x, > 0.
  double cx_px = 0.0;  ///< column of the optical axis.
};

/// Size of the object's box when it was learned, in pixels of the camera that follows it.
struct LearnedSize {
  double width_px = 0.0;
  double height_px = 0.0;
};

enum class FollowState : std::uint8_t {
  kWaiting,    ///< never seen yet: stands.
  kFollowing,  ///< seen.
  kStanding,   ///< lost: comes to a stop and stands for search_after_s.
  kSearching,  ///< turns on the spot towards the side where it was last seen, for search_for_s.
  kLost,       ///< given up: stands until it is seen again.
};

enum class FollowReason : std::uint8_t {
  kSeen,
  kSeenAtEdge,  ///< the box is cut by the image's edge in both directions: its size says nothing, the robot only turns.
  kNotFound,
  kStale,     ///< found, but in an image older than stale_after_s.
  kBadInput,  ///< box, camera or image size make no sense; treated as not found.
};

std::string_view text(FollowState state);
std::string_view text(FollowReason reason);

struct FollowDecision {
  hal::Twist goal;
  FollowState state = FollowState::kWaiting;
  FollowReason reason = FollowReason::kNotFound;
  double bearing_rad =
      0.0;  ///< of the box's centre, positive to the left; of the last one seen when it is not seen now.
  double distance_m = 0.0;  ///< estimated; 0 when unknown.
};

/// Keeps an object centred and at a distance.
///
///     bearing   b = atan((cx - u) / fx)                            u: column of the box's centre
///     distance  d = d_ref * size_ref / size                        size: root of the box's area; a side alone when the
///     image cuts the other turn      w = turn_per_s * b forward   v = approach_per_s * (d - distance_m) * max(0, 1 -
///     |b| / turn_first_rad)
///
/// b and d - distance_m go through their dead bands, v and w through their limits and ramps. Never moves backwards
/// unless backward_limit_mps says so.
class Follow {
 public:
  /// \param learned  with learned_distance_m > 0 the reference for the distance; without either, the first box seen
  /// whole is it.
  Follow(const FollowParameters& parameters, std::optional<LearnedSize> learned);

  /// One image. \param elapsed  since the last call; negative counts as zero.
  FollowDecision decide(const Sighting& sighting, Duration elapsed);

 private:
  FollowReason judge(const Sighting& sighting) const;
  void measure(const Sighting& sighting, FollowDecision& decision);
  FollowState state_when_unseen(Duration elapsed);
  hal::Twist wanted(const FollowDecision& decision) const;

  FollowParameters parameters_;
  std::optional<LearnedSize> reference_;
  double reference_distance_m_;
  hal::Twist goal_;
  double last_bearing_rad_ = 0.0;
  Duration unseen_for_{};
  bool ever_seen_ = false;
};

}  // namespace cgsr::behavior
