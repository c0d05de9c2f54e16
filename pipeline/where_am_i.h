#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "pipeline/geometry/camera.h"
#include "pipeline/localization/localizer.h"
#include "pipeline/localization/pose_tracker.h"
#include "pipeline/odometry_track.h"
#include "pipeline/world/map.h"

namespace cgsr {

/// What a robot with a map knows of itself before the first image.
struct KnownSelf {
  std::unique_ptr<const world::Map> map;
  std::unique_ptr<render::Expectation> expectation;  ///< of that map; none: Localizer's own.
  geometry::Camera camera;                           ///< with its lens, in the size of the images that come.
  geometry::Pose X_RC = geometry::Pose::Identity();
  double axle_height_m = 0.24;  ///< about which the base leans.
  OdometryScales odometry;
  localization::LocalizerParameters localizer;
  localization::PoseTrackerParameters tracking;
  localization::Prior start;  ///< of the camera.
  std::vector<std::uint8_t>
      own_pixels;  ///< of the localizer's working size: where the robot sees itself; empty: nowhere.
};

/// Chapter 4 as the vision loop holds it: odometry carries the pose from exposure to exposure, images correct it.
///
/// Threads: one. After construction nothing here allocates.
class WhereAmI {
 public:
  explicit WhereAmI(KnownSelf self);
  WhereAmI(const WhereAmI&) = delete;
  WhereAmI& operator=(const WhereAmI&) = delete;

  /// What the base reported since the last image.
  void heard(const hal::Odometry& odometry) { odometry_.add(odometry); }

  /// Is an image of a size that look() takes?
  [[nodiscard]] bool takes(const ImageView& image) const {
    return (image.width_px == camera_.width_px && image.height_px == camera_.height_px) ||
           (image.width_px == working_.width_px && image.height_px == working_.height_px);
  }

  /// \param grey  of the camera's size or half of it.  \param stamp  start of its exposure.
  const localization::TrackedPose& look(const ImageView& grey, MonoTime stamp, WorkBudget& budget);

  /// \return X_WR of a pose X_WC.
  [[nodiscard]] geometry::Pose robot_at(const geometry::Pose& X_WC) const { return X_WC * X_CR_; }
  [[nodiscard]] const geometry::Pose& X_CR() const { return X_CR_; }
  [[nodiscard]] const world::Map& map() const { return *map_; }

 private:
  std::unique_ptr<const world::Map> map_;
  geometry::Pose X_CR_;
  double axle_height_m_;
  geometry::Camera camera_;
  geometry::Camera working_;
  localization::Localizer localizer_;
  localization::PoseTracker tracker_;
  std::vector<std::uint8_t> own_pixels_;
  OdometryTrack odometry_;
  std::optional<geometry::Pose> X_OR_;  // at the last image
};

}  // namespace cgsr
