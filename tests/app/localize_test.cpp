// cgsr localize on rendered images and on those that others made.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pipeline/world/compact.h"
#include "pipeline/world/load.h"
#include "src/input/pose_file.h"
#include "tests/app/program.h"
#include "tests/support/real_data.h"

namespace cgsr::app::testing {
namespace {

using ::testing::HasSubstr;

constexpr int kImages = 3;
constexpr const char* kColumns = "frame,tx,ty,tz,qw,qx,qy,qz\n";

/// Three images of the room with the poster, from a camera on a robot that drives 2.2 cm from one to the next.
class LocalizeFilm : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<ScratchFolder>();
    const auto exported = run_cgsr({"sim", "export", "--world", kWorld, "--errors", "0", "--output", file("room")});
    ASSERT_EQ(exported.exit_code, 0) << exported.errors;
    std::filesystem::create_directories(file("film"));
    for (int i = 0; i < kImages; ++i) {
      const auto drawn = run_cgsr({"sim", "render", "--world", kWorld, "--pose", pose_as_csv(true_pose(i)), "--seed",
                                   fmt::format("{}", i + 1), "--output", file(fmt::format("film/{}.png", i))});
      ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
    }
    std::string priors = kColumns;
    std::string odometry = kColumns;
    geometry::Pose X_OO = geometry::Pose::Identity();
    for (int i = 0; i < kImages; ++i) {
      geometry::Pose prior = true_pose(i);
      prior.translation() += Eigen::Vector3d(0.06, -0.05, 0.03);
      priors += fmt::format("{},{}\n", i, pose_as_csv(prior));
      X_OO.translation() = true_pose(i).translation() - true_pose(0).translation();
      odometry += fmt::format("{},{}\n", i, pose_as_csv(X_OO));
    }
    write_text(file("priors.csv"), priors);
    write_text(file("odometry.csv"), odometry);
    geometry::Pose start = true_pose(0);
    start.translation() += Eigen::Vector3d(0.03, -0.03, 0.01);
    write_text(file("pose.csv"), fmt::format("{}\n{}\n", kPoseColumns, pose_as_csv(start)));
    geometry::Pose X_RC = true_pose(0);
    X_RC.translation() = Eigen::Vector3d(0.0, 0.0, 1.2);
    write_text(file("mount.csv"), fmt::format("{}\n{}\n", kPoseColumns, pose_as_csv(X_RC)));
  }
  static void TearDownTestSuite() { shared_.reset(); }

  static std::string file(const std::string& name) { return *shared_ / name; }

  /// Looks along x, 6 degrees down.
  static geometry::Pose true_pose(int image) {
    geometry::Pose X_WC = geometry::Pose::Identity();
    X_WC.linear() =
        Eigen::Quaterniond(0.47314679, -0.52548275, 0.52548275, -0.47314679).normalized().toRotationMatrix();
    X_WC.translation() = Eigen::Vector3d(0.8 + 0.02 * image, -0.3 + 0.01 * image, 1.2);
    return X_WC;
  }

  /// With the room's own map and camera, unless `more` names others.
  static Outcome localize(const std::vector<std::string>& more, const std::string& map = file("room/map.obj"),
                          const std::string& camera = file("room/calibrated/camera.yaml"),
                          const std::string& film = file("film")) {
    std::vector<std::string> words{"localize", "--map", map, "--camera", camera, "--input", film};
    words.insert(words.end(), more.begin(), more.end());
    return run_cgsr(words);
  }

  /// All corrected, and right.
  static void expect_right(const std::string& csv) {
    const auto rows = read_poses(csv);
    ASSERT_TRUE(rows) << rows.error().message;
    ASSERT_EQ(rows->size(), static_cast<std::size_t>(kImages));
    for (int i = 0; i < kImages; ++i) {
      const PoseRow& row = (*rows)[static_cast<std::size_t>(i)];
      EXPECT_EQ(row.frame, i);
      EXPECT_TRUE(row.corrected) << i;
      EXPECT_LT((row.X.translation() - true_pose(i).translation()).norm(), 0.03) << i;
      EXPECT_LT(geometry::vector_of(row.X.linear().transpose() * true_pose(i).linear()).norm(), 0.01) << i;
    }
  }

  static constexpr const char* kWorld = CGSR_SOURCE_DIR "/config/worlds/occlusion.toml";
  static constexpr const char* kFloor = CGSR_SOURCE_DIR "/config/localization/floor.toml";
  static inline std::unique_ptr<ScratchFolder> shared_;
};

/// The robot turns on the spot once and a little more, an image every 30 degrees, and stands then. Its odometry turns 2 % too far.
class TurningFilm : public LocalizeFilm {
 protected:
  static constexpr int kTurned = 15;
  static constexpr int kAll = 30;
  static constexpr double kFirst_rad = -std::numbers::pi / 3.0;

  static geometry::Pose X_WR(int image) {
    return geometry::pose_on_floor(2.0, 0.3, kFirst_rad + std::min(image, kTurned - 1) * std::numbers::pi / 6.0);
  }

  static void SetUpTestSuite() {
    LocalizeFilm::SetUpTestSuite();
    std::filesystem::create_directories(file("turn"));
    geometry::Pose X_RC = true_pose(0);
    X_RC.translation() = Eigen::Vector3d(0.0, 0.0, 1.2);
    std::string odometry = kColumns;
    for (int i = 0; i < kAll; ++i) {
      const std::string name = file(fmt::format("turn/{:02}.png", i));
      if (i < kTurned) {
        const auto drawn = run_cgsr({"sim", "render", "--world", kWorld, "--pose", pose_as_csv(X_WR(i) * X_RC),
                                     "--seed", fmt::format("{}", i + 1), "--edge-samples", "1", "--output", name});
        ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
      } else {
        std::filesystem::copy_file(file(fmt::format("turn/{:02}.png", kTurned - 1)), name);
      }
      const double turned = std::min(i, kTurned - 1) * std::numbers::pi / 6.0;
      odometry += fmt::format("{},{}\n", i, pose_as_csv(geometry::pose_on_floor(7.0, 1.0, 0.4 + 1.02 * turned)));
    }
    write_text(file("turn.csv"), odometry);
  }

  static Outcome localize_turn(std::vector<std::string> more) {
    more.insert(more.begin(), {"--anywhere", "--odometry", file("turn.csv"), "--config", kFloor, "--units", "0"});
    return localize(more, file("room/map.obj"), file("room/calibrated/camera.yaml"), file("turn"));
  }
};

TEST_F(TurningFilm, FindsTheFirstPoseAndFollowsFromThere) {
  const auto run = localize_turn({"--mount", file("mount.csv"), "--csv", file("found.csv"), "--json",
                                  file("found.json"), "--plan", file("plan.png"), "--video", file("found.avi")});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("first pose: found"));
  EXPECT_TRUE(std::filesystem::exists(file("plan.png")));
  const auto json = nlohmann::json::parse(read_text(file("found.json")));
  ASSERT_TRUE(json.at("found_in").is_number()) << run.errors;
  EXPECT_EQ(json.at("first_pose"), "found");
  EXPECT_GE(json.at("found_in"), 12);
  EXPECT_EQ(json.at("corrected"), kAll - json.at("found_in").get<int>());
  std::istringstream lines(read_text(file("found.csv")));
  std::string last;
  for (std::string line; std::getline(lines, line);) last = line;
  EXPECT_THAT(last, ::testing::StartsWith("29,1,,2.0"));
  EXPECT_THAT(read_text(file("found.csv")), HasSubstr("\n0,0,searching,,,,,,,,0,0.000\n"));
}

TEST_F(TurningFilm, NeedsAFloorAMountAndOdometry) {
  const auto no_mount = localize_turn({});
  EXPECT_NE(no_mount.exit_code, 0);
  EXPECT_THAT(no_mount.errors, HasSubstr("--anywhere requires --mount"));
  const auto no_floor = localize({"--anywhere", "--odometry", file("turn.csv"), "--mount", file("mount.csv")},
                                 file("room/map.obj"), file("room/calibrated/camera.yaml"), file("turn"));
  EXPECT_NE(no_floor.exit_code, 0);
  EXPECT_THAT(no_floor.errors, HasSubstr("tracker.floor = false: --anywhere finds the pose of a robot on a floor"));
  const auto few = localize(
      {"--anywhere", "--odometry", file("turn.csv"), "--mount", file("mount.csv"), "--config", kFloor, "--units", "3"},
      file("room/map.obj"), file("room/calibrated/camera.yaml"), file("turn"));
  EXPECT_NE(few.exit_code, 0);
  EXPECT_THAT(few.errors, HasSubstr("--units 3: --anywhere needs at least 6"));
  const auto both = localize_turn({"--mount", file("mount.csv"), "--pose", file("pose.csv")});
  EXPECT_THAT(both.errors, HasSubstr("--pose excludes --anywhere"));
}

TEST_F(LocalizeFilm, CorrectsEachImageFromItsPrior) {
  const auto run = localize({"--priors", file("priors.csv"), "--csv", file("each.csv"), "--json", file("each.json")});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("3 images, pose corrected in 3"));
  expect_right(file("each.csv"));
  EXPECT_EQ(nlohmann::json::parse(read_text(file("each.json"))).at("corrected"), kImages);
}

// The priors are 8 cm off.
TEST_F(LocalizeFilm, TakesTheWidthOfThePriorsFromTheCommandLine) {
  const auto sure = localize({"--priors", file("priors.csv"), "--sigma-m", "0.002", "--sigma-deg", "0.1"});
  ASSERT_EQ(sure.exit_code, 0) << sure.errors;
  EXPECT_THAT(sure.output, HasSubstr("3 images, pose corrected in 0"));
  const auto wide = localize(
      {"--priors", file("priors.csv"), "--sigma-m", "0.2", "--sigma-deg", "3", "--csv", file("wide.csv"), "--force"});
  ASSERT_EQ(wide.exit_code, 0) << wide.errors;
  expect_right(file("wide.csv"));
}

// The same room in centimetres with y up.
TEST_F(LocalizeFilm, TakesAMapInItsOwnUnitsAndAxes) {
  std::istringstream lines(read_text(file("room/map.obj")));
  std::string other;
  for (std::string line; std::getline(lines, line);) {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    const bool corner = std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3;
    other += corner ? fmt::format("v {} {} {}\n", 100.0 * x, 100.0 * z, -100.0 * y) : line + "\n";
  }
  write_text(file("room/centimetres.obj"), other);
  const auto run = localize({"--priors", file("priors.csv"), "--up", "y", "--scale", "0.01", "--csv", file("cm.csv")},
                            file("room/centimetres.obj"));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  expect_right(file("cm.csv"));
  const auto wrong = localize({"--priors", file("priors.csv"), "--up", "x"});
  EXPECT_NE(wrong.exit_code, 0);
  EXPECT_THAT(wrong.errors, HasSubstr("format,z,y"));
}

TEST_F(LocalizeFilm, FollowsFromThePoseOfTheFirst) {
  const auto run = localize({"--pose", file("pose.csv"), "--csv", file("hand.csv")});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  expect_right(file("hand.csv"));
  const auto driven = localize({"--pose", file("pose.csv"), "--odometry", file("odometry.csv"), "--mount",
                                file("mount.csv"), "--config", kFloor, "--csv", file("floor.csv")});
  ASSERT_EQ(driven.exit_code, 0) << driven.errors;
  expect_right(file("floor.csv"));
}

// The file that cgsr calibrate mount writes says it too, and what is visible may be drawn through OpenGL.
TEST_F(LocalizeFilm, FollowsWithARobotsFileAndThroughOpenGl) {
  const Eigen::Quaterniond turn(true_pose(0).linear());
  write_text(file("robot.toml"),
             fmt::format("[mount]\nposition_m = [0.0, 0.0, 1.2]\nquaternion_wxyz = [{}, {}, {}, {}]\n", turn.w(),
                         turn.x(), turn.y(), turn.z()));
  write_text(file("opengl.toml"), read_text(kFloor) + "\n[localization.localizer]\nexpectation = \"osmesa\"\n");
  const auto run = localize({"--pose", file("pose.csv"), "--odometry", file("odometry.csv"), "--mount",
                             file("robot.toml"), "--config", file("opengl.toml"), "--csv", file("opengl.csv")});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  expect_right(file("opengl.csv"));
}

TEST_F(LocalizeFilm, WithoutOpenGlsLibraryBesideTheProgramItSaysSo) {
  std::filesystem::copy_file(built_cgsr(), file("cgsr"));
  write_text(file("without.toml"), "[localization]\nlocalizer.expectation = \"osmesa\"\ntracker.floor = false\n");
  const auto run = run_cgsr({"localize", "--map", file("room/map.obj"), "--camera", file("room/calibrated/camera.yaml"),
                             "--input", file("film"), "--pose", file("pose.csv"), "--config", file("without.toml")},
                            file("cgsr"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.errors, HasSubstr("localizer.expectation = \"osmesa\" cannot be loaded"));
  EXPECT_THAT(run.errors, HasSubstr("cgsr-opengl.so"));
}

TEST_F(LocalizeFilm, ADamagedImageIsToldOnceAndItsNumberIsPassedOver) {
  std::filesystem::copy(file("film"), file("damaged"));
  write_text(file("damaged/1.png"), "no image");
  const auto run = localize({"--priors", file("priors.csv"), "--csv", file("damaged.csv")}, file("room/map.obj"),
                            file("room/calibrated/camera.yaml"), file("damaged"));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const std::size_t told = run.errors.find("1.png");
  ASSERT_NE(told, std::string::npos) << run.errors;
  EXPECT_EQ(run.errors.find("1.png", told + 5), std::string::npos) << run.errors;
  const auto rows = read_poses(file("damaged.csv"));
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ(rows->back().frame, 2);
}

TEST_F(LocalizeFilm, WhatIsWrongIsNamed) {
  write_text(file("small.yaml"),
             "image_width: 320\nimage_height: 240\ncamera_name: small\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
             "  data: [300.0, 0.0, 159.5, 0.0, 300.0, 119.5, 0.0, 0.0, 1.0]\ndistortion_model: plumb_bob\n"
             "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.0, 0.0, 0.0, 0.0, 0.0]\n");
  auto bare = world::load_map(file("room/map.obj"));
  ASSERT_TRUE(bare) << bare.error().message;
  bare->edges.clear();
  ASSERT_TRUE(world::write_compact(*bare, file("bare.cgsrmap")));
  write_text(file("first.csv"), fmt::format("{}0,{}\n", kColumns, pose_as_csv(true_pose(0))));
  write_text(file("wrong.toml"), "[localization.tracker]\nflor = true\n");

  const std::string map = file("room/map.obj");
  const std::string camera = file("room/calibrated/camera.yaml");
  const std::vector<std::string> pose{"--pose", file("pose.csv")};
  struct Case {
    std::vector<std::string> words;
    std::string map;
    std::string camera;
    std::string cause;
  };
  const std::vector<Case> cases = {
      {{"--pose", file("none.csv")}, map, camera, "none.csv: cannot be read"},
      {{"--priors", file("none.csv")}, map, camera, "none.csv: cannot be read"},
      {{"--pose", file("priors.csv")}, map, camera, "priors.csv:3: holds 3 poses: expected one"},
      {{"--priors", file("first.csv")}, map, camera, "first.csv: holds no pose for image 1"},
      {{"--pose", file("pose.csv"), "--odometry", file("first.csv")},
       map,
       camera,
       "first.csv: holds no pose for image 1"},
      {pose, map, file("small.yaml"), "film: images of 640 x 480 px: expected 320 x 240, the size of the camera in "},
      {pose, map, file("none.yaml"), "none.yaml: cannot be read"},
      {pose, file("none.obj"), camera, "none.obj: No such file"},
      {pose, file("bare.cgsrmap"), camera, "bare.cgsrmap: holds no edge to look for"},
      {{"--pose", file("pose.csv"), "--config", kFloor},
       map,
       camera,
       "floor.toml: tracker.floor = true needs --mount: where the camera is on the robot"},
      {{"--pose", file("pose.csv"), "--mount", file("none.csv")}, map, camera, "none.csv: cannot be read"},
      {{"--pose", file("pose.csv"), "--mount", file("wrong.toml")}, map, camera, "wrong.toml: has no section [mount]"},
      {{"--pose", file("pose.csv"), "--config", file("wrong.toml")},
       map,
       camera,
       "wrong.toml:2: localization.tracker.flor"},
      {{"--pose", file("pose.csv"), "--csv", "/nowhere/at/all.csv"},
       map,
       camera,
       "/nowhere/at/all.csv: cannot be written"},
  };
  for (const Case& wrong : cases) {
    const auto run = localize(wrong.words, wrong.map, wrong.camera);
    EXPECT_EQ(run.exit_code, 1) << wrong.cause;
    EXPECT_THAT(run.errors, HasSubstr(wrong.cause));
  }
  const auto neither = localize({});
  EXPECT_EQ(neither.exit_code, 2);
  EXPECT_THAT(neither.errors, HasSubstr("give either --pose, --priors or --anywhere"));
  EXPECT_EQ(localize({"--pose", file("pose.csv"), "--priors", file("priors.csv")}).exit_code, 2);
}

// A cube on a table: the map knows nothing of what fills most of the image. The camera and the first pose are those that came with it.
// A map of 90,000 squares takes seconds to clean up: who stops the program meanwhile does not wait for it.
/// Waits until the process handles the signal itself: before, starting the program, the signal simply ends it.
void wait_until_handled(pid_t process, int signal) {
  for (int i = 0; i < 2000; ++i) {
    const std::string status = read_text(fmt::format("/proc/{}/status", process));
    const auto at = status.find("SigCgt:");
    if (at != std::string::npos) {
      const auto caught = std::stoull(status.substr(at + 7, 20), nullptr, 16);
      if ((caught >> (signal - 1) & 1U) != 0U) break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

TEST_F(LocalizeFilm, ASignalWhileALargeMapIsLoadedEndsItWithin200Milliseconds) {
  constexpr int kSquares = 300;
  std::string text;
  for (int i = 0; i < kSquares * kSquares; ++i) {
    const int x = i % kSquares;
    const int y = i / kSquares;
    const int z = (x + y) % 2;
    text += fmt::format("v {} {} {}\nv {} {} {}\nv {} {} {}\nv {} {} {}\nf -4 -3 -2 -1\n", x, y, z, x + 1, y, z, x + 1,
                        y + 1, z, x, y + 1, z);
  }
  write_text(file("large.obj"), text);
  for (const int signal : {SIGTERM, SIGHUP}) {
    RunningCgsr running({"localize", "--map", file("large.obj"), "--camera", file("room/calibrated/camera.yaml"),
                         "--input", file("film"), "--pose", file("pose.csv"), "--csv", file("large.csv")});
    wait_until_handled(running.process(), signal);
    const auto begin = std::chrono::steady_clock::now();
    running.send(signal);
    const auto outcome = running.wait();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(200));
    EXPECT_EQ(outcome.exit_code, 3) << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr("while loading"));
    EXPECT_FALSE(std::filesystem::exists(file("large.csv")));
  }
}

TEST(LocalizeCommand, FollowsTheRecordedCube) {
  CGSR_NEEDS_REAL_DATA("localization/cube");
  const std::filesystem::path folder = test::real_data("localization/cube");
  const ScratchFolder scratch;
  write_text(scratch / "camera.yaml",
             "image_width: 640\nimage_height: 480\ncamera_name: cube\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
             "  data: [547.7367575, 0.0, 338.7036994, 0.0, 542.0744058, 234.5083345, 0.0, 0.0, 1.0]\n"
             "distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.0, 0.0, 0.0, "
             "0.0, 0.0]\n");
  write_text(scratch / "pose.csv",
             "tx,ty,tz,qw,qx,qy,qz\n"
             "0.22309615,-0.18366902,0.43085227,0.34542029,-0.80912113,-0.44175978,0.17565913\n");
  const Outcome run =
      run_cgsr({"localize", "--map", (folder / "cube.cao").string(), "--camera", scratch / "camera.yaml", "--input",
                (folder / "img").string(), "--pose", scratch / "pose.csv", "--config",
                CGSR_SOURCE_DIR "/config/localization/free.toml", "--json", scratch / "sum.json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto sum = nlohmann::json::parse(read_text(scratch / "sum.json"));
  EXPECT_EQ(sum.at("images"), 110);
  EXPECT_GE(sum.at("corrected").get<int>(), 105);
}

}  // namespace
}  // namespace cgsr::app::testing
