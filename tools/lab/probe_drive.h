#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/lamp.h"
#include "pipeline/stages/probes_stage.h"
#include "platform/error.h"
#include "src/config/robot.h"
#include "tools/lab/probe_room.h"

namespace cgsr::lab {

inline constexpr int kDriveImages = 40;

/// A drive below the room's lamp: 6 cm from image to image, turned away where it is blocked or the light gets flatter than
/// 60 degrees.
/// \return the robot's poses, `start` the first of them.
std::vector<sim::Pose> drive_below_lamp(ProbeRoom& room, const sim::Pose& start, Random& random);

/// How the pose errs that localization estimates: by 1 cm along x and along y and by 0.3 degrees, as it states.
enum class DriveErrors : std::uint8_t {
  kOfEachImage,  ///< drawn anew in every image.
  kThatLast,  ///< of the map and of what is matched: they fade over the way and over the turn (a Gauss-Markov sequence).
};
inline constexpr std::size_t kDriveErrors = 2;
constexpr std::string_view to_string(DriveErrors errors) {
  return errors == DriveErrors::kThatLast ? "pose errors that last" : "pose errors of each image";
}

/// The estimated pose of a robot, from image to image.
class EstimatedPose {
 public:
  EstimatedPose(DriveErrors errors, const Random& random) : errors_(errors), random_(random) {}

  stages::PlacedRobot at(const sim::Pose& X_WR);

 private:
  DriveErrors errors_;
  Random random_;
  geometry::Vector6d off_ = geometry::Vector6d::Zero();
  std::optional<sim::Pose> X_WR_before_;
};

/// What the robot's stage (Alg. 5.1 and the filter over images) knows of the lamp during one drive, for each kind of DriveErrors: the same images.
/// \param lamp  instead of the robot's section [lamp].  \param after_image  is told the number of each image and what is known then.
/// \return what is known at the end.
Result<std::array<stages::LampReport, kDriveErrors>> locate_while_driving(
    ProbeRoom& room, const config::Robot& robot, const illumination::LampParameters& lamp, const sim::Pose& start,
    Random random,
    const std::function<void(std::size_t image, const std::array<stages::LampReport, kDriveErrors>& known)>&
        after_image);

}  // namespace cgsr::lab
