#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "pipeline/world/clean.h"
#include "tests/world/small_maps.h"

namespace cgsr::world {
namespace {

using Point = Maker::Point;

TEST(Clean, ACubeHasTwelveEdges) {
  Maker maker;
  maker.box({0, 0, 0}, {1, 1, 1});
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 6U);
  EXPECT_EQ(map.triangles.size(), 12U);
  EXPECT_EQ(map.vertices.size(), 8U);
  EXPECT_EQ(map.edges.size(), 12U);
  EXPECT_EQ(count(map, EdgeKind::kCrease), 12);
  EXPECT_NEAR(area_of(map), 6.0, 1e-6);
}

TEST(Clean, ACubeOfTrianglesWithoutSharedCornersIsTheSame) {
  Maker maker;
  Maker outlines;
  outlines.box({0, 0, 0}, {1, 1, 1});
  for (const Soup::Face& face : outlines.soup().faces) {
    const auto p = [&](std::uint32_t i) { return outlines.soup().points[outlines.soup().corners[face.first + i]]; };
    maker.face({p(0), p(1), p(2)});
    maker.face({p(2), p(3), Point(p(0) + Point(2e-5F, 0.0F, -2e-5F))});
  }
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 6U);
  EXPECT_EQ(map.edges.size(), 12U);
  EXPECT_EQ(map.vertices.size(), 8U);
}

TEST(Clean, EdgesRunCounterClockwiseAboutTheirFirstSurface) {
  Maker maker;
  maker.box({0, 0, 0}, {1, 2, 3});
  const Map map = maker.map();
  for (const Edge& edge : map.edges) {
    const Eigen::Vector3f a = map.vertices[edge.vertices[0]];
    const Eigen::Vector3f b = map.vertices[edge.vertices[1]];
    for (const int side : {0, 1}) {
      const Surface& surface = map.surfaces[edge.surfaces[static_cast<std::size_t>(side)]];
      const Eigen::Vector3f left = surface.normal.cross((b - a).normalized());
      const Eigen::Vector3f inside = 0.5F * (a + b) + (side == 0 ? 0.1F : -0.1F) * left;
      EXPECT_TRUE((inside.array() > -1e-5F).all() && (inside.array() < Eigen::Array3f(1, 2, 3) + 1e-5F).all());
      EXPECT_NEAR(surface.normal.dot(a), surface.offset_m, 1e-5F);
    }
  }
}

TEST(Clean, ACheckerboardOfNineBySeven) {
  Maker maker;
  maker.material("black", 0.1F);
  maker.material("white", 0.9F);
  for (int x = 0; x < 9; ++x) {
    for (int y = 0; y < 7; ++y) {
      const auto u = static_cast<float>(x);
      const auto v = static_cast<float>(y);
      maker.level(u, v, u + 1.0F, v + 1.0F, 0.0F, static_cast<std::uint32_t>((x + y) % 2));
    }
  }
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 63U);
  EXPECT_EQ(map.edges.size(), 9U * 8U + 10U * 7U);
  EXPECT_EQ(count(map, EdgeKind::kMaterial), 9 * 6 + 8 * 7);
  EXPECT_EQ(count(map, EdgeKind::kBorder), 2 * (9 + 7));
  for (const Edge& edge : map.edges) {
    if (edge.kind == EdgeKind::kMaterial) {
      EXPECT_NEAR(edge.contrast, 0.8F, 1e-5F);
    }
  }
}

TEST(Clean, CoplanarPiecesOfOneMaterialAreOneSurface) {
  Maker maker;
  maker.material("floor", 0.5F);
  maker.level(0, 0, 1, 1, 0);
  maker.level(1, 0, 2, 1, 0);
  maker.face({{2, 1, 0}, {2, 2, 0}, {0, 2, 0}, {0, 1, 0}, {1, 1, 0}});  // with a corner in the middle of a side
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 1U);
  EXPECT_EQ(map.edges.size(), 4U);
  EXPECT_NEAR(area_of(map), 4.0, 1e-6);
}

TEST(Clean, AFineGridHasOnlyItsOutline) {
  Maker maker;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) {
      const float u = 0.1F * static_cast<float>(x);
      const float v = 0.1F * static_cast<float>(y);
      maker.level(u, v, u + 0.1F, v + 0.1F, 1.0F);
    }
  }
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 1U);
  EXPECT_EQ(map.edges.size(), 4U);
}

TEST(Clean, FacesAgainstEachOtherInWindingAreOneSurfaceStill) {
  Maker maker;
  maker.level(0, 0, 1, 1, 0);
  maker.face({{1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0, 0}});  // its front is down
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 1U);
  EXPECT_EQ(map.edges.size(), 4U);
  for (const Triangle& t : map.triangles) {
    const Eigen::Vector3f n = (map.vertices[t[1]] - map.vertices[t[0]]).cross(map.vertices[t[2]] - map.vertices[t[0]]);
    EXPECT_GT(n.dot(map.surfaces[0].normal), 0.0F);
  }
}

TEST(Clean, AFloorOfTilesThatDoNotMeetAtCornersHasNoSeam) {
  Maker maker;
  maker.level(0, 0, 3, 1, 0);
  maker.level(0, 1, 1.3F, 2, 0);
  maker.level(1.3F, 1, 3, 2, 0);
  const Map map = maker.map();
  EXPECT_EQ(count(map, EdgeKind::kBorder), static_cast<int>(map.edges.size()));
  for (const Edge& edge : map.edges) {
    const Eigen::Vector3f middle = 0.5F * (map.vertices[edge.vertices[0]] + map.vertices[edge.vertices[1]]);
    const bool outer = middle.x() < 0.01F || middle.x() > 2.99F || middle.y() < 0.01F || middle.y() > 1.99F;
    EXPECT_TRUE(outer) << middle.transpose();
  }
}

TEST(Clean, ATJunctionGivesEachPieceItsOwnNeighbours) {
  Maker maker;
  maker.material("white", 0.9F);
  maker.material("grey", 0.5F);
  maker.material("black", 0.1F);
  maker.level(0, 0, 3, 1, 0, 0);
  maker.level(0, 1, 1.3F, 2, 0, 1);
  maker.level(1.3F, 1, 3, 2, 0, 2);
  const Map map = maker.map();
  const Edge left = edge_between(map, {0, 1, 0}, {1.3F, 1, 0});
  const Edge right = edge_between(map, {1.3F, 1, 0}, {3, 1, 0});
  EXPECT_EQ(left.kind, EdgeKind::kMaterial);
  EXPECT_NEAR(left.contrast, 0.4F, 1e-5F);
  EXPECT_EQ(right.kind, EdgeKind::kMaterial);
  EXPECT_NEAR(right.contrast, 0.8F, 1e-5F);
  EXPECT_EQ(map.edges.size(), 3U + 7U);  // three seams; below one, left and right two each, above two
}

TEST(Clean, ConcaveOutlinesStayWhatTheyAre) {
  Maker maker;
  maker.face({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}});
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 1U);
  EXPECT_EQ(map.edges.size(), 6U);
  EXPECT_NEAR(area_of(map), 5.0, 1e-6);
}

TEST(CleanProperty, StarsKeepTheirAreaAndOutline) {
  std::mt19937 random(3);
  const auto unit = [&] { return static_cast<double>(random() % 10000U) / 10000.0; };
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond(unit() + 0.1, unit() - 0.5, unit() - 0.5, unit() - 0.5).normalized().toRotationMatrix();
    const int corners = 5 + static_cast<int>(random() % 20U);
    std::vector<Point> outline;
    std::vector<Eigen::Vector2d> flat;
    for (int i = 0; i < corners; ++i) {
      const double around = 2.0 * 3.14159265358979 * (i + 0.5 * unit()) / corners;
      const double radius = 0.3 + unit();
      flat.emplace_back(radius * std::cos(around), radius * std::sin(around));
      outline.emplace_back((turn * Eigen::Vector3d(flat.back().x(), flat.back().y(), 0.7)).cast<float>());
    }
    double area = 0.0;
    std::size_t turns = 0;
    for (std::size_t i = 0; i < flat.size(); ++i) {
      const Eigen::Vector2d& a = flat[i];
      const Eigen::Vector2d& b = flat[(i + 1) % flat.size()];
      area += 0.5 * (a.x() * b.y() - a.y() * b.x());
      const Eigen::Vector2d ab = b - a;
      const Eigen::Vector2d ac = flat[(i + 2) % flat.size()] - a;
      turns += std::abs(ab.x() * ac.y() - ab.y() * ac.x()) > 3e-4 * ac.norm() ? 1 : 0;
    }
    Maker maker;
    maker.face(outline);
    const Map map = maker.map();
    EXPECT_EQ(map.surfaces.size(), 1U);
    // A corner that hardly turns is none.
    EXPECT_LE(map.edges.size(), outline.size());
    EXPECT_GE(map.edges.size(), turns);
    EXPECT_NEAR(area_of(map), area, 1e-4 * area);
  }
}

TEST(Clean, WhatHasNoAreaGoes) {
  Maker maker;
  maker.level(0, 0, 1, 1, 0);
  maker.face({{5, 5, 5}, {6, 6, 6}, {7, 7, 7}});
  maker.face({{5, 5, 5}, {5, 5, 5}, {7, 7, 7}});
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 1U);
  EXPECT_EQ(map.vertices.size(), 4U);
}

TEST(Clean, ASheetGivenFromBothSidesIsOneSurface) {
  Maker maker;
  maker.level(0, 0, 1, 1, 0);
  maker.face({{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}});
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 1U);
  EXPECT_EQ(map.triangles.size(), 2U);
  EXPECT_EQ(map.edges.size(), 4U);
  EXPECT_EQ(count(map, EdgeKind::kBorder), 4);
}

TEST(Clean, ASheetGivenFromBothSidesAndCutDifferentlyIsOneSurface) {
  Maker maker;
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  maker.face({{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.face({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}});
  maker.face({{1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 1U);
  EXPECT_EQ(map.edges.size(), 4U);
  EXPECT_NEAR(area_of(map), 1.0, 1e-6);
}

TEST(Clean, AStripGivenFromBothSidesStaysAStrip) {
  Maker maker;
  for (const float x : {0.0F, 1.0F, 2.0F}) {
    maker.level(x, 0, x + 1, 1, 0);
    maker.face({{x, 0, 0}, {x, 1, 0}, {x + 1, 1, 0}, {x + 1, 0, 0}});
  }
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 1U);
  EXPECT_EQ(map.edges.size(), 4U);
}

TEST(Clean, ARoofKeepsItsCrease) {
  Maker maker;
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1F}, {0, 1, 0.1F}});
  maker.face({{0, 1, 0.1F}, {1, 1, 0.1F}, {1, 2, 0}, {0, 2, 0}});
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 2U);
  EXPECT_EQ(map.edges.size(), 7U);
  EXPECT_EQ(edge_between(map, {0, 1, 0.1F}, {1, 1, 0.1F}).kind, EdgeKind::kCrease);
}

// A face whose corners were measured by hand lies in no plane; the line along which it was cut into triangles is none of the place.
TEST(Clean, TheDiagonalOfAWarpedFaceIsNoEdge) {
  Maker maker;
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.03F}, {0, 1, 0}});
  const Map map = maker.map();
  EXPECT_EQ(map.edges.size(), 4U);
  EXPECT_EQ(count(map, EdgeKind::kBorder), 4);
}

TEST(Clean, TheDiagonalOfAWarpedFaceIsOneWhereSomethingElseMeetsIt) {
  for (const auto& [one, other] : {std::pair{0, 2}, std::pair{1, 3}}) {
    Maker maker;
    const std::vector<Point> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.03F}, {0, 1, 0}};
    maker.face(corners);
    const Point a = corners[static_cast<std::size_t>(one)], b = corners[static_cast<std::size_t>(other)];
    maker.face({a, b, Point(b + Point(0, 0, 1)), Point(a + Point(0, 0, 1))});
    const Map map = maker.map();
    EXPECT_EQ(map.edges.size(), 8U) << one;
  }
}

TEST(Clean, ABentFaceKeepsItsCrease) {
  Maker maker;
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5F}, {0, 1, 0}});
  EXPECT_EQ(maker.map().edges.size(), 5U);
}

TEST(Clean, ARoundPostKeepsItsFacets) {
  Maker maker;
  constexpr int kFacets = 48;
  const auto at = [](int i, float z) {
    const double around = 2.0 * 3.14159265358979 * i / kFacets;
    return Point(0.05F * static_cast<float>(std::cos(around)), 0.05F * static_cast<float>(std::sin(around)), z);
  };
  for (int i = 0; i < kFacets; ++i) maker.face({at(i, 0), at(i + 1, 0), at(i + 1, 2), at(i, 2)});
  const Map map = maker.map();
  EXPECT_EQ(map.surfaces.size(), 48U);
  EXPECT_EQ(count(map, EdgeKind::kCrease), 48);
}

TEST(Clean, APosterOnAWallIsSeenAgainstTheWall) {
  for (const float off : {0.002F, -0.008F, 0.0F}) {
    Maker maker;
    maker.material("wall", 0.9F);
    maker.material("poster", 0.3F);
    maker.face({{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}}, 0);
    maker.face({{1, off, 1}, {2, off, 1}, {2, off, 2}, {1, off, 2}}, 1);
    const Map map = maker.map();
    EXPECT_EQ(map.edges.size(), 8U);
    const Edge edge = edge_between(map, {1, off, 1}, {2, off, 1});
    EXPECT_EQ(edge.kind, EdgeKind::kBorder);
    EXPECT_EQ(material_of(map, edge.surfaces[0]), "poster");
    EXPECT_EQ(edge.surfaces[1], kNone);
    EXPECT_EQ(material_of(map, edge.sides[0]), "poster");
    EXPECT_EQ(material_of(map, edge.sides[1]), "wall");
    EXPECT_NEAR(edge.contrast, 0.6F, 1e-5F);
    const Edge end = edge_between(map, {0, 0, 0}, {4, 0, 0});
    EXPECT_EQ(end.sides[1], kNone);
    EXPECT_NEAR(end.contrast, 0.25F, 1e-6F);
  }
}

TEST(Clean, ABoardThatStandsOnTheFloorEndsAtTheFloor) {
  Maker maker;
  maker.material("floor", 0.4F);
  maker.material("board", 0.9F);
  maker.level(-2, -2, 2, 2, 0, 0);
  maker.face({{-1, 0, 0.001F}, {1, 0, 0.001F}, {1, 0, 1}, {-1, 0, 1}}, 1);
  const Map map = maker.map();
  const Edge foot = edge_between(map, {-1, 0, 0.001F}, {1, 0, 0.001F});
  EXPECT_EQ(foot.kind, EdgeKind::kBorder);
  EXPECT_EQ(material_of(map, foot.sides[1]), "floor");
  EXPECT_NEAR(foot.contrast, std::hypot(0.5F, 0.25F * 0.65F), 1e-4F);
  EXPECT_EQ(edge_between(map, {-1, 0, 1}, {1, 0, 1}).sides[1], kNone);
}

TEST(Clean, ABoxOnTheFloorIsSeenAgainstTheFloor) {
  for (const float gap : {0.0F, 0.001F}) {
    Maker maker;
    maker.material("floor", 0.4F);
    maker.material("box", 0.9F);
    maker.level(-2, -2, 2, 2, 0, 0);
    maker.box({0, 0, gap}, {0.5F, 0.4F, gap + 0.3F}, 1);
    const Map map = maker.map();
    EXPECT_EQ(map.edges.size(), 16U);
    const Edge foot = edge_between(map, {0, 0, gap}, {0.5F, 0, gap});
    EXPECT_EQ(foot.kind, EdgeKind::kCrease);
    const std::string both = material_of(map, foot.sides[0]) + " " + material_of(map, foot.sides[1]);
    EXPECT_TRUE(both == "floor box" || both == "box floor") << both;
    const std::size_t floor = material_of(map, foot.sides[0]) == "floor" ? 0 : 1;
    EXPECT_NEAR(std::abs(map.surfaces[foot.surfaces[floor]].normal.z()), 1.0F, 1e-5F)
        << "the floor stands for the bottom";
    const Edge top = edge_between(map, {0, 0, gap + 0.3F}, {0.5F, 0, gap + 0.3F});
    EXPECT_EQ(top.sides, top.surfaces);
    // Its shading alone.
    EXPECT_NEAR(top.contrast, 0.25F * 0.9F, 1e-4F);
  }
}

TEST(Clean, ARoomsCornersAreNotCovered) {
  Maker maker;
  maker.material("wall", 0.8F);
  maker.face({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}});
  maker.face({{0, 0, 0}, {0, 0, 2}, {3, 0, 2}, {3, 0, 0}});
  const Map map = maker.map();
  const Edge corner = edge_between(map, {0, 0, 0}, {3, 0, 0});
  EXPECT_EQ(corner.kind, EdgeKind::kCrease);
  EXPECT_EQ(corner.sides, corner.surfaces);
}

TEST(Clean, AWallWithABottomMeetsTheFloorThatEndsAtIt) {
  Maker maker;
  maker.material("floor", 0.4F);
  maker.material("wall", 0.9F);
  maker.level(0, 0, 3, 1, 0, 0);
  maker.box({0, 1, 0}, {3, 1.2F, 2}, 1);
  const Map map = maker.map();
  const Edge foot = edge_between(map, {0, 1, 0}, {3, 1, 0});
  EXPECT_EQ(foot.kind, EdgeKind::kCrease);
  EXPECT_EQ(foot.sides, foot.surfaces);
  const std::size_t floor = material_of(map, foot.surfaces[0]) == "floor" ? 0 : 1;
  EXPECT_EQ(material_of(map, foot.surfaces[floor]), "floor");
  EXPECT_NEAR(map.surfaces[foot.surfaces[1 - floor]].normal.y(), -1.0F, 1e-5F);
}

TEST(Clean, ACubeOnACubeHasNoSeamWhereTheirSidesGoOn) {
  Maker maker;
  maker.box({0, 0, 0}, {1, 1, 1});
  maker.box({0, 0, 1}, {1, 1, 2});
  const Map map = maker.map();
  EXPECT_EQ(count(map, EdgeKind::kCrease), 12) << "and four where the sheet between them ends";
  EXPECT_LE(map.edges.size(), 16U);
}

TEST(Clean, DrawnLinesStayUnlessTheyAreEdgesAnyway) {
  Maker maker;
  maker.level(0, 0, 1, 1, 0);
  maker.line({0, 0, 0}, {1, 0, 0});
  maker.line({0, 0.5F, 0}, {1, 0.5F, 0});
  maker.line({1, 0.5F, 0}, {0, 0.5F, 0});
  const Map map = maker.map();
  EXPECT_EQ(map.edges.size(), 5U);
  EXPECT_EQ(count(map, EdgeKind::kDrawn), 1);
}

// Each triangle is in order by itself; together they would keep everything that looks about an edge busy for minutes.
TEST(CleanFault, AFanAboutOneEdgeIsRefusedAtOnce) {
  constexpr int kTriangles = 100000;
  Maker maker;
  maker.material("plain", 0.5F);
  for (int i = 0; i < kTriangles; ++i) {
    const float angle = 6.2831853F * static_cast<float>(i) / kTriangles;
    const float away = 50.0F;  // far enough that corners are not one
    maker.face({{0, 0, 0}, {0, 0, 1}, {away * std::cos(angle), away * std::sin(angle), 0.5F}});
  }
  const auto begun = std::chrono::steady_clock::now();
  const auto map = clean(maker.soup(), 1e-4, 0.02);
  ASSERT_FALSE(map);
  EXPECT_THAT(map.error().message, testing::HasSubstr("triangles share the edge from (0.000, 0.000, 0.000)"));
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(20)) << "it used to take minutes";
}

TEST(Clean, AFanOfAFewSheetsIsAMap) {
  Maker maker;
  for (int i = 0; i < 32; ++i) {
    const float angle = 6.2831853F * static_cast<float>(i) / 32.0F;
    maker.face({{0, 0, 0}, {0, 0, 1}, {std::cos(angle), std::sin(angle), 0.5F}});
  }
  EXPECT_GE(maker.map().surfaces.size(), 16U);
}

TEST(Clean, RefusesWhatIsNoWorld) {
  const auto refused = [](Maker& maker) {
    maker.material("plain", 0.5F);
    const auto map = clean(maker.soup(), 1e-4, 0.02);
    return map ? std::string() : map.error().message;
  };
  Maker empty;
  EXPECT_THAT(refused(empty), testing::HasSubstr("no surface"));
  Maker flat;
  flat.face({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  EXPECT_THAT(refused(flat), testing::HasSubstr("no surface with an area"));
  Maker hole;
  hole.face({{0, 0, 0}, {1, 0, 0}, {2, std::numeric_limits<float>::quiet_NaN(), 0}});
  EXPECT_THAT(refused(hole), testing::HasSubstr("corner 2 is not finite"));
  Maker endless;
  endless.face({{0, 0, 0}, {1, 0, 0}, {2, std::numeric_limits<float>::infinity(), 0}});
  EXPECT_THAT(refused(endless), testing::HasSubstr("not finite"));
  Maker huge;
  huge.face({{0, 0, 0}, {1.1e6F, 0, 0}, {0, 1, 0}});
  EXPECT_THAT(refused(huge), testing::HasSubstr("1000 km"));
  Maker tangle;
  std::mt19937 random(5);
  const auto unit = [&] { return static_cast<float>(random() % 10000U) / 10000.0F; };
  for (int i = 0; i < 8000; ++i)
    tangle.face({{unit(), unit(), unit()}, {unit(), unit(), unit()}, {unit(), unit(), unit()}});
  EXPECT_THAT(refused(tangle), testing::HasSubstr("through each other"));
}

}  // namespace
}  // namespace cgsr::world
