#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "hal/sim/render/truth_images.h"
#include "hal/sim/scene/portable_math.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector3d;

// Does the segment from p to the lamp pass through the box?
bool box_hides(const Vector3d& middle, const Vector3d& size, const Vector3d& p, const Vector3d& p_WL) {
  double from = 0.0;
  double to = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = p_WL[axis] - p[axis];
    const double low = (middle[axis] - size[axis] / 2 - p[axis]) / d;
    const double high = (middle[axis] + size[axis] / 2 - p[axis]) / d;
    from = std::max(from, std::min(low, high));
    to = std::min(to, std::max(low, high));
  }
  return from < to;
}

// Does the segment from p (on the plane the cone stands on) to the lamp pass through the cone x^2 + y^2 <= (r (1 - z/h))^2, 0 <= z <= h?
bool cone_hides(double r, double h, const Vector3d& p, const Vector3d& p_WL) {
  const Vector3d d = p_WL - p;
  const double k = r / h;
  const auto quadratic = [&](double t) {
    const Vector3d q = p + t * d;
    return q.x() * q.x() + q.y() * q.y() - k * k * (h - q.z()) * (h - q.z());
  };
  const double end = h / d.z();  // above the apex there is nothing
  const double a = d.x() * d.x() + d.y() * d.y() - k * k * d.z() * d.z();
  const double b = 2.0 * (p.x() * d.x() + p.y() * d.y() + k * k * (h - p.z()) * d.z());
  const double lowest = a > 0.0 ? std::clamp(-b / (2.0 * a), 0.0, end) : 0.0;
  return quadratic(0.0) < 0.0 || quadratic(lowest) < 0.0;
}

struct Disagreement {
  int wrong = 0;
  int near_edge = 0;
  int shaded = 0;
};

// Compares the drawn shadow with the analytic one, pixel by pixel; a pixel within half its footprint of the analytic edge may be either.
// The camera looks straight down on the plane z = floor.
Disagreement compare(const RadianceImage& image, const CameraModel& camera, const Pose& X_WC, double floor,
                     const std::function<bool(const Vector3d&)>& hidden,
                     const std::function<bool(const Vector3d&)>& counts) {
  Disagreement result;
  const double height = X_WC.translation().z() - floor;
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const auto on_floor = [&](double u, double v) {
        return Vector3d(X_WC.translation().x() + (u - camera.cx_px) / camera.fx_px * height,
                        X_WC.translation().y() - (v - camera.cy_px) / camera.fy_px * height, floor);
      };
      if (!counts(on_floor(x, y))) continue;
      int votes = 0;
      for (const auto& [du, dv] : {std::pair{-0.5, 0.0}, {0.5, 0.0}, {0.0, -0.5}, {0.0, 0.5}})
        votes += hidden(on_floor(x + du, y + dv)) ? 1 : 0;
      const bool dark = image.at(x, y)[1] <= 0.0F;
      result.shaded += dark ? 1 : 0;
      if (votes != 0 && votes != 4) {
        ++result.near_edge;
      } else if (dark != (votes == 4)) {
        ++result.wrong;
      }
    }
  }
  return result;
}

TEST(ShadowGeometryProperty, OfABoxOnTheFloorIsTheAnalyticOne) {
  Seeded random(31);
  for (int trial = 0; trial < 8; ++trial) {
    Scene scene = dark_scene();
    const int grey = matt(scene, Rgb::Constant(0.5F));
    scene.add_static("floor", make_rectangle(20, 20), grey);
    const Vector3d size(random.uniform(0.2, 0.6), random.uniform(0.2, 0.6), random.uniform(0.2, 0.8));
    const Vector3d middle(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), size.z() / 2);
    scene.add_static("box", make_box(size), grey, pose_at(middle));
    const Vector3d p_WL(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(1.2, 2.75));
    add_lamp(scene, p_WL, 800);
    const CameraModel camera = plain_camera(160, 120, 100);
    const Pose X_WC = straight_down(0.3, -0.2, 3.0);

    const RadianceImage image = draw(scene, camera, X_WC);

    const auto result = compare(
        image, camera, X_WC, 0.0, [&](const Vector3d& p) { return box_hides(middle, size, p, p_WL); },
        [&](const Vector3d& p) {  // the floor that the box does not cover from above, by a pixel
          const Vector3d c = X_WC.translation();
          return !box_hides(middle, size + Vector3d::Constant(0.08), p + Vector3d(0, 0, 1e-6), c);
        });
    EXPECT_EQ(result.wrong, 0) << trial;
    EXPECT_GT(result.shaded, 50) << trial;
    EXPECT_GT(result.near_edge, 20) << trial;
  }
}

TEST(ShadowGeometryProperty, OfAProbeOnItsBoardIsTheAnalyticOne) {
  Seeded random(32);
  for (int trial = 0; trial < 8; ++trial) {
    Scene scene = dark_scene();
    const int white = matt(scene, Rgb::Constant(0.8F));
    scene.add_static("board", make_box({0.74, 0.34, 0.008}), white, pose_at({0, 0, -0.004}));
    scene.add_static("cone", make_cone(0.02, 0.10), white);
    const double angle = degrees(random.uniform(20, 60));
    const double around = random.uniform(0, 6.28);
    const Vector3d p_WL(1.85 * std::tan(angle) * std::cos(around), 1.85 * std::tan(angle) * std::sin(around), 1.85);
    add_lamp(scene, p_WL, 800);
    const CameraModel camera = plain_camera(200, 160, 580);
    const Pose X_WC = straight_down(0.0, 0.0, 0.45);

    const RadianceImage image = draw(scene, camera, X_WC);

    const auto result = compare(
        image, camera, X_WC, 0.0, [&](const Vector3d& p) { return cone_hides(0.02, 0.10, p, p_WL); },
        [&](const Vector3d& p) {
          const bool on_board = std::abs(p.x()) < 0.369 && std::abs(p.y()) < 0.169;
          return on_board && p.norm() > 0.0285;  // what the cone covers, seen from above
        });
    EXPECT_EQ(result.wrong, 0) << trial;
    EXPECT_GT(result.shaded, 50) << trial;
  }
}

// The share of a disc of radius 1 that lies right of x.
double disc_right_of(double x) {
  const double c = std::clamp(x, -1.0, 1.0);
  return (std::acos(c) - c * std::sqrt(1.0 - c * c)) / kPi;
}

// Below a straight edge, a ball-shaped lamp's shadow fades as a disc behind an edge does, and as wide as geometry says.
TEST(ShadowGeometry, PenumbraIsAsWideAsTheLamp) {
  Scene scene = dark_scene();
  const int grey = matt(scene, Rgb::Constant(0.5F));
  scene.add_static("floor", make_rectangle(20, 20), grey);
  constexpr double kEdgeHeight = 1.0;
  constexpr double kLampHeight = 2.5;
  constexpr double kRadius = 0.15;
  scene.add_static("blade", make_box({2.0, 6.0, 0.001}), grey, pose_at({-1.0, 0, kEdgeHeight}));  // hides x < 0
  add_lamp(scene, {0, 0, kLampHeight}, 800, kRadius);
  const CameraModel camera = plain_camera(400, 100, 1000);
  const Pose X_WC = straight_down(0.0, 0.0, 0.9);  // below the blade
  const RadianceImage lit_by_all = draw(scene, camera, X_WC);

  double worst = 0.0;
  double left = 0.0;   // where a tenth of the lamp is seen
  double right = 0.0;  // where nine tenths are
  double before = 0.0;
  for (int x = 0; x < camera.width_px; ++x) {
    const double p_x = (x - camera.cx_px) / 1000 * 0.9;
    double share = 0.0;  // the mean over the column: every pixel has its own samples
    for (int y = 0; y < camera.height_px; ++y) {
      const double p_y = -(y - camera.cy_px) / 1000 * 0.9;
      const double d2 = p_x * p_x + p_y * p_y + kLampHeight * kLampHeight;
      const double free = 0.5 / kPi * 800 / (4 * kPi) * kLampHeight / std::sqrt(d2) / d2;
      share += lit_by_all.at(x, y)[1] / free / camera.height_px;
    }
    const double edge_at_lamp =
        p_x - p_x * kLampHeight / kEdgeHeight;  // the blade's edge, projected from the floor point to the lamp's height
    const double expected = disc_right_of(edge_at_lamp / kRadius);
    worst = std::max(worst, std::abs(share - expected));
    if (before < 0.1 && share >= 0.1) left = p_x;
    if (before < 0.9 && share >= 0.9) right = p_x;
    before = share;
  }
  EXPECT_LT(worst, 0.04);
  // 80 % of a disc lie within 0.687 of its radius on either side of the middle.
  const double expected_width = 2 * 0.687 * kRadius * kEdgeHeight / (kLampHeight - kEdgeHeight);
  EXPECT_NEAR(right - left, expected_width, 0.03 * expected_width);
}

TEST(ShadowGeometry, ABallIsRoundToItsOwnTerminator) {
  Scene scene = dark_scene();
  scene.add_static("ball", make_sphere(0.1), matt(scene, Rgb::Constant(0.5F)));
  const Vector3d p_WL(1.2, 0.5, 1.0);
  add_lamp(scene, p_WL, 800);
  const CameraModel camera = plain_camera(120, 120, 280);
  const RadianceImage image = draw(scene, camera, straight_down(0, 0, 0.6));
  int compared = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 120; ++x) {
      const Vector3d d = Vector3d((x - 59.5) / 280, -(y - 59.5) / 280, -1).normalized();
      const Vector3d o(0, 0, 0.6);
      const double b = o.dot(d);
      const double root = b * b - 0.36 + 0.01;
      if (root <= 1e-4) continue;  // beside the ball, or grazing
      const Vector3d p = o + (-b - std::sqrt(root)) * d;
      const Vector3d to_lamp = p_WL - p;
      const double cosine = std::max(0.0, p.normalized().dot(to_lamp.normalized()));
      const double expected = 0.5 / kPi * 800 / (4 * kPi) * cosine / to_lamp.squaredNorm();
      ASSERT_NEAR(image.at(x, y)[1], expected, 0.05) << x << ", " << y;  // of about 5
      ++compared;
    }
  }
  EXPECT_GT(compared, 4000);
}

}  // namespace
}  // namespace cgsr::sim
