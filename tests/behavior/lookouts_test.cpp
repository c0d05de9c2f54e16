#include "pipeline/behavior/lookouts.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/behavior/floor_way.h"
#include "tests/behavior/two_rooms.h"

namespace cgsr::behavior {
namespace {

using test::two_rooms;

constexpr Place kStart{0.8, 0.8};

void finish(FloorWay& way) {
  while (!way.advance(500)) {
  }
}

TEST(FloorWay, LeadsThroughTheDoorAndNotThroughTheWall) {
  const FreeFloor floor(two_rooms(), {});
  FloorWay way(floor);
  ASSERT_TRUE(way.begin({5.0, 1.0}));
  finish(way);
  // Along the door's middle, 4.3 m up: at least from (3, 1) to (4, 4.2) and on to (5, 1).
  EXPECT_GT(way.way_m({3.0, 1.0}), 6.3);
  EXPECT_LT(way.way_m({3.0, 1.0}), 8.0);
  EXPECT_NEAR(way.way_m({5.0, 1.0}), 0.0, 0.15) << "a cell's diagonal";
}

TEST(FloorWay, IsFollowedOverFreeFloorToTheGoal) {
  const FreeFloor floor(two_rooms(), {});
  FloorWay way(floor);
  ASSERT_TRUE(way.begin({7.0, 1.0}));
  finish(way);
  Place here = kStart;
  int steps = 0, off_floor = 0;
  for (; way.way_m(here) > 0.2 && steps < 400; ++steps) {
    const auto ahead = way.ahead(here, 0.9);
    ASSERT_TRUE(ahead);
    const double off_m = std::max(1e-9, distance_m(here, *ahead));
    here.x_m += 0.05 / off_m * (ahead->x_m - here.x_m);
    here.y_m += 0.05 / off_m * (ahead->y_m - here.y_m);
    off_floor += floor.is_free(here.x_m, here.y_m) ? 0 : 1;
  }
  EXPECT_LT(steps, 400);
  EXPECT_LT(off_floor, 20) << "corners may be cut by less than a cell";
  EXPECT_LT(distance_m(here, {7.0, 1.0}), 0.3);
}

TEST(FloorWay, SaysWhereThereIsNone) {
  FloorWay way(FreeFloor(two_rooms(false), {}));
  ASSERT_TRUE(way.begin({7.0, 1.0}));
  finish(way);
  EXPECT_EQ(way.way_m(kStart), FloorWay::kInfinite_m);
  EXPECT_FALSE(way.ahead(kStart, 0.9));
  EXPECT_FALSE(way.begin({20.0, 1.0}));
  EXPECT_FALSE(FloorWay(FreeFloor(world::Map{}, {})).begin(kStart));
}

TEST(FloorWay, KeepsFromSomebodyWhoStandsThere) {
  FloorWay way(FreeFloor(two_rooms(), {}));
  way.block({4.0, 4.3}, 0.55);  // in the door
  ASSERT_TRUE(way.begin({7.0, 1.0}));
  finish(way);
  EXPECT_EQ(way.way_m(kStart), FloorWay::kInfinite_m);
}

// Whatever the two places: the way is as long there as back, and no shorter than the straight line.
TEST(FloorWayProperty, IsAsLongThereAsBack) {
  const FreeFloor floor(two_rooms(), {});
  FloorWay there(floor), back(floor);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(0.0, 8.0), y(0.0, 5.0);
  for (int trial = 0; trial < 40;) {
    const Place a{x(random), y(random)}, b{x(random), y(random)};
    if (!floor.is_free(a.x_m, a.y_m) || !floor.is_free(b.x_m, b.y_m)) continue;
    ++trial;
    ASSERT_TRUE(there.begin(b) && back.begin(a));
    finish(there);
    finish(back);
    EXPECT_NEAR(there.way_m(a), back.way_m(b), 0.3);
    EXPECT_GT(there.way_m(a), distance_m(a, b) - 0.3);
  }
}

TEST(Lookouts, SeeTheWholeFreeFloorOfBothRoomsFromReachablePlaces) {
  const world::Map map = two_rooms();
  const FreeFloor floor(map, {});
  const LookoutPlan plan = plan_lookouts(map, kStart, {});
  EXPECT_GE(plan.seen_share, 0.97);
  EXPECT_GE(plan.lookouts.size(), 4U) << "two in each room: none is 2.5 m from everything";
  EXPECT_LE(plan.lookouts.size(), 9U);
  for (const Place& place : plan.lookouts) EXPECT_TRUE(floor.is_free(place.x_m, place.y_m));
  // Every place where somebody may stand, seen with the planner's distances and not through the wall at x = 4.
  int all = 0, seen = 0;
  for (double x = 0.4; x < 7.7; x += 0.2) {
    for (double y = 0.4; y < 4.7; y += 0.2) {
      if (!floor.is_free(x, y)) continue;
      ++all;
      seen += std::ranges::any_of(plan.lookouts, [&](const Place& from) {
        const double away_m = distance_m(from, {x, y});
        const bool one_room = (from.x_m < 4.0) == (x < 4.0);
        return one_room && away_m > 0.6 && away_m < 2.6;
      });
    }
  }
  EXPECT_GT(seen, 0.93 * all);
}

TEST(Lookouts, OfOneRoomAreVisitedBeforeTheOther) {
  const LookoutPlan plan = plan_lookouts(two_rooms(), kStart, {});
  int changes = 0;
  for (std::size_t i = 1; i < plan.lookouts.size(); ++i)
    changes += (plan.lookouts[i - 1].x_m < 4.0) != (plan.lookouts[i].x_m < 4.0) ? 1 : 0;
  EXPECT_EQ(changes, 1);
  EXPECT_LT(plan.lookouts.front().x_m, 4.0);
}

TEST(Lookouts, LeaveOutWhatTheRobotDoesNotReach) {
  for (const Place& place : plan_lookouts(two_rooms(false), kStart, {}).lookouts) EXPECT_LT(place.x_m, 4.0);
  EXPECT_TRUE(plan_lookouts(two_rooms(), {20.0, 20.0}, {}).lookouts.empty());
  EXPECT_TRUE(plan_lookouts(world::Map{}, kStart, {}).lookouts.empty());
}

}  // namespace
}  // namespace cgsr::behavior
