#include "pipeline/localization/expected.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/localization/small_room.h"

namespace cgsr::localization {
namespace {

using testing::in_small_room;
using testing::MapBuilder;
using testing::Picture;
using testing::small_room;

geometry::Camera small_camera() {
  return geometry::Camera{}.scaled_to(320, 240).without_distortion();
}

std::vector<ProjectedPiece> projected(const world::Map& map, const geometry::Pose& X_WC, ExpectedView& view) {
  EveryEdge every(map);
  std::vector<render::VisiblePiece> pieces;
  pieces.reserve(1000);
  every.look(X_WC, small_camera(), pieces);
  view.take(pieces, X_WC);
  view.project(X_WC, small_camera());
  return {view.projected().begin(), view.projected().end()};
}

TEST(ExpectedProperty, PointsOfAPieceProjectToWhereTheyAreSeen) {
  const world::Map map = small_room();
  const geometry::Pose X_WC = in_small_room(1.0, 1.5, 0.4);
  ExpectedView view(map, 1000);
  const auto pieces = projected(map, X_WC, view);
  ASSERT_GT(pieces.size(), 20U);
  for (const ProjectedPiece& piece : pieces) {
    for (const float share : {-1.0F, -0.3F, 0.0F, 0.8F, 1.0F}) {
      const Eigen::Vector3d p_W = view.point_at(piece, share * piece.half_length);
      const auto pixel = small_camera().pixel_of(X_WC.inverse() * p_W);
      ASSERT_TRUE(pixel);
      const Eigen::Vector2f place = piece.middle + share * piece.half_length * piece.direction;
      EXPECT_LT((pixel->cast<float>() - place).norm(), 0.05F);
    }
  }
}

// Where a brighter side is expected of a visible edge the picture shows it there.
TEST(ExpectedProperty, TheBrighterSideIsWhereThePictureHasIt) {
  const world::Map map = small_room();
  const Eigen::Vector3f eye(1.0F, 1.6F, 0.6F);
  int known = 0;
  int wrong = 0;
  for (const double heading : {-0.5, 0.0, 0.5, 1.2}) {
    const geometry::Pose X_WC = in_small_room(eye.x(), eye.y(), heading);
    const Picture picture(map, X_WC, small_camera(), 0.0, 1);
    const auto grey = [&](const Eigen::Vector2f& p) {
      const int x = std::clamp(static_cast<int>(std::lround(p.x())), 0, 319);
      const int y = std::clamp(static_cast<int>(std::lround(p.y())), 0, 239);
      return static_cast<int>(picture.pixels[static_cast<std::size_t>(y * 320 + x)]);
    };
    ExpectedView view(map, 1000);
    for (const ProjectedPiece& piece : projected(map, X_WC, view)) {
      if (piece.bright_side == 0) continue;
      const Eigen::Vector2f normal(-piece.direction.y(), piece.direction.x());
      const int difference = grey(piece.middle + 2.0F * normal) - grey(piece.middle - 2.0F * normal);
      if (std::abs(difference) < 15) continue;  // hidden, or too far away to tell
      ++known;
      wrong += difference * piece.bright_side < 0 ? 1 : 0;
    }
  }
  EXPECT_GT(known, 30);
  EXPECT_LE(wrong, known / 10) << "every edge is projected here, the hidden ones too";
}

TEST(Expected, BothBordersOfATapeAndTheFootOfABoxKnowTheirBrighterSide) {
  MapBuilder b;
  const std::uint32_t floor = b.rectangle({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, b.grey(0.2F));
  const std::uint32_t white = b.grey(0.9F);
  b.rectangle({1, -1, 0.002F}, {0.1F, 0, 0}, {0, 2, 0}, white, floor);
  b.box({3, -0.2F, 0}, {0.4F, 0.4F, 0.4F}, white, floor);
  const geometry::Pose X_WC = in_small_room(-0.5, 0.0, 0.0);
  ExpectedView view(b.map, 1000);
  int borders = 0;
  int foot = 0;
  for (const ProjectedPiece& piece : projected(b.map, X_WC, view)) {
    const world::Edge& edge = b.map.edges[view.pieces()[piece.piece].edge];
    if (std::abs(piece.direction.y()) > 0.2F) continue;  // level lines only
    const Eigen::Vector3f middle = 0.5F * (b.map.vertices[edge.vertices[0]] + b.map.vertices[edge.vertices[1]]);
    // +1: brighter below, where the direction runs to the right.
    const int below = piece.direction.x() > 0.0F ? piece.bright_side : -piece.bright_side;
    if (std::abs(middle.x() - 1.0F) < 1e-3F) borders += below == -1 ? 1 : 0;
    if (std::abs(middle.x() - 1.1F) < 1e-3F) borders += below == 1 ? 1 : 0;
    if (std::abs(middle.x() - 3.0F) < 1e-3F && middle.z() < 0.01F) foot += below == -1 ? 1 : 0;
  }
  EXPECT_EQ(borders, 2);
  EXPECT_EQ(foot, 1);
}

// A corner holds a pose; what hides the rest of an edge, or the image's border, is none.
TEST(Expected, AnEdgeEndsWhereItsLastPieceDoesAndNothingHidesOrCutsIt) {
  MapBuilder b;
  b.rectangle({2, -0.5F, 0.5F}, {0, 1, 0}, {0, 0, 0.2F}, b.grey(0.9F));
  ExpectedView view(b.map, 100);
  const geometry::Pose whole_in_view = in_small_room(0.0, 0.0, 0.0);
  const auto pieces = projected(b.map, whole_in_view, view);
  ASSERT_EQ(pieces.size(), 4U);
  for (const ProjectedPiece& piece : pieces) {
    EXPECT_TRUE(view.ends_at_first(piece));
    EXPECT_TRUE(view.ends_at_last(piece));
  }

  EveryEdge every(b.map);
  std::vector<render::VisiblePiece> visible;
  visible.reserve(100);
  every.look(whole_in_view, small_camera(), visible);
  const float whole_px = (visible[0].p1 - visible[0].p0).norm();
  const auto seen_to = [&](float to) {
    render::VisiblePiece piece = visible[0];
    piece.p1 = piece.p0 + to * (piece.p1 - piece.p0);
    piece.to = to;
    view.take(std::vector{piece}, whole_in_view);
    view.project(whole_in_view, small_camera());
    return view.projected()[0];
  };
  EXPECT_TRUE(view.ends_at_first(seen_to(0.5F)));
  EXPECT_FALSE(view.ends_at_last(seen_to(0.5F))) << "hidden from there on";
  const world::Edge& edge = b.map.edges[visible[0].edge];
  const ProjectedPiece nearly = seen_to(1.0F - 1.0F / whole_px);
  EXPECT_TRUE(view.ends_at_last(nearly)) << "a pixel short of it";
  EXPECT_TRUE(view.pieces()[nearly.piece].p1_W.isApprox(b.map.vertices[edge.vertices[1]]));

  const geometry::Pose half_out_of_view = in_small_room(0.0, 0.0, 0.6);
  int cut = 0;
  for (const ProjectedPiece& piece : projected(b.map, half_out_of_view, view)) {
    const bool level = std::abs(piece.direction.x()) > 0.5F;
    if (!level) continue;
    EXPECT_NE(view.ends_at_first(piece), view.ends_at_last(piece));
    ++cut;
  }
  EXPECT_EQ(cut, 2);
}

// Of an edge that comes towards the camera, the near end has most of the pixels.
TEST(Expected, WhatHidesTheNearEndOfAnEdgeIsMeasuredThere) {
  MapBuilder b;
  b.rectangle({0.5F, -0.2F, 0.4F}, {9.5F, 0, 0}, {0, 0, 0.2F}, b.grey(0.9F));
  ExpectedView view(b.map, 100);
  const geometry::Pose X_WC = in_small_room(0.0, 0.0, 0.0);
  int along = 0;
  for (std::uint32_t i = 0; i < b.map.edges.size(); ++i) {
    const Eigen::Vector3d a = b.map.vertices[b.map.edges[i].vertices[0]].cast<double>();
    const Eigen::Vector3d d = b.map.vertices[b.map.edges[i].vertices[1]].cast<double>() - a;
    if (std::abs(d.x()) < 1.0) continue;
    ++along;
    const bool comes = d.x() < 0.0;
    const auto pixel_at = [&](double place) {
      return Eigen::Vector2f(small_camera().pixel_of(X_WC.inverse() * (a + place * d)).value().cast<float>());
    };
    const auto ends_near = [&](double hidden) {
      const double from = comes ? 0.0 : hidden;
      const double to = comes ? 1.0 - hidden : 1.0;
      view.take(std::vector<render::VisiblePiece>{{i, static_cast<float>(from), static_cast<float>(to), pixel_at(from),
                                                   pixel_at(to)}},
                X_WC);
      return comes ? view.pieces()[0].ends_at_p1 : view.pieces()[0].ends_at_p0;
    };
    const double near = comes ? 1.0 : 0.0;
    const double hidden = 0.015;
    ASSERT_GT((pixel_at(near) - pixel_at(comes ? 1.0 - hidden : hidden)).norm(), 10.0F);
    EXPECT_FALSE(ends_near(hidden));
    EXPECT_TRUE(ends_near(0.0005));
  }
  EXPECT_EQ(along, 2);
}

TEST(Expected, WhatIsBehindOrOutsideIsLeftOut) {
  const world::Map map = small_room();
  const geometry::Pose X_WC = in_small_room(2.0, 2.0, 0.0);
  ExpectedView view(map, 1000);
  for (const ProjectedPiece& piece : projected(map, X_WC, view)) {
    EXPECT_GT(std::min(piece.depth0_m, piece.depth1_m), 0.0F);
    for (const float end : {-1.0F, 1.0F}) {
      const Eigen::Vector2f p = piece.middle + end * piece.half_length * piece.direction;
      EXPECT_GT(p.x(), 0.0F);
      EXPECT_GT(p.y(), 0.0F);
      EXPECT_LT(p.x(), 319.5F);
      EXPECT_LT(p.y(), 239.5F);
    }
  }
}

}  // namespace
}  // namespace cgsr::localization
