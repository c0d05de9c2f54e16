// cgsr calibrate as its user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/calibration/mount.h"
#include "src/input/camera_file.h"
#include "src/input/pose_file.h"
#include "tests/app/program.h"
#include "tests/calibration/board_pictures.h"

namespace cgsr::app {
namespace {

using calibration::Board;
using ::testing::HasSubstr;
using testing::run_cgsr;
using testing::ScratchFolder;

const Board kBoard{7, 4, 0.04};

void write_boards(const std::string& folder, int count) {
  std::mt19937 random(5);
  std::filesystem::create_directories(folder);
  const geometry::Camera camera = calibration::testing::true_camera();
  const calibration::testing::Photographs photographs(camera);
  for (int i = 0; i < count;) {
    const double part_x = 0.3 + 0.2 * (i % 3);
    const double part_y = 0.35 + 0.15 * ((i / 3) % 3);
    const auto X_CB =
        calibration::testing::board_before_camera(random, kBoard, camera, part_x, part_y, 0.45 + 0.02 * i);
    if (calibration::testing::corners_of(X_CB, kBoard, camera).empty()) continue;
    cv::imwrite(folder + fmt::format("/{:03}.png", i), photographs.of(X_CB, kBoard, random));
    ++i;
  }
}

TEST(CalibrateCommand, CameraFromAFolderOfBoards) {
  const ScratchFolder scratch;
  write_boards(scratch / "boards", 12);
  const auto run = run_cgsr({"calibrate", "camera", "--input", scratch / "boards", "--board", "7x4", "--square", "0.04",
                             "--output", scratch / "camera.yaml", "--picture", scratch / "corners.png", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_EQ(json["views"].size(), 12U);
  EXPECT_LT(json["rms_px"].get<double>(), 0.3);
  const auto camera = read_camera(scratch / "camera.yaml");
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_NEAR(camera->fx_px, calibration::testing::true_camera().fx_px, 0.01 * 611.0);
  EXPECT_NEAR(camera->cx_px, calibration::testing::true_camera().cx_px, 6.0);
  EXPECT_EQ(cv::imread(scratch / "corners.png").cols, 640);

  const auto wrong = run_cgsr(
      {"calibrate", "camera", "--input", scratch / "boards", "--board", "9x6", "--output", scratch / "no.yaml"});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.errors, HasSubstr("12 without a board"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "no.yaml"));
}

TEST(CalibrateCommand, MountFromABoardOnTheFloor) {
  const ScratchFolder scratch;
  std::mt19937 random(6);
  geometry::Pose X_RC = geometry::Pose::Identity();
  X_RC.linear() << 0, -0.5, 0.8660254, -1, 0, 0, 0, -0.8660254, -0.5;  // 30 degrees down
  X_RC.translation() = Eigen::Vector3d(0.1, 0.0, 0.6);
  const Board board{7, 4, 0.06};
  const geometry::Pose X_RB = calibration::board_on_floor(1.1, 0.2, -1.5707963);
  const geometry::Camera camera = calibration::testing::true_camera();
  ASSERT_FALSE(calibration::testing::corners_of(X_RC.inverse() * X_RB, board, camera).empty());
  const calibration::testing::Photographs photographs(camera);
  cv::imwrite(scratch / "board.png", photographs.of(X_RC.inverse() * X_RB, board, random));
  testing::write_text(scratch / "camera.yaml", camera_as_yaml(camera, "camera"));
  const auto run = run_cgsr({"calibrate", "mount", "--input", scratch / "board.png", "--board", "7x4", "--square",
                             "0.06", "--camera", scratch / "camera.yaml", "--board-at", "1.1,0.2,-90", "--output",
                             scratch / "robot.toml", "--picture", scratch / "fit.png", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto json = nlohmann::json::parse(run.output);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(json["position_m"][static_cast<std::size_t>(i)].get<double>(), X_RC.translation()[i], 0.01);
  EXPECT_THAT(testing::read_text(scratch / "robot.toml"), HasSubstr("[mount]\nposition_m = [ 0."));
  EXPECT_TRUE(std::filesystem::exists(scratch / "fit.png"));

  EXPECT_EQ(run_cgsr({"calibrate", "mount"}).exit_code, 2);
  const auto nowhere =
      run_cgsr({"calibrate", "mount", "--input", scratch / "board.png", "--camera", scratch / "camera.yaml"});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.errors, HasSubstr("--board-at"));
}

TEST(CalibrateCommand, OdometryFromARound) {
  const ScratchFolder scratch;
  std::string odometry = "frame,tx,ty,tz,qw,qx,qy,qz\n";
  std::string truth = odometry;
  std::string camera = odometry;
  calibration::Mount mount;
  mount.X_RC.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  mount.X_RC.translation() = Eigen::Vector3d(0.2, 0.05, 1.1);
  geometry::Pose X_OR = geometry::Pose::Identity();
  geometry::Pose X_WR = geometry::pose_on_floor(1.0, 2.0, 0.3);
  for (int i = 0; i < 300; ++i) {
    if (i % 3 != 1) odometry += fmt::format("{},{}\n", i, pose_as_csv(X_OR));  // not every image has both
    if (i % 3 != 2) truth += fmt::format("{},{}\n", i, pose_as_csv(X_WR));
    camera += fmt::format("{},{}\n", i, pose_as_csv(X_WR * mount.X_RC));
    X_OR = X_OR * geometry::pose_on_floor(0.05, 0.0, 0.04);
    X_WR = X_WR * geometry::pose_on_floor(0.052, 0.0, 0.038);
  }
  testing::write_text(scratch / "odometry.csv", odometry);
  testing::write_text(scratch / "truth.csv", truth);
  const auto run =
      run_cgsr({"calibrate", "odometry", "--odometry", scratch / "odometry.csv", "--poses", scratch / "truth.csv",
                "--output", scratch / "odometry.toml", "--picture", scratch / "ways.png", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_NEAR(json["scale_forward"].get<double>(), 1.04, 0.002);
  EXPECT_NEAR(json["scale_turn"].get<double>(), 0.95, 0.002);
  EXPECT_THAT(testing::read_text(scratch / "odometry.toml"), HasSubstr("scale_turn = 0.9"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "ways.png"));

  // The same from the camera's poses, as cgsr localize writes them.
  testing::write_text(scratch / "robot.toml", calibration::mount_as_toml(mount));
  testing::write_text(scratch / "camera.csv", camera);
  const auto seen = run_cgsr({"calibrate", "odometry", "--odometry", scratch / "odometry.csv", "--poses",
                              scratch / "camera.csv", "--mount", scratch / "robot.toml", "--json"});
  ASSERT_EQ(seen.exit_code, 0) << seen.errors;
  EXPECT_NEAR(nlohmann::json::parse(seen.output)["scale_forward"].get<double>(), 1.04, 0.002);
  const auto unturned = run_cgsr({"calibrate", "odometry", "--odometry", scratch / "odometry.csv", "--poses",
                                  scratch / "camera.csv", "--output", scratch / "no.toml"});
  EXPECT_EQ(unturned.exit_code, 1);
  EXPECT_THAT(unturned.errors, HasSubstr("lean by up to 90 degrees; expected the robot's"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "no.toml"));

  const auto missing =
      run_cgsr({"calibrate", "odometry", "--odometry", scratch / "none.csv", "--poses", scratch / "truth.csv"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.errors, HasSubstr("none.csv"));
}

}  // namespace
}  // namespace cgsr::app
