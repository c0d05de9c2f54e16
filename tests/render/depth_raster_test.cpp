#include "pipeline/render/depth_raster.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/render/box_map.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::render {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using geometry::Camera;
using geometry::Pose;
using world::Map;

std::vector<VisiblePiece> seen(const Map& map, const Pose& X_WC, const Camera& camera = {}) {
  DepthRaster raster(map, {});
  std::vector<VisiblePiece> pieces;
  raster.look(X_WC, camera, pieces);
  return pieces;
}

double uniform(std::mt19937& random, double least, double most) {
  return least + (most - least) * random() / 4294967296.0;
}

/// Whether a point is hidden by a triangle of the map, exactly; triangles within `slack_m` of the point do not count.
bool hidden(const Map& map, const Vector3d& p_WC, const Vector3d& p, double slack_m) {
  const Vector3d ray = p - p_WC;
  for (const world::Triangle& t : map.triangles) {
    const Vector3d a = map.vertices[t[0]].cast<double>();
    const Vector3d e1 = map.vertices[t[1]].cast<double>() - a;
    const Vector3d e2 = map.vertices[t[2]].cast<double>() - a;
    const Vector3d h = ray.cross(e2);
    const double det = e1.dot(h);
    if (std::abs(det) < 1e-12) continue;
    const Vector3d s = p_WC - a;
    const double u = s.dot(h) / det;
    const Vector3d q = s.cross(e1);
    const double v = ray.dot(q) / det;
    const double at = e2.dot(q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && at > 0.0 && (1.0 - at) * ray.norm() > slack_m) return true;
  }
  return false;
}

/// Length in the image of what can be seen of a line from a to b, by dense samples.
double exact_length_px(const Map& map, const Pose& X_WC, const Camera& camera, const Vector3d& a, const Vector3d& b) {
  const int steps = std::clamp(static_cast<int>((b - a).norm() * 400.0), 200, 3000);
  const Pose X_CW = X_WC.inverse();
  double length_px = 0.0;
  bool was = false;
  Eigen::Vector2d before = Eigen::Vector2d::Zero();
  for (int i = 0; i <= steps; ++i) {
    const Vector3d p = a + (b - a) * (i / static_cast<double>(steps));
    const Eigen::Vector2d pixel = camera.pixel_of(X_CW * p).value_or(Eigen::Vector2d(-10.0, -10.0));
    const bool is = pixel.x() >= -0.5 && pixel.x() <= camera.width_px - 0.5 && pixel.y() >= -0.5 &&
                    pixel.y() <= camera.height_px - 0.5 && !hidden(map, X_WC.translation(), p, 0.003);
    if (is && was) length_px += (pixel - before).norm();
    was = is;
    before = pixel;
  }
  return length_px;
}

TEST(DepthRaster, ACubeShowsNineOfItsTwelveEdges) {
  Map map;
  add_box(map, {-0.5F, -0.5F, 0.0F}, {0.5F, 0.5F, 1.0F});
  const auto pieces = seen(map, looking_from({3.0, 2.0, 2.0}, {0.0, 0.0, 0.5}));
  ASSERT_EQ(pieces.size(), 9U);
  for (const VisiblePiece& piece : pieces) {
    EXPECT_EQ(piece.from, 0.0F);
    EXPECT_EQ(piece.to, 1.0F);
    const auto& edge = map.edges[piece.edge];
    for (const std::uint32_t v : edge.vertices) {
      EXPECT_FALSE(map.vertices[v].isApprox(Vector3f(-0.5F, -0.5F, 0.0F))) << "the corner at the back";
    }
  }
}

TEST(DepthRaster, AFaceThatIsSeenFromItsFrontAloneHidesNothingFromBehind) {
  Map map;
  add_box(map, {-0.5F, -0.5F, 0.0F}, {0.5F, 0.5F, 1.0F});
  turn_inside_out(map);
  const auto pieces = seen(map, looking_from({3.0, 2.0, 2.0}, {0.0, 0.0, 0.5}));
  ASSERT_EQ(pieces.size(), 9U);
  for (const VisiblePiece& piece : pieces) {
    EXPECT_EQ(piece.from, 0.0F);
    EXPECT_EQ(piece.to, 1.0F);
    for (const std::uint32_t v : map.edges[piece.edge].vertices)
      EXPECT_FALSE(map.vertices[v].isApprox(Vector3f(0.5F, 0.5F, 1.0F))) << "the corner in front";
  }
}

TEST(DepthRaster, SaysWhereTheMapIs) {
  Map map;
  add_box(map, {-0.5F, -0.5F, 0.0F}, {0.5F, 0.5F, 1.0F});
  const Camera camera;
  const Pose X_WC = looking_from({3.0, 2.0, 2.0}, {0.0, 0.0, 0.5});
  DepthRaster raster(map, {});
  std::vector<VisiblePiece> pieces;
  raster.look(X_WC, camera, pieces);
  const auto covered = [&](const Vector3d& p_W) {
    const auto at = camera.without_distortion().pixel_of(X_WC.inverse() * p_W);
    return at && raster.covers(at->cast<float>());
  };
  EXPECT_TRUE(covered({0.0, 0.0, 0.98}));
  EXPECT_TRUE(covered({0.49, 0.0, 0.5}));
  EXPECT_FALSE(covered({0.0, 0.0, 1.4}));
  EXPECT_FALSE(covered({0.0, 0.9, 0.0}));
}

TEST(DepthRaster, PiecesEndWhereSomethingStandsBefore) {
  Map map;
  add_rectangle(map, {4.0F, 2.0F, 1.0F}, {0.0F, -4.0F, 0.0F},
                {0.0F, 0.0F, 1.0F});  // edge 0: along z = 1, y from 2 to -2
  add_rectangle(map, {2.0F, 0.25F, 0.0F}, {0.0F, -0.5F, 0.0F}, {0.0F, 0.0F, 1.5F});
  const auto pieces = seen(map, looking_from({0.0, 0.0, 1.0}, {4.0, 0.0, 1.0}));
  std::vector<VisiblePiece> of_edge;
  std::copy_if(pieces.begin(), pieces.end(), std::back_inserter(of_edge), [](const auto& p) { return p.edge == 0; });
  ASSERT_EQ(of_edge.size(), 2U);
  EXPECT_NEAR(of_edge[0].from, 0.0, 1e-3);
  EXPECT_NEAR(of_edge[0].to, 0.375, 0.003) << "y = 0.5, half of the post's width seen from the camera on the wall";
  EXPECT_NEAR(of_edge[1].from, 0.625, 0.003);
  EXPECT_NEAR(of_edge[1].to, 1.0, 1e-3);
  const Camera camera;
  EXPECT_NEAR(of_edge[0].p1.x(), camera.cx_px - camera.fx_px * 0.5 / 4.0, 1.0);
  EXPECT_NEAR(of_edge[0].p1.y(), camera.cy_px, 0.01);
}

// A skirting that runs past the camera: its front is cut by the near plane, and its far upper edge lies less than a cell above that.
TEST(DepthRaster, WhatIsCutByTheNearPlaneHidesOnlyWhatItCovers) {
  Map map;
  add_box(map, {-8.0F, 3.40F, 0.0F}, {8.0F, 3.42F, 0.09F});
  add_rectangle(map, {-8.0F, 3.42F, 0.0F}, {16.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 2.5F});
  const auto pieces = seen(map, looking_from({0.0, 0.0, 0.84}, {5.0, 3.4, 0.09}));
  float visible_px = 0.0F;
  for (const VisiblePiece& piece : pieces) {
    const auto& ends = map.edges[piece.edge].vertices;
    const auto is_it = [&](std::uint32_t v) { return map.vertices[v].y() == 3.42F && map.vertices[v].z() == 0.09F; };
    if (is_it(ends[0]) && is_it(ends[1])) visible_px += (piece.p1 - piece.p0).norm();
  }
  EXPECT_GT(visible_px, 300.0F);
}

TEST(DepthRaster, TapeAHairAboveTheFloorIsSeenAndBelowItIsNot) {
  for (const float height : {0.0F, 0.0005F, -0.05F}) {
    Map map;
    add_rectangle(map, {-1.0F, -5.0F, 0.0F}, {12.0F, 0.0F, 0.0F}, {0.0F, 10.0F, 0.0F});
    add_rectangle(map, {3.0F, -0.5F, height}, {0.05F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F});
    const auto pieces = seen(map, looking_from({0.0, 0.0, 1.2}, {4.0, 0.0, 0.0}));
    const auto of_tape = std::count_if(pieces.begin(), pieces.end(),
                                       [](const auto& p) { return p.edge >= 4 && p.from == 0.0F && p.to == 1.0F; });
    EXPECT_EQ(of_tape, height < 0.0F ? 0 : 4) << height;
  }
}

TEST(DepthRaster, AnEdgeALittleBehindASilhouetteIsHidden) {
  const Camera camera;
  for (const double behind_px : {1.2, 2.0, -1.2, -2.0}) {
    Map map;
    add_box(map, {2.0F, -1.0F, 0.0F}, {2.5F, 1.0F, 1.0F});  // its upper front edge is at z = 1
    // Seen from z = 1.2 that silhouette lies 0.2 fy / 2.5 below the horizon (the upper back edge); the far rectangle's border is put beside it.
    const double below_px = camera.fy_px * 0.2 / 2.5 + behind_px;
    const auto z = static_cast<float>(1.2 - below_px * 6.0 / camera.fy_px);
    add_rectangle(map, {6.0F, 1.0F, z}, {0.0F, -2.0F, 0.0F}, {0.0F, 0.0F, 3.0F});
    const auto pieces = seen(map, looking_from({0.0, 0.0, 1.2}, {5.0, 0.0, 1.2}));
    const auto found = std::count_if(pieces.begin(), pieces.end(), [](const auto& p) { return p.edge == 12; });
    EXPECT_EQ(found, behind_px > 0 ? 0 : 1) << behind_px;
  }
}

TEST(DepthRaster, WhatPassesBehindTheCameraIsCutAtTheNearPlaneAndAtTheBorders) {
  Map map;
  add_rectangle(map, {-5.0F, -0.4F, 0.0F}, {10.0F, 0.0F, 0.0F}, {0.0F, 0.8F, 0.0F});
  const Camera camera;
  const auto pieces = seen(map, looking_from({0.0, 0.0, 1.0}, {4.0, 0.0, 0.9}), camera);
  ASSERT_GE(pieces.size(), 2U);
  for (const VisiblePiece& piece : pieces) {
    for (const Eigen::Vector2f& p : {piece.p0, piece.p1}) {
      EXPECT_GE(p.x(), -0.51F);
      EXPECT_LE(p.x(), 639.51F);
      EXPECT_GE(p.y(), -0.51F);
      EXPECT_LE(p.y(), 479.51F);
    }
  }
}

// Ends of pieces and their places on the edge belong together, whatever was cut.
TEST(DepthRasterProperty, PixelsAreThoseOfThePlacesOnTheEdge) {
  std::mt19937 random(7);
  Camera lens;
  lens.k1 = -0.075;
  lens.k2 = 0.045;
  for (int trial = 0; trial < 40; ++trial) {
    Map map;
    for (int i = 0; i < 12; ++i) {
      const Vector3f a(static_cast<float>(uniform(random, -4, 4)), static_cast<float>(uniform(random, -4, 4)), 0.0F);
      add_box(map, a,
              a + Vector3f(static_cast<float>(uniform(random, 0.1, 1.5)), 0.4F,
                           static_cast<float>(uniform(random, 0.1, 2))));
    }
    const Pose X_WC = looking_from({uniform(random, -1, 1), uniform(random, -1, 1), 2.3},
                                   {uniform(random, 2, 4), uniform(random, -4, 4), 0.5});
    for (const Camera& camera : {Camera(), lens, Camera().scaled_to(320, 240)}) {
      for (const VisiblePiece& piece : seen(map, X_WC, camera)) {
        const auto& edge = map.edges[piece.edge];
        const Vector3d a = map.vertices[edge.vertices[0]].cast<double>();
        const Vector3d b = map.vertices[edge.vertices[1]].cast<double>();
        for (const auto& [t, pixel] : {std::pair(piece.from, piece.p0), std::pair(piece.to, piece.p1)}) {
          const Vector3d p_C = X_WC.inverse() * (a + static_cast<double>(t) * (b - a));
          const auto expected = camera.without_distortion().pixel_of(p_C);
          ASSERT_TRUE(expected);
          EXPECT_LT((*expected - pixel.cast<double>()).norm(), 0.05);
        }
      }
    }
  }
}

// Against the definition: an edge's point is visible when no triangle lies between.
TEST(DepthRasterProperty, EndsOfPiecesAreThoseOfExactVisibility) {
  std::mt19937 random(11);
  const Camera camera;
  int ends = 0;
  int far_off = 0;
  int edges = 0;
  int wrong = 0;
  for (int trial = 0; trial < 25; ++trial) {
    Map map;
    add_rectangle(map, {-6.0F, -6.0F, 0.0F}, {12.0F, 0.0F, 0.0F}, {0.0F, 12.0F, 0.0F});
    for (int i = 0; i < 15; ++i) {
      const Vector3f a(static_cast<float>(uniform(random, -5, 5)), static_cast<float>(uniform(random, -5, 5)), 0.0F);
      add_box(map, a,
              a + Vector3f(static_cast<float>(uniform(random, 0.05, 1)), static_cast<float>(uniform(random, 0.05, 1)),
                           static_cast<float>(uniform(random, 0.1, 1))));
    }
    const Pose X_WC = looking_from({uniform(random, -5, 5), uniform(random, -5, 5), 1.4},
                                   {uniform(random, -1, 1), uniform(random, -1, 1), 0.3});
    const auto pieces = seen(map, X_WC, camera);
    for (std::uint32_t e = 0; e < map.edges.size(); ++e) {
      const Vector3d a = map.vertices[map.edges[e].vertices[0]].cast<double>();
      const Vector3d b = map.vertices[map.edges[e].vertices[1]].cast<double>();
      const double exact_px = exact_length_px(map, X_WC, camera, a, b);
      double ours_px = 0.0;
      int count = 0;
      for (const VisiblePiece& piece : pieces) {
        if (piece.edge != e) continue;
        ours_px += (piece.p1 - piece.p0).norm();
        ++count;
      }
      if (exact_px == 0.0 && ours_px == 0.0) continue;
      ++edges;
      wrong += std::abs(exact_px - ours_px) > 6.0 * std::max(count, 1) ? 1 : 0;
      ends += 2 * std::max(count, 1);
      far_off += std::abs(exact_px - ours_px) > 3.0 ? 1 : 0;
    }
  }
  EXPECT_GT(edges, 1000);
  EXPECT_LE(wrong, edges / 100) << "of " << edges;
  EXPECT_LE(far_off, edges * 15 / 1000) << "of " << edges;
}

TEST(DepthRaster, SurroundingsThatTheLensShowsBeyondTheImageAreExpectedToo) {
  Camera lens;
  lens.k1 = -0.075;
  lens.k2 = 0.045;
  Map map;
  add_rectangle(map, {4.0F, 3.0F, -3.0F}, {0.0F, -6.0F, 0.0F}, {0.0F, 0.0F, 6.0F});
  add_rectangle(map, {3.9F, -0.01F, -3.0F}, {0.0F, 0.02F, 0.0F}, {0.0F, 0.0F, 6.0F});
  const Pose X_WC = looking_from({0.0, 0.0, 0.0}, {4.0, 0.0, 0.0});
  float lowest = 0.0F;
  for (const VisiblePiece& piece : seen(map, X_WC, lens)) lowest = std::max({lowest, piece.p0.y(), piece.p1.y()});
  EXPECT_NEAR(lowest, lens.undistorted({0.0, 479.5}).y(), 3.0) << "the lower corners";
  EXPECT_GT(lowest, 480.5F);
}

TEST(DepthRaster, WithoutRoomForAllTheLongestAreKept) {
  Map map;
  for (int i = 0; i < 30; ++i) {
    const auto y = static_cast<float>(i) * 0.1F - 1.5F;
    add_rectangle(map, {4.0F, y, 0.0F}, {0.0F, 0.05F, 0.0F}, {0.0F, 0.0F, 0.1F + 0.02F * static_cast<float>(i)});
  }
  const Pose X_WC = looking_from({0.0, 0.0, 1.0}, {4.0, 0.0, 0.5});
  const auto all = seen(map, X_WC);
  DepthRaster raster(map, {});
  std::vector<VisiblePiece> some;
  some.reserve(20);
  raster.look(X_WC, Camera(), some);
  EXPECT_EQ(some.size(), 20U);
  EXPECT_EQ(some.capacity(), 20U);
  EXPECT_TRUE(std::is_sorted(some.begin(), some.end(), [](const auto& a, const auto& b) { return a.edge < b.edge; }));
  EXPECT_GT(all.size(), 100U);
  float shortest = 1e9F;
  for (const auto& p : some) shortest = std::min(shortest, (p.p1 - p.p0).norm());
  const auto longer =
      std::count_if(all.begin(), all.end(), [&](const auto& p) { return (p.p1 - p.p0).norm() > shortest * 1.001F; });
  EXPECT_LE(longer, 19);
  EXPECT_GE(longer, 15) << "some are equally long";
}

TEST(DepthRaster, AMapBeyondTheBudgetKeepsTheNearest) {
  Map map;
  for (int i = 0; i < 120; ++i) {
    for (int j = 0; j < 20; ++j) {
      add_rectangle(map, {2.0F + static_cast<float>(i) * 0.5F, -5.0F + 0.5F * static_cast<float>(j), 0.0F},
                    {0.2F, 0.0F, 0.0F}, {0.0F, 0.2F, 0.0F});
    }
  }
  RasterParameters parameters;
  parameters.max_edges = 400;
  parameters.max_visited = 3000;
  DepthRaster raster(map, parameters);
  std::vector<VisiblePiece> pieces;
  raster.look(looking_from({0.0, 0.0, 1.5}, {6.0, 0.0, 0.0}), Camera(), pieces);
  EXPECT_GT(pieces.size(), 300U);
  EXPECT_LE(pieces.size(), 400U);
  for (const auto& p : pieces) EXPECT_LT(map.vertices[map.edges[p.edge].vertices[0]].x(), 20.0F);
}

/// A rectangle's inside as a grid of triangles, as modelling programs export a floor; its borders are not edges.
void add_grid(Map& map, const Vector3f& corner, const Vector3f& e1, const Vector3f& e2, std::uint32_t cells) {
  const auto v = static_cast<std::uint32_t>(map.vertices.size());
  world::Surface surface;
  surface.first_triangle = static_cast<std::uint32_t>(map.triangles.size());
  surface.triangle_count = 2 * cells * cells;
  surface.normal = e1.cross(e2).normalized();
  surface.offset_m = surface.normal.dot(corner);
  map.surfaces.push_back(surface);
  const auto share = [&](std::uint32_t i) { return static_cast<float>(i) / static_cast<float>(cells); };
  for (std::uint32_t i = 0; i <= cells; ++i) {
    for (std::uint32_t j = 0; j <= cells; ++j) map.vertices.emplace_back(corner + share(i) * e1 + share(j) * e2);
  }
  const std::uint32_t row = cells + 1;
  for (std::uint32_t i = 0; i < cells; ++i) {
    for (std::uint32_t j = 0; j < cells; ++j) {
      const std::uint32_t at = v + i * row + j;
      map.triangles.push_back({at, at + row, at + row + 1});
      map.triangles.push_back({at, at + row + 1, at + 1});
    }
  }
}

// A floor and walls that alone have more triangles than are drawn: the nearest parts of them are, and the room on them is seen.
TEST(DepthRaster, ARoomOfFineTrianglesIsSeenLikeOneOfLargeOnes) {
  const auto furnish = [](Map& map) {
    for (int i = 0; i < 5; ++i) {
      const Vector3f a(1.5F + 0.4F * static_cast<float>(i), -1.2F + 0.6F * static_cast<float>(i), 0.0F);
      add_box(map, a, a + Vector3f(0.3F, 0.3F, 0.5F));
    }
  };
  Map coarse;
  Map fine;
  furnish(coarse);
  furnish(fine);
  constexpr std::uint32_t kCells = 80;  // 12,800 triangles each
  const auto add_to_both = [&](const Vector3f& corner, const Vector3f& e1, const Vector3f& e2) {
    add_grid(coarse, corner, e1, e2, 1);
    add_grid(fine, corner, e1, e2, kCells);
  };
  add_to_both({-4, -4, 0}, {8, 0, 0}, {0, 8, 0});
  add_to_both({4, -4, 0}, {0, 8, 0}, {0, 0, 3});
  const Pose X_WC = looking_from({0.0, 0.0, 1.2}, {3.0, 0.2, 0.2});
  const auto expected = seen(coarse, X_WC);
  const auto got = seen(fine, X_WC);
  ASSERT_GT(expected.size(), 20U);
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(got[i].edge, expected[i].edge);
    EXPECT_LT((got[i].p0 - expected[i].p0).norm(), 1.0F);
    EXPECT_LT((got[i].p1 - expected[i].p1).norm(), 1.0F);
  }
}

// With a budget that holds only a part of what is in view, what is answered is still visible in the whole map.
TEST(DepthRasterProperty, BeyondTheBudgetHiddenIsHiddenAndTheLongestNearOnesStay) {
  std::mt19937 random(19);
  Map map;
  for (int i = 0; i < 16; ++i) {
    for (int j = -8; j < 8; ++j) {
      const Vector3f a(2.0F + 0.5F * static_cast<float>(i), 0.5F * static_cast<float>(j), 0.0F);
      const auto size = [&] { return static_cast<float>(uniform(random, 0.1, 0.35)); };
      add_box(map, a, a + Vector3f(size(), size(), 2.0F * size()));
    }
  }
  RasterParameters parameters;
  parameters.max_surfaces = 300;
  parameters.max_triangles = 500;
  parameters.max_edges = 200;
  DepthRaster raster(map, parameters);
  const Camera camera;
  double ours_px = 0.0;
  double hidden_px = 0.0;
  for (int trial = 0; trial < 3; ++trial) {
    const Pose X_WC =
        looking_from({uniform(random, -1, 1), uniform(random, -2, 2), 0.9}, {8.0, uniform(random, -2, 2), 0.3});
    std::vector<VisiblePiece> pieces;
    raster.look(X_WC, camera, pieces);
    EXPECT_GT(pieces.size(), 60U);
    const auto edges_of = [](const std::vector<VisiblePiece>& some) {
      std::vector<std::uint32_t> edges;
      edges.reserve(some.size());
      for (const VisiblePiece& piece : some) edges.push_back(piece.edge);
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
      return edges;
    };
    const auto kept = edges_of(pieces);
    EXPECT_LE(kept.size(), 200U);
    for (const VisiblePiece& piece : pieces) {
      const Vector3d a = map.vertices[map.edges[piece.edge].vertices[0]].cast<double>();
      const Vector3d b = map.vertices[map.edges[piece.edge].vertices[1]].cast<double>();
      const double length_px = (piece.p1 - piece.p0).norm();
      const double seen_px = exact_length_px(map, X_WC, camera, a + static_cast<double>(piece.from) * (b - a),
                                             a + static_cast<double>(piece.to) * (b - a));
      ours_px += length_px;
      hidden_px += std::max(0.0, length_px - seen_px);
    }
    // Of the nearest the long ones are all there.
    for (const VisiblePiece& piece : seen(map, X_WC)) {
      const float x = map.vertices[map.edges[piece.edge].vertices[0]].x();
      if (x > 2.4F || (piece.p1 - piece.p0).norm() < 60.0F) continue;
      EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), piece.edge)) << trial;
    }
  }
  EXPECT_LT(hidden_px, 0.01 * ours_px);
}

TEST(DepthRasterFault, AMapOfNothingShowsNothing) {
  const Map map;
  EXPECT_TRUE(seen(map, Pose::Identity()).empty());
}

TEST(DepthRasterFault, APoseThatIsNotFiniteHarmsNothing) {
  Map map;
  add_box(map, {2.0F, -0.5F, 0.0F}, {3.0F, 0.5F, 1.0F});
  Pose X_WC = looking_from({0.0, 0.0, 1.0}, {3.0, 0.0, 0.5});
  DepthRaster raster(map, {});
  std::vector<VisiblePiece> pieces;
  const Pose good = X_WC;
  X_WC.translation().x() = std::nan("");
  raster.look(X_WC, Camera(), pieces);
  X_WC.translation().x() = 1e300;
  raster.look(X_WC, Camera(), pieces);
  raster.look(good, Camera(), pieces);
  EXPECT_EQ(pieces.size(), seen(map, good).size());
}

TEST(DepthRasterAlloc, LookingTakesNoMemory) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "SKIPPED: a sanitizer brings its own malloc";
  Map map;
  for (int i = 0; i < 60; ++i) {
    const Vector3f a(static_cast<float>(i % 8) + 1.0F, static_cast<float>(i / 8) - 4.0F, 0.0F);
    add_box(map, a, a + Vector3f(0.3F, 0.3F, 0.5F));
  }
  DepthRaster raster(map, {});
  std::vector<VisiblePiece> pieces;
  pieces.reserve(1000);
  Camera lens;
  lens.k1 = -0.07;
  const test::AllocationGuard guard;
  for (int i = 0; i < 20; ++i) {
    const Pose X_WC = looking_from({-1.0, 0.1 * i, 1.5}, {3.0, 0.0, 0.0});
    raster.look(X_WC, i % 2 == 0 ? Camera() : lens, pieces);
  }
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_FALSE(pieces.empty());
}

}  // namespace
}  // namespace cgsr::render
