#include <cmath>
#include <cstring>
#include <utility>

#include <gtest/gtest.h>

#include "hal/sim/people/person.h"
#include "hal/sim/render/sensor.h"
#include "hal/sim/render/tracer.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

// A room with hard and soft shadows, patterns, gloss, curved and moving parts: everything that could depend on who computes it.
Scene busy_scene() {
  Scene scene = dark_scene();
  Material wood;
  wood.pattern = PatternKind::kWood;
  wood.specular = 0.04F;
  wood.roughness = 0.4F;
  scene.add_static("floor", make_rectangle(6, 6), scene.add_material(wood));
  const int grey = matt(scene, Rgb::Constant(0.4F));
  scene.add_static("box", make_box({0.5, 0.5, 0.5}), grey, pose_at({1.5, 0.3, 0.25}, 0.4));
  scene.add_static("cone", make_cone(0.2, 0.6), grey, pose_at({1.2, -0.6, 0}));
  Figure ball;
  ball.kind = FigureKind::kBall;
  ball.joints[0].drive = JointDrive::kRoll;
  ball.joints[0].amplitude_rad = 5.0;
  ball.path = *Path::make({{{1, -1, 0.2}}, {{2, 1, 0.2}, 1.0}}, 0.0, 2.0, true);
  scene.figures.push_back(ball);
  Part part;
  part.mesh = make_sphere(0.2);
  part.material = matt(scene, Rgb(0.8F, 0.3F, 0.05F));
  part.figure = 0;
  scene.parts.push_back(part);
  add_person(scene, {"somebody", 1, 1.75, {}});
  scene.figures[1].path = Path::standing({2.6, 0.0, 0.0}, 3.0);
  add_lamp(scene, {0.5, 0.5, 2.5}, 900, 0.0, Rgb(1.0F, 0.9F, 0.7F));
  add_lamp(scene, {2.5, -1.5, 2.2}, 600, 0.12);
  scene.ambient.illuminance_lux = Rgb::Constant(20);
  scene.ambient.corner_reach_m = 0.8;
  return scene;
}

struct Take {
  std::vector<float> light;
  std::vector<std::int32_t> parts;
  std::vector<std::uint8_t> bytes;
};

std::vector<Take> shoot(const Scene& scene, int threads, int edge_samples) {
  const CameraModel camera = CameraModel().scaled_to(160, 120);
  const auto renderer = renderer_for(scene, camera, edge_samples, threads);
  const Sensor sensor;
  SensorSettings settings;
  settings.gain = 2.0;
  std::vector<Take> takes;
  for (int i = 0; i < 3; ++i) {
    RadianceImage image;
    renderer->draw(state_at(scene, 0.4 * i), look_at({-0.8, -0.1 * i, 1.2}, {1.5, 0, 0.6}), image);
    Take take{image.rgb, renderer->geometry().part, std::vector<std::uint8_t>(160 * 120 * 2)};
    sensor.measure(image, settings, 9, static_cast<std::uint64_t>(i), {take.bytes.data(), 160, 120, 320},
                   renderer->workers());
    takes.push_back(take);
  }
  return takes;
}

TEST(RenderReplay, SameBytesOnAnyNumberOfThreads) {
  const Scene scene = busy_scene();
  for (const int edge_samples : {1, 4, 16}) {
    const auto one = shoot(scene, 1, edge_samples);
    for (const int threads : {2, 3, 1}) {
      const auto other = shoot(scene, threads, edge_samples);
      for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(std::memcmp(one[i].light.data(), other[i].light.data(), one[i].light.size() * sizeof(float)), 0)
            << threads << " threads, image " << i;
        EXPECT_EQ(one[i].parts, other[i].parts);
        EXPECT_EQ(one[i].bytes, other[i].bytes);
      }
      EXPECT_NE(other[0].bytes, other[1].bytes) << "things move";
    }
  }
}

// Embree's own distances are off by several units in the last place, and by others on each manufacturer's processors.
TEST(TracerReplay, DistancesAreRoundedOnce) {
  Scene scene = dark_scene();
  const Pose X_WF = pose_at({1.7, 0.2, 0.4}, 0.7);
  scene.add_static("wall", make_box({0.01, 4.0, 4.0}), matt(scene, Rgb::Constant(0.4F)), X_WF);
  const auto tracer = Tracer::make(scene);
  ASSERT_TRUE(tracer) << tracer.error().message;
  (*tracer)->update(state_at(scene, 0.0));

  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    alignas(32) int valid[kPacket];
    alignas(32) RTCRayHit8 rays{};
    for (int lane = 0; lane < kPacket; ++lane) {
      valid[lane] = -1;
      rays.ray.dir_x[lane] = 1.0F;
      rays.ray.dir_y[lane] = 0.0017F * static_cast<float>(i - 250);
      rays.ray.dir_z[lane] = 0.09F * static_cast<float>(lane - 3);
      rays.ray.tfar[lane] = 100.0F;
      rays.ray.mask[lane] = kSightRays;
      rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    (*tracer)->nearest(valid, rays, true);
    for (int lane = 0; lane < kPacket; ++lane) {
      const Met met = (*tracer)->met(rays, lane);
      if (met.part < 0) continue;
      const Mesh& mesh = scene.parts[static_cast<std::size_t>(met.part)].mesh;
      const auto& corner = mesh.triangles[met.triangle].corner;
      const auto at = [&](std::size_t k) -> Eigen::Vector3d { return mesh.position_m[corner[k]].cast<double>(); };
      const Eigen::Vector3d n = (at(1) - at(0)).cross(at(2) - at(0));
      const Eigen::Vector3d d(rays.ray.dir_x[lane], rays.ray.dir_y[lane], rays.ray.dir_z[lane]);
      const double exact = n.dot(at(0)) / n.dot(d);
      const float found = rays.ray.tfar[lane];
      const double half_unit = 0.5 * (std::nextafter(found, 100.0F) - found);
      ASSERT_NEAR(found, exact, 1.001 * half_unit) << "ray " << i << ", lane " << lane;
      ++hits;
    }
  }
  EXPECT_GT(hits, 1000);
}

// What was drawn before leaves no trace.
TEST(RenderReplay, AnImageDoesNotDependOnTheOneBefore) {
  const Scene scene = busy_scene();
  const CameraModel camera = CameraModel().scaled_to(80, 60);
  const Pose X_WC = look_at({-0.8, 0, 1.2}, {1.5, 0, 0.6});
  RadianceImage fresh;
  renderer_for(scene, camera, 4)->draw(state_at(scene, 1.0), X_WC, fresh);
  const auto used = renderer_for(scene, camera, 4);
  RadianceImage image;
  used->draw(state_at(scene, 0.0), look_at({0, -2, 1.0}, {1.5, 0, 0.6}), image);
  used->draw(state_at(scene, 1.0), X_WC, image);
  EXPECT_EQ(fresh.rgb, image.rgb);
}

void add_crate(Scene& scene, double size_m, Path path) {
  Figure crate;
  crate.path = std::move(path);
  scene.figures.push_back(crate);
  Part part;
  part.mesh = make_box({size_m, size_m, size_m});
  part.material = matt(scene, Rgb(0.1F, 0.5F, 0.2F));
  part.figure = static_cast<int>(scene.figures.size()) - 1;
  scene.parts.push_back(part);
}

// Somebody who walks through shadows, a ball, a crate behind the camera whose shadow alone is seen, one that comes and goes; far away, where
// pixels are wide, one before a wall, and nothing beside it.
Scene moving_scene() {
  Scene scene = busy_scene();
  scene.ambient.corner_reach_m = 0.0;  // so many new renderers
  scene.figures[1].path = *Path::make({{{2.6, 1.4, 0}}, {{2.0, -1.4, 0}, 0.8}}, 0.0, 2.0, true);
  add_crate(scene, 0.5, *Path::make({{{-1.5, 0.8, 1.5}}, {{-1.5, -0.8, 1.5}, 0.5}}, 0.4, 2.0, true));
  add_crate(scene, 0.4, Path::standing({1.4, 0.5, 0.8}, 3.0));
  scene.figures.back().presence = {{0.0, false, 0}, {0.5, true, 0}, {1.3, false, 0}, {2.2, true, 0}};
  add_crate(scene, 0.8, *Path::make({{{11, -4, 1}}, {{11, 2, 2}, 3.0}}, 0.0, 2.0, true));
  add_lamp(scene, {-2.9, 0.1, 2.3}, 900);
  scene.lamps.back().switch_name = "back";
  scene.add_static("wall", make_box({0.2, 10, 6}), matt(scene, Rgb::Constant(0.6F)), pose_at({12, -4, 2}));
  return scene;
}

// Every byte is what a new renderer draws.
void expect_as_new(Renderer& renderer, const SceneState& state, const Pose& X_WC, int edge_samples) {
  RadianceImage image;
  renderer.draw(state, X_WC, image);
  const auto fresh = renderer_for(renderer.scene(), renderer.camera(), edge_samples);
  RadianceImage expected;
  fresh->draw(state, X_WC, expected);
  EXPECT_EQ(fresh->traced_share(), 1.0);
  EXPECT_EQ(std::memcmp(image.rgb.data(), expected.rgb.data(), expected.rgb.size() * sizeof(float)), 0);
  EXPECT_EQ(renderer.geometry().part, fresh->geometry().part);
  EXPECT_EQ(renderer.geometry().polygon, fresh->geometry().polygon);
  EXPECT_EQ(renderer.geometry().depth_m, fresh->geometry().depth_m);
}

// Tiles are kept from image to image where nothing can have changed.
TEST(RenderReplay, KeptTilesAreWhatANewRendererDraws) {
  const Scene scene = moving_scene();
  for (const auto& [width, edge_samples] : {std::pair(64, 4), std::pair(96, 16)}) {
    const auto renderer = renderer_for(scene, CameraModel().scaled_to(width, width * 3 / 4), edge_samples, 2);
    double traced = 0.0;
    for (int i = 0; i < 36; ++i) {
      SCOPED_TRACE(testing::Message() << width << " pixels, image " << i);
      const SceneState state = state_at(scene, 0.07 * (i - i / 9) + 0.4 * (i / 11), {{"back", i % 16 < 12}});
      expect_as_new(*renderer, state, look_at({-0.8, i / 3 == 8 ? 0.1 : 0.0, 1.2}, {1.5, 0, 0.6}), edge_samples);
      traced += renderer->traced_share() / 36;
      renderer->move_to(state_at(scene, 5.0));  // asked about something else in between
    }
    EXPECT_LT(traced, 0.9);
  }
}

// Crates large and small, near and far, at random; pixels and lamps are wide.
TEST(RenderReplayProperty, KeptTilesAreWhatANewRendererDraws) {
  auto random = Seeded(20261130);
  const auto place = [&] {
    const double x = random.uniform(-2, 12);
    const double y = random.uniform(-3, 3);
    return Eigen::Vector3d(x, y, random.uniform(0.1, 2));
  };
  Scene scene = dark_scene();
  scene.ambient.illuminance_lux = Rgb::Constant(20);
  scene.add_static("floor", make_rectangle(30, 12), matt(scene, Rgb::Constant(0.4F)));
  for (int i = 0; i < 6; ++i) {
    const double size_m = random.uniform(0.1, 0.8);
    scene.add_static("box", make_box({size_m, size_m, 2 * size_m}), matt(scene, Rgb::Constant(0.3F)), pose_at(place()));
  }
  for (int i = 0; i < 6; ++i) add_crate(scene, 0.1 + 0.2 * i, Path::standing(place(), 0.0));
  add_lamp(scene, {2, 1, 2.5}, 900, 0.6);
  add_lamp(scene, {-3, 0, 2.5}, 900);
  for (const int edge_samples : {1, 4, 16}) {
    const auto renderer = renderer_for(scene, plain_camera(72, 50, 50), edge_samples);
    SceneState state = state_at(scene, 0.0);
    const std::vector<LampState> lamps = state.lamps;
    Pose X_WC = look_at({-1, 0, 1.2}, {4, 0, 0.8});
    for (int i = 0; i < 200; ++i) {
      SCOPED_TRACE(testing::Message() << edge_samples << " samples, image " << i);
      const auto figure = static_cast<std::size_t>(random.uniform(0, 6));
      Pose& X_WJ = state.X_WJ[figure][0];
      X_WJ = random.uniform(0, 1) < 0.5 ? pose_at(place(), random.uniform(-3, 3))
                                        : X_WJ * pose_at({0.0, random.uniform(-0.3, 0.3), 0.0}, 0.1);
      if (random.uniform(0, 1) < 0.2) state.presence[figure].present = !state.presence[figure].present;
      if (i % 20 == 19) state.lamps[1].intensity_cd = lamps[1].intensity_cd - state.lamps[1].intensity_cd;
      if (i % 50 == 49) X_WC = look_at({-1, random.uniform(-0.5, 0.5), 1.2}, {4, 0, 0.8});
      expect_as_new(*renderer, state, X_WC, edge_samples);
    }
  }
}

// A pixel's further rays pass the board that all of its tile's first ones end on.
TEST(RenderReplay, WhatOnlyRefinedPixelsSeeIsDrawnAnew) {
  Scene scene = dark_scene();
  scene.ambient.illuminance_lux = Rgb::Constant(100);
  const CameraModel camera = plain_camera(32, 16, 32);  // two tiles
  const double edge_m = 0.3 / 32;                       // left of the middle, as column 15's pixels are
  scene.add_static("board", make_box({0.01, 2, 2}), matt(scene, Rgb::Constant(0.4F)), pose_at({1.005, 1 + edge_m, 0}));
  add_crate(scene, 0.5, *Path::make({{{6, -2, 0}}, {{6, 2, 0}, 1.0}}, 0.0, 2.0, false));
  const auto renderer = renderer_for(scene, camera, 4);
  for (int i = 0; i < 40; ++i) expect_as_new(*renderer, state_at(scene, 0.1 * i), look_at({0, 0, 0}, {1, 0, 0}), 4);
}

// What stands still is traced once; the light of the image may be changed by whoever asked for it.
TEST(RenderReplay, AStillSceneIsTracedOnce) {
  const Scene scene = busy_scene();
  const auto renderer = renderer_for(scene, CameraModel().scaled_to(80, 60), 4);
  const Pose X_WC = look_at({-0.8, 0, 1.2}, {1.5, 0, 0.6});
  RadianceImage first;
  renderer->draw(state_at(scene, 1.0), X_WC, first);
  RadianceImage image = first;
  for (float& value : image.rgb) value *= 0.5F;
  renderer->draw(state_at(scene, 1.0), X_WC, image);
  EXPECT_EQ(renderer->traced_share(), 0.0);
  EXPECT_EQ(image.rgb, first.rgb);
}

TEST(Workers, DoEveryJobOnceHoweverManyThereAre) {
  for (const int threads : {1, 2, 5}) {
    Workers workers(threads);
    for (const int count : {0, 1, 7, 1000}) {
      std::vector<std::atomic<int>> done(static_cast<std::size_t>(count));
      workers.run(count, [&](int job) { ++done[static_cast<std::size_t>(job)]; });
      for (const auto& times : done) ASSERT_EQ(times.load(), 1);
    }
  }
}

}  // namespace
}  // namespace cgsr::sim
