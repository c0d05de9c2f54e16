#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "hal/sim/scene/portable_math.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

// Whatever the lamp, a matt floor shows I cos / d^2 times albedo / pi, at every pixel.
TEST(PhotometryProperty, MattFloorFollowsCosineOverDistanceSquared) {
  Seeded random(20261121);
  double worst = 0.0;
  for (int trial = 0; trial < 12; ++trial) {
    Scene scene = dark_scene();
    const Rgb albedo(0.8F, 0.5F, 0.2F);
    const Eigen::Vector3d p_WL(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(0.5, 3.0));
    const double lumens = random.uniform(100, 3000);
    scene.add_static("floor", make_rectangle(10, 10), matt(scene, albedo));
    add_lamp(scene, p_WL, lumens, trial % 2 == 0 ? 0.0 : 0.2, Rgb(1.0F, 0.9F, 0.5F));
    const CameraModel camera = plain_camera(32, 24, 20);

    const RadianceImage image = draw(scene, camera, straight_down(0, 0, 2));

    for (int y = 0; y < 24; ++y) {
      for (int x = 0; x < 32; ++x) {
        const Eigen::Vector3d p((x - 15.5) / 20 * 2, -(y - 11.5) / 20 * 2, 0);
        const double d2 = (p_WL - p).squaredNorm();
        const double lux = lumens / (4 * kPi) * p_WL.z() / std::sqrt(d2) / d2;
        const Eigen::Vector3d expected = Eigen::Vector3d(0.8, 0.5 * 0.9, 0.2 * 0.5) * (lux / kPi);
        for (int channel = 0; channel < 3; ++channel) {
          const auto seen = static_cast<double>(image.at(x, y)[channel]);
          ASSERT_NEAR(seen, expected[channel], 0.002 * expected[channel]) << trial << ": " << x << ", " << y;
          worst = std::max(worst, std::abs(seen / expected[channel] - 1.0));
        }
      }
    }
  }
  std::printf("cos / d^2 within %.5f %%\n", 100.0 * worst);
}

TEST(Photometry, TwoLampsAddUpAndAmbientComesOnTop) {
  Scene scene = dark_scene();
  scene.add_static("floor", make_rectangle(10, 10), matt(scene, Rgb::Constant(0.5F)));
  const CameraModel camera = plain_camera(16, 16, 20);
  const Pose X_WC = straight_down(0, 0, 2);
  add_lamp(scene, {1, 0, 2}, 500);
  const RadianceImage first = draw(scene, camera, X_WC);
  scene.lamps.clear();
  add_lamp(scene, {0, -1, 1}, 700, 0.0, Rgb(0.2F, 1.0F, 0.4F));
  const RadianceImage second = draw(scene, camera, X_WC);
  add_lamp(scene, {1, 0, 2}, 500);
  scene.ambient.illuminance_lux = Rgb(10, 20, 30);
  const RadianceImage both = draw(scene, camera, X_WC);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const Rgb expected =
          first.at(x, y) + second.at(x, y) + scene.ambient.illuminance_lux * static_cast<float>(0.5 / kPi);
      ASSERT_LT((both.at(x, y) - expected).cwiseAbs().maxCoeff(), 1e-4F * expected.maxCoeff());
    }
  }
}

TEST(Photometry, BounceIsAmbientLightOfLampsThatAreOn) {
  Scene scene = dark_scene();
  add_lamp(scene, {0, 0, 2}, 1000);
  scene.lamps[0].bounce = 0.01;
  scene.lamps[0].switch_name = "lamp";
  EXPECT_NEAR(state_at(scene, 0.0, {{"lamp", true}}).ambient_lux.x(), 10.0F, 1e-3F);
  EXPECT_EQ(state_at(scene, 0.0, {{"lamp", false}}).ambient_lux.x(), 0.0F);
  EXPECT_EQ(state_at(scene, 0.0).lamps[0].intensity_cd.x(), 0.0F) << "a line that nobody names is off";
}

// Corners get less ambient light than the middle of a floor, and never more than all of it.
TEST(Photometry, CornersAreDarkerUnderAmbientLight) {
  Scene scene = dark_scene();
  const int white = matt(scene, Rgb::Ones());
  scene.add_static("floor", make_rectangle(4, 4), white);
  scene.add_static("wall", make_box({0.1, 4, 2}), white, pose_at({-2.05, 0, 1}));
  scene.ambient.illuminance_lux = Rgb::Constant(100);
  scene.ambient.corner_reach_m = 1.0;
  const RadianceImage image = draw(scene, plain_camera(80, 8, 40), straight_down(0, 0, 2));
  const auto lux = [&](int x) { return image.at(x, 4)[1] * static_cast<float>(kPi); };
  EXPECT_NEAR(lux(60), 100, 1);
  EXPECT_LT(lux(1), 85);
  EXPECT_GT(lux(1), 60);
  for (int x = 0; x < 80; ++x) EXPECT_LE(lux(x), 100.1F);
}

}  // namespace
}  // namespace cgsr::sim
