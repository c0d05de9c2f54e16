#include "pipeline/world/index.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/support/allocation_guard.h"
#include "tests/world/small_maps.h"

namespace cgsr::world {
namespace {

class Dice {
 public:
  explicit Dice(std::uint32_t seed) : random_(seed) {}
  double unit() { return static_cast<double>(random_()) / 4294967296.0; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  Eigen::Vector3d point(double reach) {
    return {between(-reach, reach), between(-reach, reach), between(-reach, reach)};
  }

 private:
  std::mt19937 random_;
};

Map boxes(int count, double reach, std::uint32_t seed) {
  Dice dice(seed);
  Maker maker;
  maker.material("plain", 0.5F);
  maker.level(-20, -20, 20, 20, -1);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f low = dice.point(reach).cast<float>();
    const Eigen::Vector3f size(static_cast<float>(dice.between(0.1, 1.0)), static_cast<float>(dice.between(0.1, 1.0)),
                               static_cast<float>(dice.between(0.1, 1.0)));
    maker.box(low, low + size);
  }
  return maker.map();
}

geometry::Pose pose(Dice& dice, double reach) {
  geometry::Pose X = geometry::Pose::Identity();
  X.translation() = dice.point(reach);
  X.linear() = Eigen::Quaterniond(dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1), dice.between(0.01, 1))
                   .normalized()
                   .toRotationMatrix();
  return X;
}

geometry::Camera bent_camera() {
  geometry::Camera camera;
  camera.k1 = -0.1;
  camera.k2 = 0.05;
  return camera;
}

// Who says yes to a pixel sees what lies there: a point of an edge whose pixel is in the image is in a cell.
TEST(IndexProperty, NothingThatIsSeenIsLeftOut) {
  const Map map = boxes(300, 6.0, 1);
  const Index index(map);
  EXPECT_TRUE(std::is_sorted(index.edge_order().begin(), index.edge_order().end())) << "load_map() puts them in order";
  Dice dice(2);
  std::vector<Cell> cells;
  cells.reserve(10'000);
  for (int trial = 0; trial < 200; ++trial) {
    const geometry::Pose X_WC = pose(dice, 8.0);
    const geometry::Camera camera = trial % 2 == 0 ? geometry::Camera() : bent_camera();
    const Frustum frustum(X_WC, camera, 0.1, 15.0);
    ASSERT_TRUE(index.edges_in(frustum, cells));
    std::vector<std::uint8_t> in(map.edges.size(), 0);
    for (const Cell& cell : cells) {
      for (std::uint32_t i = cell.first; i < cell.end; ++i) {
        const std::uint32_t edge = index.edge_order()[i];
        EXPECT_EQ(in[edge], 0) << "no edge comes twice";
        in[edge] = 1;
        for (const double s : {0.0, 1.0}) {
          const Eigen::Vector3d p = (1.0 - s) * map.vertices[map.edges[edge].vertices[0]].cast<double>() +
                                    s * map.vertices[map.edges[edge].vertices[1]].cast<double>();
          const Eigen::Vector3d p_C = X_WC.inverse() * p;
          EXPECT_GE(std::max(0.0, p_C.z()), static_cast<double>(cell.nearest_m) - 1e-3);
          if (!cell.inside) continue;
          const auto planes = (frustum.normals * p.cast<float>() - frustum.offsets).eval();
          EXPECT_GE(planes.minCoeff(), -1e-3F);
        }
      }
    }
    for (std::uint32_t e = 0; e < map.edges.size(); ++e) {
      if (in[e] != 0) continue;
      for (double s = 0.05; s < 1.0; s += 0.1) {
        const Eigen::Vector3d p = (1.0 - s) * map.vertices[map.edges[e].vertices[0]].cast<double>() +
                                  s * map.vertices[map.edges[e].vertices[1]].cast<double>();
        const Eigen::Vector3d p_C = X_WC.inverse() * p;
        if (p_C.z() < 0.1 || p_C.z() > 15.0) continue;
        // Far outside of a lens' reach its polynomial folds back: only what is near the axis can be in the image.
        if (p_C.head<2>().norm() > 1.2 * p_C.z()) continue;
        const auto pixel = camera.pixel_of(p_C);
        EXPECT_FALSE(pixel && pixel->x() > -0.4 && pixel->y() > -0.4 && pixel->x() < 639.4 && pixel->y() < 479.4)
            << "edge " << e;
      }
    }
  }
}

TEST(Index, CellsThatDoNotFitAreSaidToBeMissing) {
  const Map map = boxes(300, 6.0, 1);
  const Index index(map);
  Dice dice(4);
  const Frustum frustum(pose(dice, 1.0), geometry::Camera(), 0.1, 15.0);
  std::vector<Cell> cells;
  cells.reserve(2);
  EXPECT_FALSE(index.triangles_in(frustum, cells));
  EXPECT_EQ(cells.size(), 2U);
}

// The straightforward answer: every triangle, by its plane and its three sides.
std::optional<double> by_hand(const Map& map, const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                              double reach) {
  std::optional<double> nearest;
  for (const Triangle& t : map.triangles) {
    const Eigen::Vector3d a = map.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = map.vertices[t[1]].cast<double>();
    const Eigen::Vector3d c = map.vertices[t[2]].cast<double>();
    const Eigen::Vector3d n = (b - a).cross(c - a);
    const double along = n.dot(a - from) / n.dot(direction);
    if (!(along >= 0.0) || along > reach) continue;
    const Eigen::Vector3d p = from + along * direction;
    const bool inside =
        n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 && n.dot((a - c).cross(p - c)) >= 0;
    if (inside && (!nearest || along < *nearest)) nearest = along;
  }
  return nearest;
}

TEST(IndexProperty, RaysEndWhereTheStraightforwardAnswerSays) {
  const Map map = boxes(120, 5.0, 7);
  const Index index(map);
  Dice dice(8);
  int hits = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Eigen::Vector3d from = dice.point(6.0);
    Eigen::Vector3d direction = dice.point(1.0).normalized();
    if (trial % 3 == 0) direction = Eigen::Vector3d::Unit(trial % 9 / 3);
    const auto truth = by_hand(map, from, direction, 10.0);
    const auto hit = index.first_hit(from.cast<float>(), direction.cast<float>(), 10.0F);
    ASSERT_EQ(hit.has_value(), truth.has_value()) << trial;
    EXPECT_NEAR(index.free_distance(from.cast<float>(), direction.cast<float>(), 10.0F), truth.value_or(10.0), 1e-4);
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->distance_m, *truth, 1e-4);
    EXPECT_EQ(index.surface_of_triangle()[hit->triangle], hit->surface);
  }
  EXPECT_GT(hits, 500);
}

TEST(Index, APixelShowsTheSurfaceThatItsRayMeets) {
  Maker maker;
  maker.material("wall", 0.5F);
  maker.material("board", 0.5F);
  maker.face({{3, -9, -9}, {3, -9, 9}, {3, 9, 9}, {3, 9, -9}}, 0);
  maker.face({{2, -0.2F, -0.2F}, {2, -0.2F, 0.2F}, {2, 0.2F, 0.2F}, {2, 0.2F, -0.2F}}, 1);
  const Map map = maker.map();
  const Index index(map);
  geometry::Pose X_WC = geometry::Pose::Identity();  // looks along x, its right is -y
  X_WC.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const geometry::Camera camera;
  const auto middle = index.at_pixel(X_WC, camera, {camera.cx_px, camera.cy_px});
  ASSERT_TRUE(middle);
  EXPECT_EQ(material_of(map, middle->surface), "board");
  EXPECT_NEAR(middle->distance_m, 2.0F, 1e-5F);
  const auto right = index.at_pixel(X_WC, camera, {camera.cx_px + 0.11 * camera.fx_px, camera.cy_px});
  ASSERT_TRUE(right);
  EXPECT_EQ(material_of(map, right->surface), "wall");
  const std::vector<std::uint32_t> skip = {middle->surface};
  EXPECT_NEAR(index.first_hit({0, 0, 0}, {1, 0, 0}, 9.0F, skip)->distance_m, 3.0F, 1e-5F);
  EXPECT_FALSE(index.first_hit({0, 0, 0}, {1, 0, 0}, 1.9F));
  EXPECT_FALSE(index.first_hit({0, 0, 0}, {-1, 0, 0}, 100.0F));
}

TEST(Index, AnEmptyMapAnswersWithNothing) {
  const Map map;
  const Index index(map);
  std::vector<Cell> cells(3);
  EXPECT_TRUE(index.edges_in(Frustum(geometry::Pose::Identity(), geometry::Camera(), 0.1, 10.0), cells));
  EXPECT_TRUE(cells.empty());
  EXPECT_FALSE(index.first_hit({0, 0, 0}, {1, 0, 0}, 1.0F));
}

TEST(IndexAlloc, QueriesTakeNothing) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "SKIPPED: a sanitizer has its own malloc";
  const Map map = boxes(300, 6.0, 1);
  const Index index(map);
  Dice dice(4);
  const geometry::Pose X_WC = pose(dice, 1.0);
  std::vector<Cell> cells;
  cells.reserve(10'000);
  const test::AllocationGuard guard;
  index.edges_in(Frustum(X_WC, bent_camera(), 0.1, 15.0), cells);
  index.triangles_in(Frustum(X_WC, bent_camera(), 0.1, 15.0), cells);
  static_cast<void>(index.at_pixel(X_WC, bent_camera(), {100, 100}));
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::world
