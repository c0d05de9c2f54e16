#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "pipeline/behavior/fill_light.h"
#include "pipeline/behavior/follow.h"
#include "pipeline/behavior/follow_person_parameters.h"
#include "pipeline/behavior/free_floor.h"
#include "pipeline/behavior/keep_to_floor.h"
#include "pipeline/behavior/look_along.h"
#include "pipeline/behavior/route.h"
#include "pipeline/behavior/seek_lamp.h"
#include "pipeline/geometry/camera.h"
#include "pipeline/stages/task.h"

namespace cgsr::stages {

inline constexpr Duration kMaxPoseAge = seconds(0.5);  ///< of a pose that a task drives by.
inline constexpr Duration kMaxLampReportAge = seconds(0.5);

/// \return where the robot is; not known where that is too old to drive by.
behavior::PlanarPose pose_to_drive_by(const runtime::Aged<PoseEstimate>& pose);

/// Keeps the tracked object centred and at a distance (3.3.2).
class FollowTask final : public Task {
 public:
  /// \param camera  of the images that come: focal length and centre turn columns into bearings.
  FollowTask(const behavior::Follow& follow, const geometry::Camera& camera) : follow_(follow), camera_(camera) {}
  Decision decide(const FrameResult& frame, const ImageView& image, Duration elapsed) override;

 private:
  behavior::Follow follow_;
  geometry::Camera camera_;
};

/// Follows a person at a distance (6.4): by face or marker while one is seen, else by the shirt. A stranger is not followed, whatever he wears, and no shirt
/// below a face that stays a stranger's: not sure of it, Alg. 6.1 takes the shirt's word, but a negative face supersedes the shirt (6.4.3). Where the face
/// of somebody who is there is in the dark it asks for the fill light.
class FollowPersonTask final : public Task {
 public:
  /// \param person  the number in the identities file; 0: whoever is enrolled and comes first.
  /// \param camera  of the images that come.  \param light  when the fill light is asked for; not enabled: never.
  FollowPersonTask(const behavior::FollowPersonParameters& person, const behavior::FollowParameters& follow,
                   const behavior::DriveLimits& limits, const geometry::Camera& camera,
                   const behavior::FillLightParameters& light = {});
  [[nodiscard]] Requests first_requests() const override;
  Decision decide(const FrameResult& frame, const ImageView& image, Duration elapsed) override;

  /// From the next image on the robot drives no farther than the map's floor is free, where its pose is known (behavior::keep_to_floor()).
  void keep_to(std::shared_ptr<const behavior::FreeFloor> floor) { floor_ = std::move(floor); }
  /// From the next image on the person is followed only where face or marker say who it is; false: by the shirt too.
  void follow_by_primary_only(bool only) { by_primary_only_ = only; }
  /// Whether the face above the shirt by which the person is followed has been a stranger's for so long that the shirt is somebody else's.
  [[nodiscard]] bool is_with_a_stranger() const;

 private:
  void look_above_the_shirt(const IdentifiedPeople& people);
  void keep_to_floor(const FrameResult& frame, Decision& decision) const;
  [[nodiscard]] behavior::Sighting sighting_of(const person::PersonSighting& who, const ImageView& image) const;
  void light_the_face(const IdentifiedPeople* people, const ImageView& image, Duration elapsed, Decision& decision);

  person::Label person_;  // 0: nobody yet
  behavior::Follow follow_;
  std::optional<behavior::Sighting> last_;  // of the person, with its age
  geometry::Camera camera_;
  std::optional<behavior::FillLight> light_;
  std::shared_ptr<const behavior::FreeFloor> floor_;  // null: no map
  double deceleration_mps2_;
  bool by_primary_only_ = false;
  int stranger_images_ = 0;  // in a row, of those in which a face was found above the shirt
};

/// Who Is Who in a line (6.4.1.2): turns along a line of people and tells who each is. What is said is an event with numbers, never a name.
class WhoIsWhoTask final : public Task {
 public:
  /// \param camera  of the images that come.
  WhoIsWhoTask(const behavior::LookAlong& look, const geometry::Camera& camera) : look_(look), camera_(camera) {}
  Decision decide(const FrameResult& frame, const ImageView& image, Duration elapsed) override;

 private:
  behavior::LookAlong look_;
  geometry::Camera camera_;
};

/// Drives from place to place by the estimated pose.
class RouteTask final : public Task {
 public:
  explicit RouteTask(behavior::Route route) : route_(std::move(route)) {}
  Decision decide(const FrameResult& frame, const ImageView& image, Duration elapsed) override;

 private:
  behavior::Route route_;
};

/// Algorithm 5.2: looks for the lamp, measures it, backs off, and tracks an object with the shadow masks.
class LampTask final : public Task {
 public:
  explicit LampTask(behavior::SeekLamp seek) : seek_(std::move(seek)) {}
  [[nodiscard]] Requests first_requests() const override { return {.track = seek_.tracks(), .check = {}, .lamps = {}}; }
  Decision decide(const FrameResult& frame, const ImageView& image, Duration elapsed) override;

 private:
  behavior::SeekLamp seek_;
};

}  // namespace cgsr::stages
