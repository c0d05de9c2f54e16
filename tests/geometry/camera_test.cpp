#include "pipeline/geometry/camera.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace cgsr::geometry {
namespace {

Camera webcam() {
  Camera camera;
  camera.k1 = -0.075;
  camera.k2 = 0.045;
  camera.p1 = 0.0006;
  camera.p2 = -0.0004;
  camera.k3 = 0.002;
  return camera;
}

TEST(CameraGolden, ProjectsAsOpenCvDoes) {
  // cv::projectPoints with the same numbers.
  const auto pixel = webcam().pixel_of({0.4, -0.3, 1.0});
  ASSERT_TRUE(pixel.has_value());
  const double r2 = 0.25;
  const double radial = 1.0 - 0.075 * r2 + 0.045 * r2 * r2 + 0.002 * r2 * r2 * r2;
  EXPECT_NEAR(pixel->x(), 601.8 * (0.4 * radial + 2 * 0.0006 * 0.4 * -0.3 - 0.0004 * (r2 + 2 * 0.16)) + 319.5, 1e-9);
  EXPECT_NEAR(pixel->y(), 579.4 * (-0.3 * radial + 0.0006 * (r2 + 2 * 0.09) + 2 * -0.0004 * 0.4 * -0.3) + 239.5, 1e-9);
}

TEST(CameraProperty, UndoesItsOwnLens) {
  std::mt19937 random(7);
  const Camera camera = webcam();
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d ideal(static_cast<double>(random()) / 4294967296.0 * 1.2 - 0.6,
                                static_cast<double>(random()) / 4294967296.0 - 0.5);
    const auto pixel = camera.pixel_of({2.0 * ideal.x(), 2.0 * ideal.y(), 2.0});
    ASSERT_TRUE(pixel.has_value());
    EXPECT_LT((camera.ideal_of(*pixel) - ideal).norm(), 1e-9);
  }
}

TEST(Camera, SeesNothingBehindIt) {
  EXPECT_FALSE(Camera{}.pixel_of({0.0, 0.0, -1.0}).has_value());
  EXPECT_FALSE(Camera{}.pixel_of({0.0, 0.0, 0.0}).has_value());
  EXPECT_FALSE(Camera{}.pixel_of({0.0, 0.0, std::nan("")}).has_value());
}

TEST(Camera, HalfSizeSeesTheSame) {
  const Camera half = webcam().scaled_to(320, 240);
  const auto whole_pixel = webcam().pixel_of({0.1, 0.2, 1.0});
  const auto half_pixel = half.pixel_of({0.1, 0.2, 1.0});
  ASSERT_TRUE(whole_pixel && half_pixel);
  EXPECT_NEAR(half_pixel->x(), (whole_pixel->x() + 0.5) / 2 - 0.5, 1e-9);
  EXPECT_NEAR(half_pixel->y(), (whole_pixel->y() + 0.5) / 2 - 0.5, 1e-9);
}

}  // namespace
}  // namespace cgsr::geometry
