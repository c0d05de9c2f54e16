#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "pipeline/behavior/confirmed_motion.h"
#include "pipeline/behavior/drive_limits.h"
#include "pipeline/behavior/follow_parameters.h"
#include "pipeline/behavior/velocity.h"
#include "platform/box.h"
#include "platform/time.h"

namespace cgsr::behavior {

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
  kSearching,  ///< turns on the spot towards where it moved, or the side where it was (ConfirmedMotion), for max_search_s.
  kLost,       ///< given up: stands until it is seen again.
};

enum class FollowReason : std::uint8_t {
  kSeen,
  kSeenAtEdge,  ///< the box is cut by the image's edge in both directions: its size says nothing, the robot only turns.
  kNotFound,
  kStale,     ///< found, but in an image older than max_box_age_s.
  kBadInput,  ///< box, camera or image size make no sense; treated as not found.
};

std::string_view to_string(FollowState state);
std::string_view to_string(FollowReason reason);

/// What to do about one image. The goal is in the robot's frame.
struct FollowDecision {
  Velocity goal;
  FollowState state = FollowState::kWaiting;
  FollowReason reason = FollowReason::kNotFound;
  double bearing_rad =
      0.0;  ///< of the box's centre, positive to the left; of the last one seen when it is not seen now.
  double distance_m = 0.0;  ///< estimated; 0 when unknown.
  bool halt = false;        ///< the object is not seen: the forward goal is zero without a ramp.
};

/// Keeps an object centred and at a distance. Ours; the dissertation (3.3.2) says only that the robot follows a person.
///
///     bearing   b = atan((cx - u) / fx)                            u: column of the box's centre
///     distance  d = d_ref * size_ref / size                        size: root of the box's area; a side alone when the
///     image cuts the other turn      w = turn_per_s * b forward   v = approach_per_s * (d - distance_m) * max(0, 1 -
///     |b| / max_driving_bearing_rad)
///
/// b and d - distance_m go through their dead bands, v and w through their limits and ramps. Never moves backwards
/// unless max_backward_mps says so.
class Follow {
 public:
  /// \param learned  with learned_distance_m > 0 the reference for the distance; without either, the first box seen
  /// whole is it.
  Follow(const FollowParameters& parameters, std::optional<LearnedSize> learned, const DriveLimits& limits = {});

  /// One image. \param elapsed  since the last call; negative counts as zero.
  FollowDecision decide(const Sighting& sighting, Duration elapsed);

 private:
  FollowReason judge(const Sighting& sighting) const;
  void measure(const Sighting& sighting, FollowDecision& decision);
  FollowState state_when_unseen(Duration elapsed);
  [[nodiscard]] double search_side() const;
  Velocity wanted(const FollowDecision& decision) const;

  FollowParameters parameters_;
  DriveLimits limits_;
  std::optional<LearnedSize> reference_;
  double reference_distance_m_;
  Velocity goal_;
  ConfirmedMotion motion_;
  double last_bearing_rad_ = 0.0;
  Duration unseen_for_{};
  bool ever_seen_ = false;
};

}  // namespace cgsr::behavior
