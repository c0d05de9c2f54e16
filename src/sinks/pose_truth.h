#pragma once

#include <cstdint>
#include <numbers>
#include <optional>

#include "hal/simulation.h"
#include "pipeline/stages/localize_stage.h"

namespace cgsr::sinks {

inline constexpr double kAccurate_m = 0.05;
inline constexpr double kAccurate_rad = 1.5 * std::numbers::pi / 180.0;

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
  std::uint64_t accurate = 0;    ///< images in which the camera was less than kAccurate_m and kAccurate_rad off.
  double first_s = 0.0;          ///< stamp of the first correction.
  double longest_lost_s = 0.0;   ///< for how long on end it said that it is lost, or searched the whole map.
  double longest_wrong_s = 0.0;  ///< for how long on end it was not accurate and said that it knows where it is.
  double way_m = 0.0;            ///< that the robot drove, by truth.

  /// What odometry alone would have come to, from the pose of the first correction on: the robot's distance from where it is.
  double odometry_ends_off_m = 0.0;
  double odometry_worst_m = 0.0;  ///< likewise, the farthest on the way.
};

/// How far an image's pose was from the camera's true one.
struct PoseError {
  double position_m = 0.0;
  double direction_rad = 0.0;  ///< the whole rotation.
};

/// For how long on end something is so.
class Streak {
 public:
  /// \return the longest time so far, from the first image in which it is so to the first one in which it is not, or to the last one.
  double add(bool is_so, MonoTime stamp);

 private:
  std::optional<MonoTime> since_;
  double longest_s_ = 0.0;
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
  Streak lost_;
  Streak wrong_;
  std::optional<geometry::Pose> X_WO_;  // at the first correction, by truth
  std::optional<hal::FloorPose> last_;
  localization::TrackState state_ = localization::TrackState::kUnsure;
};

}  // namespace cgsr::sinks
