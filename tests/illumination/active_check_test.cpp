#include "pipeline/illumination/active_check.h"

#include "tests/illumination/drawn_board.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::illumination {
namespace {

using Eigen::Vector3d;

constexpr double kLampHeight_m = 1.85;

/// A board under a lamp that a line switches, and under another one that it does not.
class Checked : public ::testing::Test {
 protected:
  Checked() : check_(true, board_, shipped_probes(), kLampHeight_m) {
    Drawing dark;
    dark.board_level = 90.0;
    dark.cone_level = 60.0;
    Drawing lit = dark;
    lit.board_level = 150.0;
    lit.cone_level = 95.0;
    lit.shadow_level = 60.0;
    lit.seed = 2;
    dark_ = draw(board_, board_.X_BC, dark);
    lit.lamps_B = {lamp_B_};
    lit_ = draw(board_, board_.X_BC, lit);
  }

  /// One image: it shows what the line's level says, unless the lamp or the line is broken.
  void image() {
    check_.look((line_.on != wall_switch_ && !bulb_broken_ ? lit_ : dark_).view(), line_);
    if (line_.on == check_.wants_on()) {
      line_.settled = true;
    } else if (line_answers_) {
      line_.on = check_.wants_on();
      line_.settled = false;
      ++switchings_;
    } else {
      line_.settled = false;
      line_.silent = true;
    }
  }

  CheckReport run(const Vector3d& p_BL) {
    check_.begin(board_.X_RB * p_BL, 0.01);
    for (int i = 0; i < 40 && check_.running(); ++i) image();
    return check_.report();
  }

  const Board board_ = shipped_board();
  const Vector3d lamp_B_ = lamp_at(35.0, 60.0);
  ActiveCheck check_;
  DrawnImage dark_;
  DrawnImage lit_;
  LineState line_{true, false, true, false};
  bool wall_switch_ = false;
  bool bulb_broken_ = false;
  bool line_answers_ = true;
  int switchings_ = 0;
};

using CheckedFault = Checked;
using CheckedAlloc = Checked;

TEST_F(Checked, AKnownLampPassesAndIsSwitchedBack) {
  const auto report = run(lamp_B_);
  EXPECT_EQ(report.state, CheckState::kPassed) << to_string(report.verdict);
  EXPECT_EQ(report.tries, 1);
  EXPECT_EQ(switchings_, 2);
  EXPECT_FALSE(line_.on);
}

// A switch in the wall, too: the robot's line going on puts the lamp out.
TEST_F(Checked, ALampThatTheLinePutsOutIsProvenAsWell) {
  wall_switch_ = true;
  EXPECT_EQ(run(lamp_B_).state, CheckState::kPassed);
  EXPECT_FALSE(line_.on);
}

// What does not change with the lamp is not in the difference: the lamp that was located is another one than the line switches.
TEST_F(Checked, AShadowThatStaysIsNotTheLampsShadow) {
  const auto elsewhere = run(lamp_at(35.0, -60.0));
  EXPECT_EQ(elsewhere.state, CheckState::kFailed);
  EXPECT_EQ(elsewhere.verdict, SwitchVerdict::kDisagrees);
  EXPECT_FALSE(line_.on);

  Drawing both;  // the board gets brighter, and the shadow is in both images
  both.lamps_B = {lamp_B_};
  dark_ = draw(board_, board_.X_BC, both);
  both.board_level += 60.0;
  both.cone_level += 60.0;
  both.seed = 2;
  lit_ = draw(board_, board_.X_BC, both);
  check_.reopen();
  const auto stays = run(lamp_B_);
  EXPECT_EQ(stays.state, CheckState::kFailed) << to_string(stays.verdict);
  EXPECT_EQ(stays.verdict, SwitchVerdict::kNoShadow) << to_string(stays.verdict);
}

TEST_F(Checked, AnImageThatDoesNotShowTheChangeYetIsNotLookedAt) {
  check_.begin(board_.X_RB * lamp_B_, 0.01);
  image();
  ASSERT_TRUE(check_.wants_on());
  for (int i = 0; i < 5; ++i) check_.look(dark_.view(), {true, true, false, false});
  EXPECT_TRUE(check_.wants_on()) << "it waits for the image that shows the change";
  EXPECT_EQ(check_.report().tries, 0);
}

TEST_F(CheckedFault, EachHasItsName) {
  bulb_broken_ = true;
  const auto broken = run(lamp_B_);
  EXPECT_EQ(broken.state, CheckState::kFault);
  EXPECT_EQ(to_string(broken.verdict), "the lamp did not switch");
  bulb_broken_ = false;

  line_answers_ = false;
  const auto silent = run(lamp_B_);
  EXPECT_EQ(silent.state, CheckState::kFault);
  EXPECT_EQ(to_string(silent.verdict), "the switch does not answer");
  EXPECT_FALSE(check_.wants_on());
}

TEST_F(CheckedFault, WhatCannotBeComparedIsTriedThreeTimes) {
  std::fill(lit_.grey.begin(), lit_.grey.end(), std::uint8_t{120});
  const auto report = run(lamp_B_);
  EXPECT_EQ(report.state, CheckState::kFailed);
  EXPECT_EQ(report.verdict, SwitchVerdict::kNotRegistered);
  EXPECT_EQ(report.tries, 3);
  EXPECT_FALSE(line_.on);
}

TEST_F(CheckedFault, WithoutALineNothingIsSwitchedAndNothingKept) {
  ActiveCheck none(false, board_, shipped_probes(), kLampHeight_m);
  none.begin(board_.X_RB * lamp_B_, 0.01);
  none.look(dark_.view(), {});
  EXPECT_EQ(none.report().state, CheckState::kNotThere);
  EXPECT_FALSE(none.wants_on());
}

TEST_F(CheckedAlloc, CheckingAllocatesNothing) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const test::AllocationGuard guard;
  const auto report = run(lamp_B_);
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(report.state, CheckState::kPassed);
}

}  // namespace
}  // namespace cgsr::illumination
