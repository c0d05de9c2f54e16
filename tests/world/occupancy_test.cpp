#include "pipeline/world/occupancy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/world/clean.h"

namespace cgsr::world {
namespace {

/// A grid of 5 cm cells whose rows are given from the top: '#' is occupied.
OccupancyGrid grid_of(int columns, int rows) {
  OccupancyGrid grid;
  grid.columns = columns;
  grid.rows = rows;
  grid.occupied.assign(static_cast<std::size_t>(columns * rows), 0);
  return grid;
}

void occupy(OccupancyGrid& grid, int column, int row) {
  grid.occupied[static_cast<std::size_t>(row * grid.columns + column)] = 1;
}

void frame(OccupancyGrid& grid, int left, int top, int right, int bottom) {
  for (int column = left; column <= right; ++column) {
    occupy(grid, column, top);
    occupy(grid, column, bottom);
  }
  for (int row = top; row <= bottom; ++row) {
    occupy(grid, left, row);
    occupy(grid, right, row);
  }
}

/// The distance of the nearest wall's line piece from a point.
double distance(const WallPlan& plan, const Eigen::Vector2d& p) {
  double nearest = 1e9;
  for (const Wall& wall : plan.walls) {
    const Eigen::Vector2d along = wall.p_WB - wall.p_WA;
    const double t = std::clamp((p - wall.p_WA).dot(along) / along.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (wall.p_WA + t * along - p).norm());
  }
  return nearest;
}

TEST(Occupancy, ARoomHasItsWallsInnerAndOuter) {
  OccupancyGrid grid = grid_of(100, 80);
  grid.p_WO = {-1.0, -2.0};
  frame(grid, 10, 10, 89, 69);  // the inner faces: x -0.45 to 3.45, y -1.45 to 1.45
  WallParameters parameters;
  parameters.tolerance_m = 0.02;
  const auto plan = walls_of(grid, parameters);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->walls.size(), 8U);
  EXPECT_NEAR(plan->length_m, 2 * (4.0 + 3.0) + 2 * (3.9 + 2.9), 0.2);
  EXPECT_LT(distance(*plan, {-0.45, 0.0}), 0.02);
  EXPECT_LT(distance(*plan, {3.5, 0.0}), 0.02);
  EXPECT_LT(distance(*plan, {1.0, 1.45}), 0.02);
  EXPECT_GT(distance(*plan, {1.0, 0.0}), 1.0);
  EXPECT_EQ(plan->covered, 1.0);
  EXPECT_EQ(plan->supported, 1.0);

  const auto map = clean(soup_of(*plan, 2.5), 1e-4, 0.02);
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->surfaces.size(), 8U);
  for (const auto& vertex : map->vertices) EXPECT_TRUE(vertex.z() == 0.0F || vertex.z() == 2.5F);
}

TEST(Occupancy, AThinWallIsOneSheet) {
  OccupancyGrid grid = grid_of(60, 20);
  for (int column = 10; column < 50; ++column) occupy(grid, column, 10);
  const auto plan = walls_of(grid, WallParameters{});
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->walls.size(), 1U);
  EXPECT_NEAR(plan->length_m, 2.0, 0.05);
}

TEST(Occupancy, ARaggedWallIsStraightWithinTheTolerance) {
  OccupancyGrid grid = grid_of(120, 40);
  for (int column = 10; column < 110; ++column) {
    for (int row = 20 + (column * 7 % 5 == 0 ? 1 : 0); row < 30; ++row) occupy(grid, column, row);
  }
  WallParameters parameters;
  parameters.tolerance_m = 0.1;
  const auto plan = walls_of(grid, parameters);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->walls.size(), 4U);
  EXPECT_EQ(plan->covered, 1.0);
  parameters.tolerance_m = 0.01;
  EXPECT_GT(walls_of(grid, parameters)->walls.size(), 40U);
}

TEST(Occupancy, OriginAndYawTurnTheWholeGrid) {
  OccupancyGrid grid = grid_of(60, 20);
  for (int column = 0; column < 40; ++column) occupy(grid, column, 19);  // along the grid's x axis
  grid.p_WO = {2.0, 1.0};
  grid.yaw_rad = std::numbers::pi / 2.0;
  const auto plan = walls_of(grid, WallParameters{});
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_LT(distance(*plan, {1.975, 1.5}), 0.03);
  EXPECT_LT(distance(*plan, {1.975, 2.9}), 0.03);
}

TEST(Occupancy, WhatIsLeftOutShowsInTheShares) {
  OccupancyGrid grid = grid_of(100, 60);
  for (int column = 10; column < 50; ++column) occupy(grid, column, 10);
  for (int i = 0; i < 10; ++i) occupy(grid, 10 + 5 * i, 40);  // specks of one cell, far from the wall
  const auto plan = walls_of(grid, WallParameters{});
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->walls.size(), 1U);
  EXPECT_NEAR(plan->covered, 40.0 / 50.0, 0.01);
}

TEST(OccupancyFault, WithoutAWallItSaysSo) {
  OccupancyGrid grid = grid_of(30, 30);
  EXPECT_THAT(walls_of(grid, WallParameters{}).error().message, testing::HasSubstr("no wall: 0 of 30 x 30 cells"));
  occupy(grid, 5, 5);
  EXPECT_THAT(walls_of(grid, WallParameters{}).error().message, testing::HasSubstr("no wall: 1 of 30 x 30 cells"));
}

}  // namespace
}  // namespace cgsr::world
