#include "pipeline/behavior/search_people.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/behavior/lookouts.h"
#include "pipeline/world/load.h"
#include "tests/behavior/two_rooms.h"

namespace cgsr::behavior {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr Duration kImage = seconds(1.0 / 30.0);

/// Somebody who stands in the home and is taken for these people in turn.
struct Stander {
  Place place;
  std::vector<int> taken_for;
  double confidence = 0.9;
};

/// A robot that does as it is told, with a camera that sees faces within 25 degrees to either side, from 0.7 m to 2.5 m, and not through walls.
class Home {
 public:
  Home(const world::Map& map, Place start, std::vector<Stander> people, const SearchPeopleParameters& parameters = {})
      : floor_(map, parameters.floor),
        air_(map, {0.0, 1.2, 1.7, 0.05}),
        people_(std::move(people)),
        here_{true, start.x_m, start.y_m, 0.0} {
    LookoutPlan plan = plan_lookouts(map, start, {});
    lookouts_ = plan.lookouts.size();
    search_.emplace(parameters, floor_, std::move(plan.lookouts), DriveLimits{0.5, 0.0, 0.4, 0.6, 0.6, 1.5});
  }

  void run(double longest_s) {
    for (int image = 0; image * to_seconds(kImage) < longest_s; ++image) {
      here_.known = image < unknown_from_ || image >= unknown_to_;
      const SearchPeopleDecision decision = search_->decide(here_, faces(image), kImage);
      move(decision.goal);
      off_floor_ += floor_.is_free(here_.x_m, here_.y_m) ? 0 : 1;
      if (!here_.known)
        moved_blind_ = moved_blind_ || decision.goal.forward_mps != 0.0 || decision.goal.left_radps != 0.0;
      drove_blind_ = drove_blind_ || (!here_.known && decision.goal.forward_mps != 0.0);
      if (decision.told) (decision.told->in_the_end ? in_the_end_ : named_).push_back(*decision.told);
      if (decision.state != SearchPeopleState::kDone) continue;
      took_s_ = image * to_seconds(kImage);
      return;
    }
  }

  void lose_pose(int from_image, int to_image) {
    unknown_from_ = from_image;
    unknown_to_ = to_image;
  }

  /// \return who was told of at that place in the end; -1: nobody.
  [[nodiscard]] int told_at(const Place& place) const {
    for (const PersonTold& told : in_the_end_) {
      if (distance_m(told.place, place) < 0.5) return told.number;
    }
    return -1;
  }
  [[nodiscard]] const std::vector<PersonTold>& named() const { return named_; }
  [[nodiscard]] const std::vector<PersonTold>& in_the_end() const { return in_the_end_; }
  [[nodiscard]] std::optional<double> took_s() const { return took_s_; }
  [[nodiscard]] int images_off_the_floor() const { return off_floor_; }
  [[nodiscard]] bool moved_blind() const { return moved_blind_; }
  [[nodiscard]] bool drove_blind() const { return drove_blind_; }
  [[nodiscard]] std::size_t lookouts() const { return lookouts_; }

 private:
  std::vector<FaceInMap> faces(int image) const {
    std::vector<FaceInMap> faces;
    for (const Stander& one : people_) {
      const double way_m = distance_m({here_.x_m, here_.y_m}, one.place);
      const double heading = std::atan2(one.place.y_m - here_.y_m, one.place.x_m - here_.x_m);
      if (way_m < 0.7 || way_m > 2.5 ||
          std::abs(std::remainder(heading - here_.heading_rad, 360.0 * kDegree)) > 25.0 * kDegree)
        continue;
      if (air_.way_m(here_.x_m, here_.y_m, heading, way_m) < way_m) continue;
      const double wrong = image % 2 == 0 ? 1.06 : 0.96;  // the width of a face says how far it is only roughly
      const Place seen{here_.x_m + wrong * way_m * std::cos(heading), here_.y_m + wrong * way_m * std::sin(heading)};
      const bool compared = !one.taken_for.empty();
      const int number = compared ? one.taken_for[static_cast<std::size_t>(image) % one.taken_for.size()] : 0;
      faces.push_back({seen, compared, number, one.confidence});
    }
    return faces;
  }

  void move(const Velocity& goal) {
    const double step_s = to_seconds(kImage);
    here_.x_m += step_s * goal.forward_mps * std::cos(here_.heading_rad);
    here_.y_m += step_s * goal.forward_mps * std::sin(here_.heading_rad);
    here_.heading_rad += step_s * goal.left_radps;
  }

  FreeFloor floor_;
  FreeFloor air_;
  std::vector<Stander> people_;
  PlanarPose here_;
  std::optional<SearchPeople> search_;
  std::size_t lookouts_ = 0;
  std::vector<PersonTold> named_, in_the_end_;
  std::optional<double> took_s_;
  int off_floor_ = 0;
  bool moved_blind_ = false, drove_blind_ = false;
  int unknown_from_ = -1, unknown_to_ = -1;
};

constexpr Place kStart{0.8, 0.8};
constexpr Place kCorner{3.3, 0.6}, kBehindTheTable{1.0, 4.2}, kNextDoor{6.8, 1.0};

TEST(SearchPeople, FindsEverybodyInBothRoomsAndTellsWhoStandsWhere) {
  Home home(test::two_rooms(), kStart, {{kCorner, {1}}, {kBehindTheTable, {0}}, {kNextDoor, {2}}});
  home.run(300.0);
  ASSERT_TRUE(home.took_s());
  EXPECT_EQ(home.named().size(), 3U) << "each once when named";
  ASSERT_EQ(home.in_the_end().size(), 3U);
  EXPECT_EQ(home.told_at(kCorner), 1);
  EXPECT_EQ(home.told_at(kBehindTheTable), 0);
  EXPECT_EQ(home.told_at(kNextDoor), 2);
  EXPECT_LT(home.images_off_the_floor(), 15) << "corners may be cut by a hand's breadth";
}

TEST(SearchPeople, BelievesTheNameThatComesMostOften) {
  Home home(test::two_rooms(), kStart, {{kCorner, {2, 2, 5, 2}}});
  home.run(300.0);
  ASSERT_EQ(home.named().size(), 1U);
  EXPECT_EQ(home.named()[0].number, 2);
  EXPECT_NEAR(home.named()[0].confidence, 0.75 * 0.9, 0.05);
}

TEST(SearchPeople, CallsTheLessSureOfTwoOfOneNameAStrangerInTheEnd) {
  Home home(test::two_rooms(), kStart, {{kCorner, {1}, 0.7}, {kNextDoor, {1}, 0.9}});
  home.run(300.0);
  EXPECT_EQ(home.told_at(kCorner), 0);
  EXPECT_EQ(home.told_at(kNextDoor), 1);
}

TEST(SearchPeople, GoesOnFromAFaceThatIsNotNamed) {
  Home home(test::two_rooms(), kStart, {{kCorner, {}}, {kNextDoor, {3}}});
  home.run(300.0);
  ASSERT_TRUE(home.took_s());
  EXPECT_EQ(home.told_at(kCorner), -1);
  EXPECT_EQ(home.told_at(kNextDoor), 3);
}

TEST(SearchPeople, TellsWhomItHasFoundWhenTimeIsUp) {
  SearchPeopleParameters hurried;
  hurried.max_duration_s = 40.0;
  Home home(test::two_rooms(), kStart, {{{2.4, 0.8}, {4}}, {kNextDoor, {2}}}, hurried);
  home.run(300.0);
  ASSERT_TRUE(home.took_s());
  EXPECT_NEAR(*home.took_s(), 40.0, 0.5);
  EXPECT_EQ(home.told_at({2.4, 0.8}), 4);
  EXPECT_EQ(home.told_at(kNextDoor), -1);
}

TEST(SearchPeople, StandsWhileItDoesNotKnowWhereItIsAndGoesOnAfterwards) {
  Home home(test::two_rooms(), kStart, {{kNextDoor, {2}}});
  home.lose_pose(600, 720);
  home.run(300.0);
  EXPECT_FALSE(home.moved_blind());
  EXPECT_EQ(home.told_at(kNextDoor), 2);
}

// A bare wall says nothing of where the robot is: on the spot it may turn to another one, and it goes nowhere.
TEST(SearchPeople, TurnsOnTheSpotWhenThePoseStaysUnknown) {
  Home home(test::two_rooms(), kStart, {{kNextDoor, {2}}});
  home.lose_pose(600, 900);
  home.run(300.0);
  EXPECT_TRUE(home.moved_blind());
  EXPECT_FALSE(home.drove_blind());
  EXPECT_EQ(home.told_at(kNextDoor), 2);
}

TEST(SearchPeople, EndsInAnEmptyHomeWithNobodyToTellOf) {
  Home home(test::two_rooms(), kStart, {});
  home.run(300.0);
  EXPECT_TRUE(home.took_s());
  EXPECT_TRUE(home.in_the_end().empty());
}

// The shipped home: five people in its two rooms within the five minutes that the task has.
TEST(SearchPeople, GoesThroughTheSimulatedHomeInTime) {
  const auto map = world::load_map(CGSR_SOURCE_DIR "/config/maps/home/map.obj");
  ASSERT_TRUE(map) << map.error().message;
  const std::vector<Stander> people{
      {{1.6, 5.6}, {1}}, {{4.6, 1.2}, {2}}, {{7.9, 1.7}, {3}}, {{5.9, 5.2}, {4}}, {{11.6, 5.2}, {0}}};
  Home home(*map, {1.2, 3.2}, people);
  home.run(320.0);
  ASSERT_TRUE(home.took_s());
  EXPECT_LT(*home.took_s(), 290.0) << home.lookouts() << " lookouts";
  for (const Stander& one : people) EXPECT_EQ(home.told_at(one.place), one.taken_for[0]) << one.place.x_m;
}

}  // namespace
}  // namespace cgsr::behavior
