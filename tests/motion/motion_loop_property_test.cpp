#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/motion/motion_loop.h"
#include "tests/motion/rig.h"

namespace cgsr {
namespace {

/// The rules of docs/faults.md written down a second time, from what the test itself did to the loop: may it move now?
class Shadow {
 public:
  struct Told {
    Duration since_last{};
    bool goal_came = false;
    bool goal_good = true;
    Duration feedback_age{};
    bool feedback_good = true;
    bool sends = true;
    bool images_in_time = true;
    bool safety_chain_ok = true;
    bool stop = false;
    ArmRequest request = ArmRequest::kNone;
  };

  bool may_move(const Told& told, MonoTime now) {
    beats_in_time_ = told.since_last > Duration::zero() && told.since_last <= seconds(0.020) ? beats_in_time_ + 1 : 0;
    if (told.goal_came) newest_goal_ = told.goal_good ? std::optional(now - seconds(0.033)) : std::nullopt;

    const bool disarming = told.stop || !told.safety_chain_ok || !told.feedback_good || sending_failed_ ||
                           told.feedback_age > seconds(0.100) || (told.goal_came && !told.goal_good);
    const bool holding = !told.images_in_time || !newest_goal_ || now - *newest_goal_ > seconds(0.150);
    const bool stopped = disarming || holding;

    if (!armed || !stopped) held_since_.reset();
    if (armed && stopped && !held_since_) held_since_ = now;
    if (disarming || (held_since_ && now - *held_since_ > seconds(2.0))) armed = false;
    if (told.request == ArmRequest::kDisarm) armed = false;
    if (told.request == ArmRequest::kArm && !stopped && beats_in_time_ >= 100) armed = true;
    if (!armed) held_since_.reset();

    const bool moves = armed && !stopped;
    sending_failed_ = !told.sends;
    if (sending_failed_) armed = false;
    return moves && told.sends;
  }

  bool armed = false;

 private:
  std::optional<MonoTime> newest_goal_;
  std::optional<MonoTime> held_since_;
  int beats_in_time_ = 0;
  bool sending_failed_ = false;
};

/// A trouble that comes once in a while and stays for some steps.
class Episode {
 public:
  Episode(double per_step, int longest) : per_step_(per_step), longest_(longest) {}
  bool next(std::mt19937_64& random) {
    if (left_ > 0) return --left_ > 0;
    if (std::uniform_real_distribution(0.0, 1.0)(random) < per_step_) {
      left_ = std::uniform_int_distribution(1, longest_)(random);
    }
    return left_ > 0;
  }

 private:
  double per_step_;
  int longest_;
  int left_ = 0;
};

struct Chance {
  std::mt19937_64 random;
  explicit Chance(std::uint64_t seed) : random(seed) {}
  double draw(double from, double to) { return std::uniform_real_distribution(from, to)(random); }
  bool once_in(int steps) { return std::uniform_int_distribution(1, steps)(random) == 1; }
};

MotionParameters draw_parameters(Chance& chance) {
  MotionParameters limits;
  limits.max_forward_mps = chance.draw(0.2, 1.0);
  limits.max_backward_mps = chance.draw(-0.2, 0.2);
  limits.max_backward_mps = std::max(0.0, limits.max_backward_mps);
  limits.max_acceleration_mps2 = chance.draw(0.2, 2.0);
  limits.max_deceleration_mps2 = chance.draw(0.2, 2.0);
  limits.max_turn_radps = chance.draw(0.3, 2.0);
  limits.max_turn_acceleration_radps2 = chance.draw(0.5, 5.0);
  limits.reaction_s = chance.draw(0.08, 0.3);  // covers the latest cycle of this test
  limits.keep_in.min_x_m = limits.keep_in.min_y_m = -1.0;
  limits.keep_in.max_x_m = limits.keep_in.max_y_m = 1.0;
  return limits;
}

/// What the limits say about one command after the other.
void expect_within_limits(const MotionStatus& status, const hal::Twist& before, Duration since_last,
                          const MotionParameters& limits) {
  constexpr double kSlack = 1e-9;
  const double elapsed_s = std::min(to_seconds(since_last), 0.020);
  const auto& [forward, turn] = status.commanded;
  ASSERT_LE(forward, limits.max_forward_mps);
  ASSERT_GE(forward, -limits.max_backward_mps);
  ASSERT_LE(std::abs(turn), limits.max_turn_radps);
  if (is_zero(status.commanded)) return;  // a stop is immediate
  const double gain = std::abs(forward) - std::abs(before.forward_mps);
  ASSERT_LE(gain, limits.max_acceleration_mps2 * elapsed_s + kSlack);
  if (!status.keep_in_slowed) {
    ASSERT_GE(gain, -limits.max_deceleration_mps2 * elapsed_s - kSlack);
  }
  ASSERT_GE(forward * before.forward_mps, 0.0) << "never through zero in one step";
  ASSERT_LE(std::abs(turn - before.left_radps), limits.max_turn_acceleration_radps2 * elapsed_s + kSlack);
}

struct Tally {
  int moving = 0;
  int armed = 0;
  int slowed = 0;
};

/// `steps` control cycles of random goals and random trouble against the shadow.
Tally run(std::uint64_t seed, int steps) {
  Chance chance(seed);
  Rig rig(draw_parameters(chance));
  Shadow shadow;
  Tally tally;
  Episode no_goals(0.01, 60), frozen(0.002, 30), deaf(0.001, 10), unsent(0.001, 5), images(0.003, 300),
      fault(0.001, 20);
  MonoTime measured = rig.now;
  hal::Twist before;

  for (int step = 0; step < steps; ++step) {
    Shadow::Told told;
    told.since_last = chance.once_in(1500) ? seconds(chance.draw(0.0, 0.08)) : kMotionPeriod;
    told.goal_came = !no_goals.next(chance.random) && chance.once_in(3);
    told.goal_good = !chance.once_in(700);
    told.sends = rig.drive->script.sends = !unsent.next(chance.random);
    told.feedback_good = rig.drive->script.reports = !deaf.next(chance.random);
    rig.drive->script.measures = !frozen.next(chance.random);
    told.images_in_time = rig.inputs.images_in_time = !images.next(chance.random);
    told.safety_chain_ok = rig.inputs.safety_chain_ok = !fault.next(chance.random);
    told.stop = rig.inputs.stop = chance.once_in(2000);
    told.request = chance.once_in(20)    ? ArmRequest::kArm
                   : chance.once_in(500) ? ArmRequest::kDisarm
                                         : ArmRequest::kNone;
    rig.inputs.request = told.request;
    rig.goals_come = told.goal_came;
    if (chance.once_in(40)) rig.goal = {chance.draw(-0.5, 1.5), chance.draw(-3.0, 3.0)};
    const hal::Twist good_goal = rig.goal;
    if (!told.goal_good) rig.goal.forward_mps = std::nan("");

    const MotionStatus status = rig.step(told.since_last);
    rig.goal = good_goal;
    if (rig.drive->script.measures && told.feedback_good) measured = rig.now;
    told.feedback_age = rig.now - measured;

    const bool may_move = shadow.may_move(told, rig.now);
    EXPECT_EQ(status.armed, shadow.armed) << "seed " << seed << " step " << step << ": " << to_string(status.cause);
    EXPECT_EQ(status.cause == StopCause::kNone, may_move) << "seed " << seed << " step " << step;
    if (!may_move) {
      EXPECT_TRUE(is_zero(status.commanded)) << "seed " << seed << " step " << step;
    }
    if (!may_move && told.sends) {
      EXPECT_TRUE(is_zero(rig.drive->commands.back())) << "seed " << seed << " step " << step;
    }
    EXPECT_EQ(status.sent, told.sends);
    expect_within_limits(status, before, told.since_last, rig.parameters);
    EXPECT_LE(std::abs(rig.drive->truth.x_m), 1.0 + 1e-9) << "seed " << seed << " step " << step;
    EXPECT_LE(std::abs(rig.drive->truth.y_m), 1.0 + 1e-9) << "seed " << seed << " step " << step;
    if (testing::Test::HasFailure()) return tally;

    before = status.commanded;
    tally.moving += is_zero(status.commanded) ? 0 : 1;
    tally.armed += status.armed ? 1 : 0;
    tally.slowed += status.keep_in_slowed ? 1 : 0;
  }
  return tally;
}

TEST(MotionLoopProperty, NeverMovesWhenTheShadowSaysStopAndNeverExceedsALimit) {
  constexpr int kSeeds = 20;
  constexpr int kSteps = 10000;
  Tally all;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Tally tally = run(seed, kSteps);
    ASSERT_FALSE(HasFailure());
    all.moving += tally.moving;
    all.armed += tally.armed;
    all.slowed += tally.slowed;
  }
  // The walk was neither all standing nor all moving.
  EXPECT_GT(all.moving, kSeeds * kSteps / 10);
  EXPECT_LT(all.moving, kSeeds * kSteps * 9 / 10);
  EXPECT_LT(all.armed, kSeeds * kSteps * 95 / 100);
  EXPECT_GT(all.slowed, kSeeds * kSteps / 100);
  RecordProperty("moving", all.moving);
  RecordProperty("armed", all.armed);
  RecordProperty("slowed", all.slowed);
}

// A base that obeys late, as late as reaction_s, and brakes no harder than the deceleration limit stays inside all the same,
// wherever the goals want it to go.
TEST(MotionLoopProperty, SluggishBaseStaysInItsArea) {
  int slowed = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Chance chance(seed);
    const MotionParameters limits = draw_parameters(chance);
    Rig rig(limits);
    rig.drive->delay = seconds(limits.reaction_s * chance.draw(0.0, 1.0));
    rig.drive->inertia_mps2 = limits.max_deceleration_mps2;
    rig.arm_and_move({});
    for (int step = 0; step < 4000; ++step) {
      if (chance.once_in(100)) rig.goal = {chance.draw(-0.5, 1.5), chance.draw(-2.0, 2.0)};
      slowed += rig.step().keep_in_slowed ? 1 : 0;
      const double slack = 0.001;  // of the millisecond grid of the base
      ASSERT_LE(std::abs(rig.drive->truth.x_m), 1.0 + slack) << "seed " << seed << " step " << step;
      ASSERT_LE(std::abs(rig.drive->truth.y_m), 1.0 + slack) << "seed " << seed << " step " << step;
    }
  }
  EXPECT_GT(slowed, 40 * 4000 / 50);
}

}  // namespace
}  // namespace cgsr
