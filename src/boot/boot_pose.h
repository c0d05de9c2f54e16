#pragma once

#include <filesystem>
#include <string>

#include "pipeline/geometry/camera.h"
#include "pipeline/localization/correction.h"
#include "platform/error.h"
#include "platform/image_view.h"
#include "src/config/robot_localization.h"

namespace cgsr::boot {

/// Where the robot's camera is believed to be before the first image is looked at. From the first of these that says so:
/// the file in which the last run left its pose, a marker of known place in the first image, the robot's configuration.
struct BootPose {
  localization::Prior prior;
  bool anywhere = false;  ///< `prior` says nothing: the robot is to seek its first pose.
  std::string message;    ///< where it comes from, for people.
};

/// \param first_image  YUYV; empty: no marker is looked for.  \param camera  of that image's size.
/// \return the pose; or what is wrong with the last run's file, with its line. A marker that is not seen is no error.
Result<BootPose> boot_pose(const config::StartPose& start, const geometry::Camera& camera, const geometry::Pose& X_RC,
                           const ImageView& first_image);

/// Takes away what the last run left, which is outdated once the robot moves: a run that ends lost, is killed or loses power must leave no
/// pose to the next one. To be called after boot_pose() and before the first command to the base. A file that is not there is no error. Ours.
/// \return what it held, for put_back_pose(), empty where there was none; or why it stays, with the file: the run must then not begin.
Result<std::string> withdraw_pose(const std::filesystem::path& file);

/// Puts back what withdraw_pose() took away, for the robot has not moved since; whole or not at all.
Result<void> put_back_pose(const std::filesystem::path& file, const std::string& text);

/// Leaves the robot's pose on its floor for the next run, X_WR; whole or not at all.
Result<void> leave_pose(const std::filesystem::path& file, const geometry::Pose& X_WR);

}  // namespace cgsr::boot
