#include <cmath>
#include <cstring>

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
