#include "pipeline/geometry/camera.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

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

double between(double low, double high, std::mt19937& random) {
  return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

TEST(CameraProperty, ProjectsAsOpenCvDoes) {
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    Camera camera = webcam();
    camera.fx_px = between(300, 900, random);
    camera.fy_px = between(300, 900, random);
    camera.k1 = between(-0.1, 0.1, random);
    camera.p1 = between(-0.002, 0.002, random);
    camera.p2 = between(-0.002, 0.002, random);
    const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
    const cv::Vec<double, 5> lens(camera.k1, camera.k2, camera.p1, camera.p2, camera.k3);
    const double depth_m = between(0.3, 9.0, random);
    const Eigen::Vector3d p(depth_m * between(-0.5, 0.5, random), depth_m * between(-0.4, 0.4, random), depth_m);

    std::vector<cv::Point2d> theirs;
    cv::projectPoints(std::vector<cv::Point3d>{{p.x(), p.y(), p.z()}}, cv::Vec3d(), cv::Vec3d(), K, lens, theirs);
    const auto ours = camera.pixel_of(p);

    ASSERT_TRUE(ours.has_value());
    EXPECT_NEAR(ours->x(), theirs[0].x, 1e-9);
    EXPECT_NEAR(ours->y(), theirs[0].y, 1e-9);
  }
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
