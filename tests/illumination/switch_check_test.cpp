#include "pipeline/illumination/switch_check.h"

#include "tests/illumination/drawn_board.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLampHeight_m = 1.85;

// With the lamp on and off; another lamp's shadow and a dark line on the board are in both.
std::pair<DrawnImage, DrawnImage> drawn_pair(const Board& board, const Vector3d& lamp_B) {
  Drawing off;
  off.board_level = 90.0;
  off.cone_level = 60.0;
  off.seed = 2;
  off.darker = [](const Vector2d& p) { return std::abs(p.x() + 0.3 * p.y()) < 0.01 ? 15.0 : 0.0; };
  Drawing on = off;
  on.board_level = 150.0;
  on.cone_level = 95.0;
  on.shadow_level = 60.0;
  on.seed = 3;
  on.lamps_B = {lamp_B};
  return {draw(board, board.X_BC, on), draw(board, board.X_BC, off)};
}

TEST(SwitchCheck, AKnownLampsShadowsFallWhereTheProbesAre) {
  const Board board = shipped_board();
  const Vector3d lamp_B = lamp_at(35.0, 60.0);
  const auto [on, off] = drawn_pair(board, lamp_B);
  SwitchChecker checker(board, shipped_probes(), kLampHeight_m);
  const auto check = checker.check(on.view(), off.view(), board.X_RB * lamp_B, 0.01);
  EXPECT_EQ(check.verdict, SwitchVerdict::kAgrees) << to_string(check.verdict);
  EXPECT_TRUE(check.seen[0] || check.seen[1]);
  EXPECT_GT(check.difference, 30.0);
}

// How a camera codes the edge of a soft shadow hangs on the light beside the lamp, which the difference no longer shows.
TEST(SwitchCheck, ASoftLampInALitRoomThrowsItsShadowsWhereItShould) {
  const Board board = shipped_board();
  const Vector3d lamp_B = lamp_at(35.0, 60.0);
  SwitchChecker checker(board, shipped_probes(), kLampHeight_m);
  for (const double off_level : {20.0, 150.0}) {
    Drawing off;
    off.board_level = off_level;
    off.cone_level = 0.6 * off_level;
    Drawing on = off;
    on.board_level = 190.0;
    on.cone_level = 120.0;
    on.seed = 5;
    shine_from_ball(lamp_B, on.board_level - off.board_level, on, 0.12, 21);
    const auto check = checker.check(draw(board, board.X_BC, on).view(), draw(board, board.X_BC, off).view(),
                                     board.X_RB * lamp_B, 0.01);
    EXPECT_EQ(check.verdict, SwitchVerdict::kAgrees) << off_level << ' ' << to_string(check.verdict);
    for (std::size_t i = 0; i < 2; ++i) {
      if (!check.seen[i]) continue;
      EXPECT_LT(check.off_m[i].norm(), 0.0015) << off_level << ' ' << i;
    }
  }
}

TEST(SwitchCheck, AProbeThatWasBentIsNoticed) {
  const Board board = shipped_board();
  Board bent = board;
  bent.probe[0].p_BA += Vector3d(0.006, -0.006, 0.0);
  bent.probe[1].p_BA += Vector3d(0.006, -0.006, 0.0);
  const Vector3d lamp_B = lamp_at(35.0, 60.0);
  const auto [on, off] = drawn_pair(bent, lamp_B);
  SwitchChecker checker(board, shipped_probes(), kLampHeight_m);
  const auto check = checker.check(on.view(), off.view(), board.X_RB * lamp_B, 0.01);
  EXPECT_EQ(check.verdict, SwitchVerdict::kDisagrees) << to_string(check.verdict);
}

TEST(SwitchCheckFault, EachHasItsName) {
  const Board board = shipped_board();
  const Vector3d lamp_B = lamp_at(35.0, 60.0);
  const Vector3d p_RL = board.X_RB * lamp_B;
  const auto [on, off] = drawn_pair(board, lamp_B);
  SwitchChecker checker(board, shipped_probes(), kLampHeight_m);
  EXPECT_EQ(checker.check(off.view(), off.view(), p_RL, 0.01).verdict, SwitchVerdict::kNoDifference);
  EXPECT_EQ(checker.check({}, off.view(), p_RL, 0.01).verdict, SwitchVerdict::kNoImage);
  ImageView small = off.view();
  small.width_px = 320;
  EXPECT_EQ(checker.check(on.view(), small, p_RL, 0.01).verdict, SwitchVerdict::kNoImage);
  DrawnImage plain = on;
  std::fill(plain.grey.begin(), plain.grey.end(), std::uint8_t{120});
  EXPECT_EQ(checker.check(plain.view(), off.view(), p_RL, 0.01).verdict, SwitchVerdict::kNotRegistered);
  const auto [far_on, far_off] = drawn_pair(board, lamp_at(1.0, 0.0));  // from straight above: no shadow beside a cone
  EXPECT_EQ(checker.check(far_on.view(), far_off.view(), p_RL, 0.01).verdict, SwitchVerdict::kNoShadow);
}

TEST(SwitchCheckAlloc, CheckingAllocatesNothing) {
  const Board board = shipped_board();
  const Vector3d lamp_B = lamp_at(35.0, 60.0);
  const auto [on, off] = drawn_pair(board, lamp_B);
  SwitchChecker checker(board, shipped_probes(), kLampHeight_m);
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const test::AllocationGuard guard;
  const auto check = checker.check(on.view(), off.view(), board.X_RB * lamp_B, 0.01);
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(check.verdict, SwitchVerdict::kAgrees);
}

}  // namespace
}  // namespace cgsr::illumination
