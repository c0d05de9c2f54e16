#pragma once

#include <cstdint>
#include <optional>

#include "hal/simulation.h"
#include "pipeline/stages/localize_stage.h"

namespace cgsr::sinks {

/// How well a simulated robot knew where it was, by what was really there. Counts begin with the first correction; images in which it searched the whole
/// map for its pose are counted by themselves.
struct PoseTruthStatistics {
  std::uint64_t images = 0;
  std::uint64_t corrected = 0;  ///< in which the image corrected the pose.
  std::uint64_t lost = 0;       ///< times the robot said that it is lost.
  std::uint64_t searching =
      0;  ///< images in which it searched the whole map, and said nothing of where it is; not among `images`.
  double mean_m = 0.0;  ///< of the camera's position error.
  double worst_m = 0.0;
  double worst_s = 0.0;   ///< stamp of the worst position.
  double mean_rad = 0.0;  ///< of the camera's direction error, the whole rotation.
  double worst_rad = 0.0;
  double way_m = 0.0;  ///< that the robot drove, by truth.

  /// What odometry alone would have come to, from the pose of the first correction on: the robot's distance from where it is.
  double odometry_ends_off_m = 0.0;
  double odometry_worst_m = 0.0;  ///< likewise, the farthest on the way.
};

/// How far an image's pose was from the camera's true one.
struct PoseError {
  double position_m = 0.0;
  double direction_rad = 0.0;  ///< the whole rotation.
};

/// Adds up the statistics, image by image.
class PoseTruth {
 public:
  /// \param odometry  the base's own, at about the image.
  /// \return this image's error; nothing before the first correction, without a map, and while the whole map is searched for the pose.
  std::optional<PoseError> add(const hal::ImageTruth& truth, const stages::PoseEstimate& pose,
                               const hal::Odometry& odometry);

  [[nodiscard]] const PoseTruthStatistics& statistics() const { return statistics_; }

 private:
  void follow_odometry(const hal::FloorPose& robot, const hal::Odometry& odometry);

  PoseTruthStatistics statistics_;
  std::optional<geometry::Pose> X_WO_;  // at the first correction, by truth
  std::optional<hal::FloorPose> last_;
  localization::TrackState state_ = localization::TrackState::kUnsure;
};

}  // namespace cgsr::sinks
