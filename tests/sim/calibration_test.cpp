#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core/persistence.hpp>

#include "hal/sim/calibration/calibrated_copy.h"
#include "hal/sim/calibration/calibration_files.h"
#include "hal/sim/calibration/map_file.h"
#include "hal/sim/scene/map_count.h"
#include "hal/sim/scene/portable_math.h"
#include "hal/sim/worlds/mesh_file.h"
#include "tests/app/program.h"
#include "tests/sim/small_scenes.h"
#include "tools/sim/world_file.h"

namespace cgsr::sim {
namespace {

using app::testing::ScratchFolder;
using testing::HasSubstr;

std::string world_path(const std::string& name) {
  return std::string(CGSR_SOURCE_DIR) + "/config/worlds/" + name + ".toml";
}

Scene read_back(const std::string& obj) {
  Scene scene;
  auto pieces = read_mesh_file(obj, 1.0);
  EXPECT_TRUE(pieces) << pieces.error().message;
  for (FilePiece& piece : *pieces)
    scene.add_static(piece.name, std::move(piece.mesh), scene.add_material(piece.material));
  return scene;
}

// What a map loader gets is the world: as many surfaces and edges, and every pixel as deep.
TEST(MapFileProperty, ReadBackIsTheWorldItself) {
  for (const char* name : {"home", "planar", "occlusion", "spl-field", "corridor", "people"}) {
    const ScratchFolder scratch;
    const auto world = load_world(world_path(name));
    ASSERT_TRUE(world) << world.error().message;
    ASSERT_TRUE(write_map(world->scene, scratch / "map.obj", "a\nb"));
    const Scene map = read_back(scratch / "map.obj");
    const MapCount truth = count_map(world->scene);
    const MapCount read = count_map(map);
    EXPECT_EQ(read.surfaces, truth.surfaces) << name;
    EXPECT_EQ(read.edges, truth.edges) << name;

    Scene still = world->scene;  // what the map holds, and nothing else
    std::erase_if(still.parts, [](const Part& part) { return part.figure >= 0 || !part.in_map; });
    const CameraModel camera = CameraModel().scaled_to(80, 60);
    const Pose X_WC = world->X_WR_start[0] * mount_of(world->scene.robots[0]);
    const auto of_truth = renderer_for(still, camera);
    const auto of_map = renderer_for(map, camera);
    RadianceImage image;
    of_truth->draw(state_at(still, 0.0), X_WC, image);
    of_map->draw(state_at(map, 0.0), X_WC, image);
    int off = 0;
    for (std::size_t i = 0; i < of_truth->geometry().depth_m.size(); ++i) {
      off += std::abs(of_truth->geometry().depth_m[i] - of_map->geometry().depth_m[i]) > 1e-3F ? 1 : 0;
    }
    EXPECT_LE(off, 5) << name;
  }
}

TEST(MapFile, KeepsTheColourAndGlossOfMaterials) {
  const ScratchFolder scratch;
  Scene scene;
  Material varnish;
  varnish.name = "dark oak #2";
  varnish.albedo = from_srgb({0.6, 0.4, 0.2});
  varnish.specular = 0.04F;
  varnish.roughness = 0.4F;
  Material checker;
  checker.name = varnish.name;  // meshes from files may bring the same name twice
  checker.pattern = PatternKind::kChecker;
  checker.albedo = Rgb::Constant(0.2F);
  checker.second_albedo = Rgb::Constant(0.6F);
  scene.add_static("box", make_box({1, 1, 1}), scene.add_material(varnish));
  scene.add_static("floor", make_rectangle(2, 2), scene.add_material(checker));
  ASSERT_TRUE(write_map(scene, scratch / "map.obj", ""));
  const auto pieces = read_mesh_file(scratch / "map.obj", 1.0);
  ASSERT_TRUE(pieces) << pieces.error().message;
  ASSERT_EQ(pieces->size(), 2U);
  const auto& oak = (*pieces)[0].material.specular > 0.0F ? (*pieces)[0].material : (*pieces)[1].material;
  const auto& floor = (*pieces)[0].material.specular > 0.0F ? (*pieces)[1].material : (*pieces)[0].material;
  EXPECT_LT((oak.albedo - varnish.albedo).norm(), 1e-4F);
  EXPECT_NEAR(oak.specular, 0.04F, 1e-4F);
  EXPECT_NEAR(oak.roughness, 0.4F, 1e-4F);
  EXPECT_NEAR(floor.albedo[1], 0.4F, 1e-3F) << "the mean of the pattern";
}

TEST(MapFile, ThatCannotBeWrittenSaysWhy) {
  const auto written = write_map(Scene{}, "/nowhere/map.obj", "");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("/nowhere/map.obj: cannot be written: No such file"));
}

TEST(CameraFile, IsWhatOpenCvReads) {
  const ScratchFolder scratch;
  CameraModel camera;
  camera.fx_px = 600.25;
  app::testing::write_text(scratch / "camera.yaml", "%YAML:1.0\n---\n" + camera_as_yaml(camera, "robot"));
  cv::FileStorage file(scratch / "camera.yaml", cv::FileStorage::READ);
  EXPECT_EQ(static_cast<int>(file["image_width"]), 640);
  EXPECT_EQ(static_cast<std::string>(file["distortion_model"]), "plumb_bob");
  std::vector<double> K;
  std::vector<double> d;
  file["camera_matrix"]["data"] >> K;
  file["distortion_coefficients"]["data"] >> d;
  EXPECT_EQ(K, (std::vector<double>{600.25, 0, 319.5, 0, 579.4, 239.5, 0, 0, 1}));
  EXPECT_EQ(d, (std::vector<double>{camera.k1, camera.k2, camera.p1, camera.p2, camera.k3}));
  EXPECT_EQ(static_cast<int>(file["projection_matrix"]["cols"]), 4);
}

class Calibration : public testing::Test {
 protected:
  Calibration() {
    const int grey = matt(scene_, Rgb::Constant(0.4F));
    scene_.add_static("floor", make_rectangle(8, 6), grey);
    scene_.add_static("table/top", make_box({1, 0.8, 0.04}), grey, pose_at({2, 1, 0.74}));
    scene_.add_static("table/leg", make_box({0.05, 0.05, 0.72}), grey, pose_at({2, 1, 0.36}));
    scene_.add_static("tape", make_rectangle(0.5, 0.05), grey, pose_at({1, 0, 0.0005}));
    RobotBody body;
    body.has_board = true;
    add_robot(scene_, body);
  }
  Scene scene_ = dark_scene();
};

TEST_F(Calibration, WithoutErrorsItIsTheTruth) {
  const CalibratedCopy copy = calibrated_copy(scene_, 0, CalibrationErrors().times(0.0), 5);
  EXPECT_EQ(copy.camera.fx_px, CameraModel().fx_px);
  EXPECT_TRUE(copy.X_RC.isApprox(mount_of(scene_.robots[0]), 1e-12));
  EXPECT_NEAR(copy.board.probes[0].p_RA.z(), 1.0, 1e-12) << "board at 0.90, cone of 0.10";
  EXPECT_EQ(map_as_obj(copy.map, "m", ""), map_as_obj(scene_, "m", ""));
  EXPECT_EQ(materials_as_mtl(copy.map, ""), materials_as_mtl(scene_, ""));
}

TEST_F(Calibration, ASeedIsACopy) {
  const auto text = [&](std::uint32_t seed) {
    const CalibratedCopy copy = calibrated_copy(scene_, 0, {}, seed);
    return camera_as_yaml(copy.camera, "c") + robot_as_toml(copy, {}) + map_as_obj(copy.map, "m", "") +
           materials_as_mtl(copy.map, "");
  };
  EXPECT_EQ(text(3), text(3));
  EXPECT_NE(text(3), text(4));
}

// Over many seeds the errors have the standard deviations that were stated, and no mean.
TEST_F(Calibration, ErrorsAreAsLargeAsStated) {
  const CalibrationErrors stated;
  constexpr int kSeeds = 1500;
  double focal = 0.0;
  double focal_mean = 0.0;
  double centre = 0.0;
  double mount = 0.0;
  double turn = 0.0;
  double apex = 0.0;
  double place = 0.0;
  const Eigen::Vector3d corner = scene_.parts[1].mesh.position_m[0].cast<double>();
  CalibrationErrors only_place = stated.times(0.0);
  only_place.map_place_m = stated.map_place_m;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const CalibratedCopy copy = calibrated_copy(scene_, 0, stated, seed);
    const double f = copy.camera.fx_px / CameraModel().fx_px - 1.0;
    focal += f * f / kSeeds;
    focal_mean += f / kSeeds;
    centre += std::pow(copy.camera.cx_px - CameraModel().cx_px, 2) / kSeeds;
    mount += (copy.X_RC.translation() - mount_of(scene_.robots[0]).translation()).squaredNorm() / 3 / kSeeds;
    const Eigen::AngleAxisd off(copy.X_RC.linear().transpose() * mount_of(scene_.robots[0]).linear());
    turn += off.angle() * off.angle() / 3 / kSeeds;
    apex += std::pow(copy.board.probes[1].p_RA.y() + 0.2, 2) / kSeeds;
    const CalibratedCopy moved = calibrated_copy(scene_, 0, only_place, seed);
    place += (moved.map.parts[1].mesh.position_m[0].cast<double>() - corner).head<2>().squaredNorm() / 2 / kSeeds;
  }
  EXPECT_NEAR(std::sqrt(focal), stated.focal, 0.06 * stated.focal);
  EXPECT_LT(std::abs(focal_mean), 0.1 * stated.focal);
  EXPECT_NEAR(std::sqrt(centre), stated.centre_px, 0.06 * stated.centre_px);
  EXPECT_NEAR(std::sqrt(mount), stated.mount_m, 0.06 * stated.mount_m);
  EXPECT_NEAR(std::sqrt(turn), degrees(stated.mount_deg), 0.06 * degrees(stated.mount_deg));
  EXPECT_NEAR(std::sqrt(apex), stated.probe_m, 0.06 * stated.probe_m);
  EXPECT_NEAR(std::sqrt(place), stated.map_place_m, 0.06 * stated.map_place_m);
}

// However wrong: what is one thing moves as one, tape stays on its floor, and the structure is only stretched.
TEST_F(Calibration, AMisplacedMapIsStillARoom) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const CalibratedCopy copy = calibrated_copy(scene_, 0, CalibrationErrors().times(5.0), seed);
    ASSERT_EQ(copy.map.parts.size(), 4U) << "the robot's own parts are not in the map";
    const auto bounds_of = [&](int part) { return bounds(copy.map.parts[static_cast<std::size_t>(part)].mesh); };
    EXPECT_EQ(bounds_of(0).min().z(), 0.0F);
    EXPECT_GT(bounds_of(3).min().z(), 0.0F) << "tape above the floor";
    EXPECT_NEAR(bounds_of(0).sizes().x(), 8.0F, 8.0F * 0.005F * 6.0F);
    const float gap = bounds_of(1).min().z() - bounds_of(2).max().z();
    EXPECT_NEAR(gap, 0.0F, 1e-3F) << "the top lies on the leg";
    const Eigen::Vector2f between = (bounds_of(1).center() - bounds_of(2).center()).head<2>();
    EXPECT_LT(between.norm(), 2e-3F);
  }
}

// Chapter 4's errors are those that were stated, and no others; whatever lies on something goes with it.
TEST_F(Calibration, RigidPartsMoveByHalfACentimetre) {
  const CalibrationErrors stated = CalibrationErrors::chapter_4();
  constexpr int kSeeds = 800;
  double floor = 0.0;
  double top = 0.0;
  double turn = 0.0;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const CalibratedCopy copy = calibrated_copy(scene_, 0, stated, seed);
    const auto moved = [&](std::size_t part) {
      return (copy.map.parts[part].mesh.position_m[0] - scene_.parts[part].mesh.position_m[0]).cast<double>().eval();
    };
    EXPECT_EQ(moved(0).z(), 0.0) << "the floor is where height begins";
    EXPECT_EQ(moved(3).z(), 0.0) << "tape lies on it";
    EXPECT_LT((moved(1) - moved(2)).norm(), 1e-6) << "leg and top are one thing";
    floor += moved(0).head<2>().squaredNorm() / 2 / kSeeds;
    top += moved(1).head<2>().squaredNorm() / 2 / kSeeds;
    EXPECT_EQ((copy.X_RC.translation() - mount_of(scene_.robots[0]).translation()).norm(), 0.0);
    const Eigen::AngleAxisd off(copy.X_RC.linear().transpose() * mount_of(scene_.robots[0]).linear());
    turn += off.angle() * off.angle() / 3 / kSeeds;
  }
  EXPECT_NEAR(std::sqrt(floor), 0.005, 0.0004);
  EXPECT_NEAR(std::sqrt(top), 0.005, 0.0004);
  EXPECT_NEAR(std::sqrt(turn), degrees(0.3), 0.08 * degrees(0.3));
}

}  // namespace
}  // namespace cgsr::sim
