#include "pipeline/global_localization/place_index.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/global_localization/candidates.h"
#include "pipeline/runtime/stage_budget.h"
#include "tests/localization/small_room.h"

namespace cgsr::global_localization {
namespace {

using localization::testing::in_small_room;
using localization::testing::small_room;

constexpr double kSpacing_m = GlobalLocalizerParameters{}.spacing_m;

class PlacesOfASmallRoom : public ::testing::Test {
 protected:
  PlacesOfASmallRoom()
      : map_(small_room()), camera_(geometry::Camera{}.scaled_to(320, 240)), X_RC_(in_small_room(0.0, 0.0, 0.0)) {}

  [[nodiscard]] PlaceIndex index() const {
    const auto may_stand = [](double x_m, double y_m) { return x_m > 0.4 && x_m < 3.4 && y_m > 0.4 && y_m < 3.6; };
    return {map_, camera_, X_RC_, grid_of_places(map_, kSpacing_m, may_stand), kSpacing_m};
  }

  static double distance_m(const PlaceIndex& index, std::size_t a, std::size_t b) {
    return (index.place_m(a) - index.place_m(b)).norm();
  }

  world::Map map_;
  geometry::Camera camera_;
  geometry::Pose X_RC_;
  UnlimitedBudget whole_;
};

TEST_F(PlacesOfASmallRoom, EveryOtherOneComesFirst) {
  const PlaceIndex places = index();
  ASSERT_LT(places.apart(), 0.6 * static_cast<double>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    double nearest_m = 10.0;
    for (std::size_t j = 0; j < places.apart(); ++j) {
      if (i != j) nearest_m = std::min(nearest_m, distance_m(places, i, j));
    }
    if (i < places.apart()) {
      EXPECT_GT(nearest_m, 1.1 * kSpacing_m) << i;
    } else {
      EXPECT_LT(nearest_m, 1.1 * kSpacing_m) << i;
    }
  }
}

TEST_F(PlacesOfASmallRoom, AreTheSameInWhicheverOrderTheyAreBuilt) {
  PlaceIndex in_order = index();
  ASSERT_TRUE(in_order.build(whole_));
  PlaceIndex one = index();
  const std::size_t last = one.size() - 1;
  ASSERT_TRUE(one.build(last, whole_));
  EXPECT_TRUE(one.holds(last));
  EXPECT_FALSE(one.holds(0));
  EXPECT_EQ(one.panorama(last).compare(in_order.panorama(last)),
            in_order.panorama(last).compare(in_order.panorama(last)));
  ASSERT_TRUE(one.build(whole_));
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_TRUE(one.holds(i)) << i;
}

// The turn of a large home ends before all of it is built: the robot is found at a place between those that are.
TEST_F(PlacesOfASmallRoom, BetweenThoseApartAreFoundAsWell) {
  PlaceIndex all = index();
  ASSERT_TRUE(all.build(whole_));
  for (std::size_t at = all.apart(); at < all.size(); at += 5) {
    PlaceIndex few = index();
    CandidateSearch search(few, {});
    ASSERT_TRUE(search.go_on(all.panorama(at), whole_));
    const Candidate& best = search.candidates().front();
    EXPECT_LT((best.X_WR.translation().head<2>() - all.place_m(at)).norm(), 0.2 * kSpacing_m) << at;
    EXPECT_NEAR(best.likeness, 1.0, 1e-3) << at;
    for (std::size_t i = 1; i < search.candidates().size(); ++i) {
      EXPECT_FALSE(are_near(search.candidates()[i].X_WR, best.X_WR, kSpacing_m, 0.17)) << at << ": one place twice";
    }
  }
}

TEST_F(PlacesOfASmallRoom, FarFromTheMostAlikeOnesAreNotBuilt) {
  PlaceIndex all = index();
  ASSERT_TRUE(all.build(whole_));
  PlaceIndex few = index();
  CandidateSearch search(few, {.max_candidates = 1});
  ASSERT_TRUE(search.go_on(all.panorama(all.apart()), whole_));
  std::size_t held = 0;
  for (std::size_t i = 0; i < few.size(); ++i) held += few.holds(i) ? 1 : 0;
  EXPECT_GT(held, few.apart());
  EXPECT_LE(held, few.apart() + 5);
}

// As much in each image as its units allow, and begun anew in the middle: the same candidates.
TEST_F(PlacesOfASmallRoom, AreComparedInPieces) {
  PlaceIndex all = index();
  ASSERT_TRUE(all.build(whole_));
  const Panorama& seen = all.panorama(all.apart() + 3);
  PlaceIndex at_once = index();
  CandidateSearch expected(at_once, {});
  ASSERT_TRUE(expected.go_on(seen, whole_));
  for (const int calls_before_restart : {0, 20, 60}) {
    PlaceIndex few = index();
    CandidateSearch search(few, {});
    const auto go_on = [&] {
      auto budget = runtime::StageBudget::of_units(7);
      return search.go_on(seen, budget);
    };
    for (int i = 0; i < calls_before_restart; ++i) go_on();
    if (calls_before_restart > 0) search.restart();
    int calls = 1;
    while (!go_on() && calls < 1000) ++calls;
    EXPECT_GT(calls, calls_before_restart > 0 ? 5 : 20);
    ASSERT_EQ(search.candidates().size(), expected.candidates().size()) << calls_before_restart;
    EXPECT_TRUE(search.candidates().front().X_WR.isApprox(expected.candidates().front().X_WR)) << calls_before_restart;
  }
}

}  // namespace
}  // namespace cgsr::global_localization
