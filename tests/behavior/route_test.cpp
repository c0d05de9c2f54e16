#include "pipeline/behavior/route.h"

#include <cmath>

#include <gtest/gtest.h>

namespace cgsr::behavior {
namespace {

constexpr Duration kImagePeriod = seconds(1.0 / 30.0);

std::vector<Place> square() {
  return parse_places("1, 0; 1, 1; 0, 1; 0, 0").value();
}

TEST(Route, ReadsItsPlaces) {
  const auto places = parse_places(" 1.5, -2 ;3,4.25; ");
  ASSERT_TRUE(places);
  ASSERT_EQ(places->size(), 2U);
  EXPECT_EQ((*places)[0].y_m, -2.0);
  EXPECT_EQ((*places)[1].x_m, 3.0);
  EXPECT_TRUE(parse_places("")->empty());
}

TEST(RouteFault, SaysWhichPlaceIsWrong) {
  for (const char* text : {"1,2; 3", "1,2; x,4", "1,2; nan,4", "1,2; 1e9,4", "1,2; 3,4,5", "1,2;; 3,4"}) {
    const auto places = parse_places(text);
    ASSERT_FALSE(places) << text;
    EXPECT_NE(places.error().message.find("place 2"), std::string::npos) << places.error().message;
  }
}

TEST(Route, DrivesItsRoundAndComesPastEveryPlace) {
  RouteParameters parameters;
  Route route(parameters, square());
  PlanarPose here{true, 0.0, 0.0, 0.0};
  int laps = 0;
  int last = 0;
  for (int image = 0; image < 30 * 60; ++image) {
    const auto decision = route.decide(here, kImagePeriod);
    ASSERT_EQ(decision.state, RouteState::kDriving);
    ASSERT_LE(decision.goal.forward_mps, parameters.forward_mps);
    laps += decision.place == 0 && last == 3 ? 1 : 0;
    last = decision.place;
    const double step_s = to_seconds(kImagePeriod);
    here.heading_rad += decision.goal.left_radps * step_s;
    here.x_m += decision.goal.forward_mps * step_s * std::cos(here.heading_rad);
    here.y_m += decision.goal.forward_mps * step_s * std::sin(here.heading_rad);
    ASSERT_LT(std::abs(here.x_m - 0.5), 0.8);
    ASSERT_LT(std::abs(here.y_m - 0.5), 0.8);
  }
  EXPECT_GE(laps, 1);
}

TEST(Route, EndsAtTheLastPlaceWhenItIsNoRound) {
  RouteParameters parameters;
  parameters.round = false;
  Route route(parameters, parse_places("0.05, 0").value());
  const auto decision = route.decide({true, 0.0, 0.0, 0.0}, kImagePeriod);
  EXPECT_EQ(decision.state, RouteState::kArrived);
  EXPECT_EQ(decision.goal.forward_mps, 0.0);
}

TEST(Route, KeepsTheLimitsOfTheRobotWhereTheyAreTighterThanItsOwnSpeed) {
  DriveLimits limits;
  limits.max_forward_mps = 0.1;
  limits.max_turn_radps = 0.2;
  limits.max_acceleration_mps2 = 0.05;
  RouteParameters parameters;
  parameters.forward_mps = 0.5;
  Route ahead(parameters, parse_places("5, 0").value(), limits);
  const PlanarPose here{true, 0.0, 0.0, 0.0};
  EXPECT_NEAR(ahead.decide(here, kImagePeriod).goal.forward_mps, 0.05 * to_seconds(kImagePeriod), 1e-12);
  RouteDecision decision;
  for (int i = 0; i < 150; ++i) decision = ahead.decide(here, kImagePeriod);
  EXPECT_DOUBLE_EQ(decision.goal.forward_mps, 0.1);
  Route beside(parameters, parse_places("0, 5").value(), limits);
  for (int i = 0; i < 150; ++i) decision = beside.decide(here, kImagePeriod);
  EXPECT_DOUBLE_EQ(decision.goal.left_radps, 0.2);
}

TEST(RouteFault, WithoutAPoseItHalts) {
  Route route({}, square());
  PlanarPose here{true, 0.0, 0.0, 0.0};
  for (int i = 0; i < 30; ++i) route.decide(here, kImagePeriod);
  here.known = false;
  const auto decision = route.decide(here, kImagePeriod);
  EXPECT_TRUE(decision.halt);
  EXPECT_EQ(decision.state, RouteState::kNowhere);
  EXPECT_EQ(decision.goal.forward_mps, 0.0);
  EXPECT_EQ(decision.goal.left_radps, 0.0);
}

}  // namespace
}  // namespace cgsr::behavior
