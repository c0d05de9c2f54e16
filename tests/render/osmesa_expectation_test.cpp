#include "pipeline/render/osmesa_expectation.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/render/depth_raster.h"
#include "pipeline/render/make_expectation.h"
#include "tests/render/box_map.h"
#include "tests/render/shipped_map.h"

namespace cgsr::render {
namespace {

using geometry::Camera;
using geometry::Pose;
using world::Map;

double uniform(std::mt19937& random, double least, double most) {
  return least + (most - least) * random() / 4294967296.0;
}

std::vector<VisiblePiece> of_edge(const std::vector<VisiblePiece>& pieces, std::uint32_t edge) {
  std::vector<VisiblePiece> found;
  std::copy_if(pieces.begin(), pieces.end(), std::back_inserter(found), [&](const auto& p) { return p.edge == edge; });
  return found;
}

double length_px(const std::vector<VisiblePiece>& pieces) {
  double sum = 0.0;
  for (const VisiblePiece& piece : pieces) sum += (piece.p1 - piece.p0).norm();
  return sum;
}

/// Length of what is in both.
double shared_px(const std::vector<VisiblePiece>& first, const std::vector<VisiblePiece>& second) {
  double sum = 0.0;
  for (const VisiblePiece& a : first) {
    for (const VisiblePiece& b : second) {
      const Eigen::Vector2f along = (a.p1 - a.p0).normalized();
      const float end = std::min((a.p1 - a.p0).norm(), along.dot(b.p1 - a.p0));
      sum += std::max(0.0F, end - std::max(0.0F, along.dot(b.p0 - a.p0)));
    }
  }
  return sum;
}

/// A standpoint in the free space of a map, as far as the map's box goes; nothing stands right before the camera.
Pose free_pose(const Map& map, DepthRaster& raster, std::mt19937& random) {
  Eigen::AlignedBox3f box;
  for (const auto& p : map.vertices) box.extend(p);
  const Eigen::Vector3d least = box.min().cast<double>();
  const Eigen::Vector3d most = box.max().cast<double>();
  for (;;) {
    const Eigen::Vector3d p_WC(uniform(random, least.x(), most.x()), uniform(random, least.y(), most.y()),
                               uniform(random, 0.6, 1.5));
    const double heading = uniform(random, -3.14159, 3.14159);
    const Pose X_WC = looking_from(
        p_WC, p_WC + Eigen::Vector3d(std::cos(heading), std::sin(heading), -std::tan(uniform(random, -0.1, 0.5))));
    raster.draw(X_WC, Camera());
    float nearest = 0.0F;
    int drawn = 0;
    for (int y = 0; y < raster.buffer().height(); ++y) {
      for (int x = 0; x < raster.buffer().width(); ++x) {
        nearest = std::max(nearest, raster.buffer().inverse_depth(x, y));
        drawn += raster.buffer().name(x, y) != DepthBuffer::kNothing ? 1 : 0;
      }
    }
    if (drawn > 20000 && nearest < 1.0F / 0.3F) return X_WC;
  }
}

/// Every edge that either sees: both see the same of it, within 3 px at each end of each piece.
void agree_in(const std::string& name, int poses) {
  const Map map = shipped_map(name);
  ASSERT_FALSE(map.edges.empty());
  DepthRaster raster(map, {});
  auto osmesa = OsmesaExpectation::make(map, {});
  ASSERT_TRUE(osmesa) << osmesa.error().message;
  std::mt19937 random(20261122);
  Camera lens;
  lens.k1 = -0.075;
  lens.k2 = 0.045;
  int edges = 0;
  int off = 0;
  double whole_px = 0.0;
  double off_px = 0.0;
  for (int trial = 0; trial < poses; ++trial) {
    const Pose X_WC = free_pose(map, raster, random);
    const Camera camera = trial % 2 == 0 ? Camera() : lens;
    std::vector<VisiblePiece> ours;
    std::vector<VisiblePiece> theirs;
    raster.look(X_WC, camera, ours);
    (*osmesa)->look(X_WC, camera, theirs);
    for (std::uint32_t edge = 0; edge < map.edges.size(); ++edge) {
      const auto a = of_edge(ours, edge);
      const auto b = of_edge(theirs, edge);
      if (a.empty() && b.empty()) continue;
      ++edges;
      const double apart = length_px(a) + length_px(b) - 2.0 * shared_px(a, b);
      const auto ends = 2.0 * static_cast<double>(std::max({a.size(), b.size(), std::size_t{1}}));
      off += apart > 3.0 * ends ? 1 : 0;
      whole_px += length_px(a);
      off_px += apart;
      if (std::getenv("DBG") && apart > 3.0 * ends) {
        printf("%s %d edge %u kind %d: ours %zu %.1f theirs %zu %.1f\n", name.c_str(), trial, edge,
               static_cast<int>(map.edges[edge].kind), a.size(), length_px(a), b.size(), length_px(b));
        for (auto& p : a)
          printf("   o %.3f-%.3f  %.1f %.1f - %.1f %.1f\n", p.from, p.to, p.p0.x(), p.p0.y(), p.p1.x(), p.p1.y());
        for (auto& p : b)
          printf("   t %.3f-%.3f  %.1f %.1f - %.1f %.1f\n", p.from, p.to, p.p0.x(), p.p0.y(), p.p1.x(), p.p1.y());
      }
    }
  }
  EXPECT_GT(edges, 10 * poses);
  EXPECT_LE(off, edges / 100) << "of " << edges;
  std::printf("[ %s: %d of %d edges disagree; %.2f %% of the visible length ]\n", name.c_str(), off, edges,
              100.0 * off_px / whole_px);
}

TEST(OsmesaProperty, HomeIsSeenAsByTheRaster) {
  agree_in("home", 40);
}
TEST(OsmesaProperty, PlanarIsSeenAsByTheRaster) {
  agree_in("planar", 40);
}
TEST(OsmesaProperty, OcclusionIsSeenAsByTheRaster) {
  agree_in("occlusion", 40);
}
TEST(OsmesaProperty, SplFieldIsSeenAsByTheRaster) {
  agree_in("spl-field", 40);
}
TEST(OsmesaProperty, CorridorIsSeenAsByTheRaster) {
  agree_in("corridor", 40);
}
TEST(OsmesaProperty, PeopleIsSeenAsByTheRaster) {
  agree_in("people", 40);
}

TEST(Osmesa, ACubeShowsNineOfItsTwelveEdges) {
  Map map;
  add_box(map, {-0.5F, -0.5F, 0.0F}, {0.5F, 0.5F, 1.0F});
  ExpectationParameters parameters;
  parameters.kind = ExpectationKind::kOsmesa;
  auto expectation = make_expectation(map, parameters);
  ASSERT_TRUE(expectation) << expectation.error().message;
  std::vector<VisiblePiece> pieces;
  (*expectation)->look(looking_from({3.0, 2.0, 2.0}, {0.0, 0.0, 0.5}), Camera(), pieces);
  EXPECT_EQ(pieces.size(), 9U);
  parameters.kind = ExpectationKind::kRaster;
  expectation = make_expectation(map, parameters);
  ASSERT_TRUE(expectation);
  (*expectation)->look(looking_from({3.0, 2.0, 2.0}, {0.0, 0.0, 0.5}), Camera(), pieces);
  EXPECT_EQ(pieces.size(), 9U);
}

TEST(OsmesaFault, AMapOfNothingShowsNothingAndTwoLiveSideBySide) {
  const Map nothing;
  Map one;
  add_rectangle(one, {4.0F, 1.0F, 0.0F}, {0.0F, -2.0F, 0.0F}, {0.0F, 0.0F, 1.0F});
  auto first = OsmesaExpectation::make(nothing, {});
  auto second = OsmesaExpectation::make(one, {});
  ASSERT_TRUE(first && second);
  const Pose X_WC = looking_from({0.0, 0.0, 0.8}, {4.0, 0.0, 0.5});
  std::vector<VisiblePiece> pieces;
  for (int i = 0; i < 3; ++i) {
    (*first)->look(X_WC, Camera(), pieces);
    EXPECT_TRUE(pieces.empty());
    (*second)->look(X_WC, Camera(), pieces);
    EXPECT_EQ(pieces.size(), 4U);
  }
}

}  // namespace
}  // namespace cgsr::render
