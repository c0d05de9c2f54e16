#include "pipeline/behavior/look_along.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace cgsr::behavior {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFirst_rad = 2.0;  // the robot's first heading
constexpr Duration kImage = seconds(1.0 / 30.0);

/// Somebody who stands at a bearing and is taken for these people in turn.
struct Stander {
  double bearing_deg;
  std::vector<int> taken_for;
  double confidence = 0.9;
};

/// Runs the behaviour before a line of people, with a camera that sees 25 degrees to either side.
class Line {
 public:
  explicit Line(std::vector<Stander> people, const LookAlongParameters& parameters = {})
      : people_(std::move(people)), look_(parameters, DriveLimits{}) {}

  std::vector<LookAlongDecision> run(double longest_s = 120.0) {
    std::vector<LookAlongDecision> told;
    for (int image = 0; image * to_seconds(kImage) < longest_s; ++image) {
      std::vector<FaceAtBearing> faces;
      for (const Stander& one : people_) {
        const double bearing = one.bearing_deg * kDegree - heading_rad_;
        if (std::abs(bearing) > 25.0 * kDegree) continue;
        const bool compared = !one.taken_for.empty();
        const int number = compared ? one.taken_for[static_cast<std::size_t>(image) % one.taken_for.size()] : 0;
        faces.push_back({bearing, compared, number, one.confidence});
      }
      const bool moves = image >= images_until_it_moves_;
      const auto heading = image % 50 == 49 ? std::nullopt : std::optional(kFirst_rad + heading_rad_);
      const LookAlongDecision decision = look_.decide(faces, heading, kImage);
      if (moves) heading_rad_ += slip_ * decision.goal.left_radps * to_seconds(kImage);
      most_left_rad_ = std::max(most_left_rad_, heading_rad_);
      if (decision.told) told.push_back(decision);
      if (decision.state == LookAlongState::kDone) {
        done_ = true;
        break;
      }
    }
    return told;
  }
  /// The base moves only from some image on, and by less than it is commanded.
  void hold_back(int images, double slip) {
    images_until_it_moves_ = images;
    slip_ = slip;
  }
  [[nodiscard]] bool done() const { return done_; }
  [[nodiscard]] double heading_deg() const { return heading_rad_ / kDegree; }
  [[nodiscard]] double most_left_deg() const { return most_left_rad_ / kDegree; }

 private:
  std::vector<Stander> people_;
  LookAlong look_;
  double heading_rad_ = 0.0, most_left_rad_ = 0.0;
  int images_until_it_moves_ = 0;
  double slip_ = 1.0;
  bool done_ = false;
};

TEST(LookAlong, TellsWhoStandsWhereFromLeftToRight) {
  Line line({{40, {3}}, {21, {1}}, {0, {0}}, {-21, {4}}, {-40, {2}}});
  const auto told = line.run();
  ASSERT_TRUE(line.done());
  ASSERT_EQ(told.size(), 5U);
  const int expected[] = {3, 1, 0, 4, 2};
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(told[i].told->number, expected[i]) << i;
    EXPECT_EQ(told[i].place, static_cast<int>(i) + 1);
  }
  EXPECT_NEAR(told[0].told->bearing_rad / kDegree, 40.0, 2.0);
}

TEST(LookAlong, GoesByWhatTheRobotTurnedNotByWhatItWasToTurn) {
  Line line({{40, {3}}, {0, {1}}, {-40, {2}}});
  line.hold_back(60, 0.6);
  const auto told = line.run();
  ASSERT_EQ(told.size(), 3U);
  EXPECT_NEAR(told[0].told->bearing_rad / kDegree, 40.0, 2.0);
  EXPECT_NEAR(told[2].told->bearing_rad / kDegree, -40.0, 2.0);
}

TEST(LookAlong, TurnsToBothEndsAndEndsWhereNobodyStands) {
  Line line(std::vector<Stander>{});
  EXPECT_TRUE(line.run().empty());
  EXPECT_TRUE(line.done());
  EXPECT_GT(line.most_left_deg(), 45.0);
  EXPECT_LT(line.heading_deg(), -45.0);
}

TEST(LookAlong, BelievesTheNameThatComesMostOften) {
  Line line({{10, {2, 2, 5, 2}}});
  const auto told = line.run();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].told->number, 2);
  EXPECT_NEAR(told[0].told->confidence, 0.75 * 0.9, 0.03);
}

// In a line everybody is once: a stranger who looks like somebody stands beside that person.
TEST(LookAlong, CallsTheLessSureOfTwoOfOneNameAStranger) {
  for (const bool left_is_surer : {false, true}) {
    Line line({{20, {1}, left_is_surer ? 0.9 : 0.7}, {-20, {1}, left_is_surer ? 0.7 : 0.9}});
    const auto told = line.run();
    ASSERT_EQ(told.size(), 2U);
    EXPECT_EQ(told[0].told->number, left_is_surer ? 1 : 0);
    EXPECT_EQ(told[1].told->number, left_is_surer ? 0 : 1);
  }
}

TEST(LookAlong, DoesNotWaitForEverForAFaceThatIsNotNamed) {
  Line line(std::vector<Stander>{{10, {}}, {-20, {6}}});
  const auto told = line.run();
  ASSERT_TRUE(line.done());
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].told->number, 6);
}

TEST(LookAlong, NoticesSixteenPeopleAndIgnoresMore) {
  constexpr int kCrowd = 20;
  std::vector<Stander> crowd;
  crowd.reserve(kCrowd);
  for (int i = 0; i < kCrowd; ++i) crowd.push_back({80.0 - 8.0 * i, {i + 1}});
  LookAlongParameters wide;
  wide.reach_deg = 90.0;
  Line line(crowd, wide);
  EXPECT_EQ(line.run(600.0).size(), LookAlong::kMaxPeople);
  EXPECT_TRUE(line.done());
}

}  // namespace
}  // namespace cgsr::behavior
