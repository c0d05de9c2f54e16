#pragma once

#include <cstdint>

#include "pipeline/localization/localizer.h"
#include "platform/parameters.h"

namespace cgsr::localization {

/// How the pose's uncertainty grows with the odometry, and when the pose is lost.
struct PoseTrackerParameters {
  double slip = 0.05;
  double slip_turn = 0.05;
  double drift_m = 0.0005;
  double drift_deg = 0.1;
  double tilt_deg = 0.5;
  double tilt_kept = 0.9997;
  double level_deg = 0.1;
  double height_m = 0.01;
  bool floor = true;
  int max_missed_corrections = 15;
  double max_sigma_m = 0.15;
  double max_sigma_deg = 4.0;
  double widen = 1.25;
  double max_lost_sigma_m = 0.5;
  double max_lost_sigma_deg = 12.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("slip", self.slip, {0.0, 1.0}, "",
                 "The standard deviation of an odometry step, relative to its length.");
    visit.number("slip_turn", self.slip_turn, {0.0, 1.0}, "",
                 "The standard deviation of an odometry turn, relative to its angle.");
    visit.number("drift_m", self.drift_m, {0.0, 0.2}, "m",
                 "The standard deviation of the position that is added with every image.");
    visit.number("drift_deg", self.drift_deg, {0.0, 10.0}, "deg",
                 "The standard deviation of the direction that is added with every image.");
    visit.number(
        "tilt_deg", self.tilt_deg, {0.01, 30.0}, "deg",
        "The standard deviation of the mount's roll and pitch at the start, on a floor; it decreases with the images.");
    visit.number("tilt_kept", self.tilt_kept, {0.0, 1.0}, "",
                 "The share of the observed deviation from the mount's roll and pitch that is kept from image to "
                 "image, on a floor.");
    visit.number("level_deg", self.level_deg, {0.001, 30.0}, "deg",
                 "The smallest standard deviation of roll and pitch, on a floor; it covers uneven floor and the error "
                 "of the base's pitch.");
    visit.number("height_m", self.height_m, {0.0005, 1.0}, "m",
                 "The standard deviation of the camera's height, on a floor.");
    visit.flag("floor", self.floor,
               "Height, roll and pitch are those of a robot on a level floor; otherwise all six numbers are free.");
    visit.number("max_missed_corrections", self.max_missed_corrections, {1, 1000}, "",
                 "The pose is lost after this many images that should have corrected it and did not; images without "
                 "visible map do not count.");
    visit.number("max_sigma_m", self.max_sigma_m, {0.01, 10.0}, "m",
                 "The pose is lost when the standard deviation of its position along the floor exceeds this.");
    visit.number("max_sigma_deg", self.max_sigma_deg, {0.1, 90.0}, "deg",
                 "The pose is lost when the standard deviation of its heading exceeds this.");
    visit.number("widen", self.widen, {1.0, 10.0}, "",
                 "The factor by which the covariance of a lost pose grows after each failed search.");
    visit.number("max_lost_sigma_m", self.max_lost_sigma_m, {0.05, 10.0}, "m",
                 "The standard deviation of a lost position does not grow beyond this.");
    visit.number("max_lost_sigma_deg", self.max_lost_sigma_deg, {1.0, 90.0}, "deg",
                 "The standard deviation of a lost heading does not grow beyond this.");
  }
};

/// How far the pose is to be trusted.
enum class TrackState : std::uint8_t {
  kUnsure,     ///< begun, no image has confirmed the pose yet.
  kTracking,   ///< the last images corrected the pose.
  kLost,       ///< too long without a correction: the belief widens and the search goes on.
  kRecovered,  ///< this image ended a loss; the next one says kTracking.
};

/// \return lower_case word.
std::string_view to_string(TrackState state);

/// The camera's pose at the last image. Its covariance is that of the step that geometry::moved() takes: metres and radians, axes of W.
struct TrackedPose {
  TrackState state = TrackState::kUnsure;
  geometry::Pose X_WC = geometry::Pose::Identity();
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  ///< in the world.
  Correction correction;                                       ///< of this image: what happened and why.
  int images_since_correction = 0;
  int failures = 0;  ///< of those, the ones that should have corrected it.
};

/// The pose of a camera on a robot over time: odometry carries it from image to image, images correct it.
/// Ours: the dissertation (4.1) assumes a pose estimate and does not say how it is carried on. The prediction is that of an extended Kalman
/// filter (Kalman 1960), with the odometry as its motion.
///
/// Allocates nothing after construction. Threads: one caller at a time.
class PoseTracker {
 public:
  /// \param localizer  outlives it.  \param X_RC  the camera's mount.
  PoseTracker(Localizer& localizer, const geometry::Pose& X_RC, const PoseTrackerParameters& parameters);

  /// Begins at a pose: of the robot's configuration, the last run's file or a marker.
  void start(const Prior& prior);

  /// Goes on from a pose that the last image confirmed to somebody else, as a search of the whole map: kTracking.
  /// \param confirmed  in the map as it is, as Correction's.
  void take_over(const Prior& confirmed);

  /// The robot moved by X_R0R1 since the last call, as its odometry says, aligned to the coming image's exposure.
  void moved(const geometry::Pose& X_R0R1);

  /// The robot's pitch at the coming image's exposure as its base measures it, positive nose down, about an axle that high; 0 until told. Only
  /// where the floor counts. What moved() was told contains it.
  void pitched(double pitch_rad, double axle_height_m) {
    pitch_rad_ = pitch_rad;
    axle_height_m_ = axle_height_m;
  }

  /// Looks at an image. Never damages the pose: what the gate refuses leaves the prediction.
  const TrackedPose& see(const ImageView& image, WorkBudget& budget, const std::uint8_t* mask = nullptr);

  [[nodiscard]] const TrackedPose& now() const { return now_; }

 private:
  void flatten();
  void widen();
  void was_not_corrected();
  [[nodiscard]] bool has_outgrown() const;

  Localizer* localizer_;
  geometry::Pose X_RC_;
  PoseTrackerParameters parameters_;
  TrackedPose now_;
  geometry::Matrix6d belief_ = geometry::Matrix6d::Zero();  ///< in the map as it is; now_'s has the map's error in it.
  double pitch_rad_ = 0.0;
  double axle_height_m_ = 0.0;
  double driven_m_ = 0.0;  ///< since the last correction: slip adds up along it.
  double turned_rad_ = 0.0;
};

}  // namespace cgsr::localization
