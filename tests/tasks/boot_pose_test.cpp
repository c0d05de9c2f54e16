#include "src/boot/boot_pose.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/support/scratch_folder.h"

namespace cgsr::boot {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// A level camera, 1.2 m above the robot's place.
geometry::Pose mount() {
  geometry::Pose X_RC = geometry::Pose::Identity();
  X_RC.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  X_RC.translation() = Eigen::Vector3d(0.1, 0.0, 1.2);
  return X_RC;
}

calibration::Marker marker_on_the_wall() {
  calibration::Marker marker;
  marker.id = 7;
  marker.side_m = 0.3;
  marker.x_m = 5.0;
  marker.y_m = 2.0;
  marker.z_m = 1.4;
  marker.facing_deg = 180.0;  // towards smaller x
  return marker;
}

/// What a camera sees of the marker on a white wall: its corners by hand, its inside by a perspective.
cv::Mat photograph(const calibration::Marker& marker, const geometry::Camera& camera, const geometry::Pose& X_WC) {
  cv::Mat square;
  cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50), marker.id, 240, square, 1);
  const double half = 0.5 * marker.side_m;
  std::vector<cv::Point2f> to;
  for (const auto& [right, down] :
       {std::pair(-half, -half), std::pair(half, -half), std::pair(half, half), std::pair(-half, half)}) {
    // Facing 180 degrees, a viewer looks along +x: his right is -y.
    const Eigen::Vector3d p_W(marker.x_m, marker.y_m - right, marker.z_m - down);
    const auto pixel = camera.pixel_of(X_WC.inverse() * p_W);
    to.emplace_back(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()));
  }
  const std::vector<cv::Point2f> from{{-0.5F, -0.5F}, {239.5F, -0.5F}, {239.5F, 239.5F}, {-0.5F, 239.5F}};
  cv::Mat picture;
  cv::warpPerspective(square, picture, cv::getPerspectiveTransform(from, to), {640, 480}, cv::INTER_AREA,
                      cv::BORDER_CONSTANT, 255);
  cv::GaussianBlur(picture, picture, {3, 3}, 0.7);
  return picture;
}

TEST(BootPose, AMarkerOfKnownPlaceSaysWhereTheCameraIs) {
  const geometry::Camera camera;
  const auto marker = marker_on_the_wall();
  for (const double heading_deg : {-12.0, 3.0, 12.0}) {
    const geometry::Pose X_WC = geometry::pose_on_floor(3.2, 2.5, heading_deg * kDegree - 0.2) * mount();
    const cv::Mat picture = photograph(marker, camera, X_WC);
    const auto found = calibration::camera_by_marker(marker, camera, picture);
    ASSERT_TRUE(found) << heading_deg;
    const auto error = geometry::step_between(X_WC, *found);
    EXPECT_LT(error.head<3>().norm(), 0.05) << heading_deg;
    EXPECT_LT(error.tail<3>().norm(), 2.5 * kDegree) << heading_deg;
  }
}

TEST(BootPose, AnotherMarkerOrNoneSaysNothing) {
  const geometry::Camera camera;
  auto marker = marker_on_the_wall();
  const cv::Mat picture = photograph(marker, camera, geometry::pose_on_floor(3.2, 2.2, 0.0) * mount());
  marker.id = 8;
  EXPECT_FALSE(calibration::camera_by_marker(marker, camera, picture));
  EXPECT_FALSE(
      calibration::camera_by_marker(marker_on_the_wall(), camera, cv::Mat(480, 640, CV_8UC1, cv::Scalar(255))));
}

TEST(BootPose, WhatTheLastRunLeftComesFirst) {
  const test::ScratchFolder scratch;
  const auto file = scratch / "last-pose.csv";
  config::StartPose start;
  start.x_m = 1.0;
  start.file = file.string();
  const auto without = boot_pose(start, {}, mount(), {});
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_NEAR(without->prior.X_WC.translation().x(), 1.1, 1e-9);

  ASSERT_TRUE(leave_pose(file, geometry::pose_on_floor(4.0, -2.0, 0.5)));
  const auto with = boot_pose(start, {}, mount(), {});
  ASSERT_TRUE(with) << with.error().message;
  EXPECT_LT(((geometry::pose_on_floor(4.0, -2.0, 0.5) * mount()).translation() - with->prior.X_WC.translation()).norm(),
            1e-5);
}

// A run takes the pose away before it moves: killed, it leaves none.
TEST(BootPose, WhatWasWithdrawnIsNotBelievedAgain) {
  const test::ScratchFolder scratch;
  const auto file = scratch / "last-pose.csv";
  const auto link = scratch / "link.csv";
  std::filesystem::create_symlink("last-pose.csv", link);
  config::StartPose start;
  start.x_m = 1.0;
  start.file = link.string();
  const auto none = withdraw_pose(link);
  ASSERT_TRUE(none) << "the first run finds none";
  EXPECT_TRUE(none->empty());
  for (int run = 0; run < 2; ++run) {
    ASSERT_TRUE(leave_pose(link, geometry::pose_on_floor(4.0, -2.0, 0.5)));
    const auto withdrawn = withdraw_pose(link);
    ASSERT_TRUE(withdrawn);
    EXPECT_FALSE(std::filesystem::exists(file));
    EXPECT_TRUE(std::filesystem::is_symlink(link)) << "it says where the next pose goes";
    const auto boot = boot_pose(start, {}, mount(), {});
    ASSERT_TRUE(boot) << boot.error().message;
    EXPECT_EQ(boot->message, "the robot's file");
    ASSERT_TRUE(put_back_pose(link, *withdrawn));
    const auto unmoved = boot_pose(start, {}, mount(), {});
    ASSERT_TRUE(unmoved) << unmoved.error().message;
    EXPECT_LT(
        ((geometry::pose_on_floor(4.0, -2.0, 0.5) * mount()).translation() - unmoved->prior.X_WC.translation()).norm(),
        1e-5);
  }
}

TEST(BootPoseFault, ADamagedFileIsSaidWithItsLine) {
  const test::ScratchFolder scratch;
  const auto file = scratch / "bad-pose.csv";
  std::ofstream(file) << "tx,ty,tz,qw,qx,qy,qz\n1,2,nan,1,0,0,0\n";
  config::StartPose start;
  start.file = file.string();
  const auto boot = boot_pose(start, {}, mount(), {});
  ASSERT_FALSE(boot);
  EXPECT_NE(boot.error().message.find(":2"), std::string::npos) << boot.error().message;
}

}  // namespace
}  // namespace cgsr::boot
