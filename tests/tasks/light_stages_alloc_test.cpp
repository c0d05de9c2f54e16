// Chapter 5's stages as the vision loop runs them, image after image: lamp found, gone and found anew, lamps switched to make sure, masks made.
#include <gtest/gtest.h>

#include "pipeline/behavior/seek_lamp.h"
#include "pipeline/stages/probes_stage.h"
#include "pipeline/stages/shade_stage.h"
#include "pipeline/stages/switchboard.h"
#include "pipeline/world/load.h"
#include "tests/illumination/drawn_board.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::stages::testing {
namespace {

using illumination::CheckedLamp;
using illumination::CheckState;

constexpr Duration kPeriod = seconds(1.0 / 30.0);

class LightStagesAlloc : public ::testing::Test {
 protected:
  LightStagesAlloc()
      : board_(illumination::shipped_board()),
        map_(std::make_shared<const world::Map>(*world::load_map(CGSR_SOURCE_DIR "/config/maps/home/map.obj"))),
        lamp_(board_, illumination::shipped_probes(), {}, board_.X_RB * board_.X_BC, {true, true, {}}),
        shade_(map_, board_.camera, {}),
        seek_({}, std::make_shared<behavior::FreeFloor>(*map_, behavior::FreeFloorParameters{}), {}, {}) {
    illumination::Drawing drawing;
    drawing.board_level = 90.0;
    drawing.cone_level = 60.0;
    dark_ = illumination::draw(board_, board_.X_BC, drawing);
    drawing.board_level = 150.0;
    drawing.cone_level = 95.0;
    drawing.shadow_level = 60.0;
    drawing.lamps_B = {illumination::lamp_at(35.0, 60.0)};
    lit_ = illumination::draw(board_, board_.X_BC, drawing);
    robot_.X_WR = geometry::pose_on_floor(4.6, 3.2, 0.0);
    robot_.covariance = 1e-5 * geometry::Matrix6d::Identity();
  }

  /// One image through probes and shade, every switching acknowledged at once; `burns` unless the room's line is on.
  void image(bool burns) {
    now_ += kPeriod;
    while (const auto request = switchboard_.next(now_)) switchboard_.on_answer({*request, true, now_});
    LampLines lines;
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i] = switchboard_.state(static_cast<LampLine>(i), now_);
    const bool room_on = lines[static_cast<std::size_t>(LampLine::kRoomLamp)].on;
    const auto& drawn = burns && !room_on ? lit_ : dark_;
    report_ = lamp_.update(drawn.view(), &robot_, lines, std::exchange(requests_, {}));
    switchboard_.want(LampLine::kProbeLamp, report_.requests_probe_lamp);
    switchboard_.want(LampLine::kRoomLamp, report_.requests_room_lamp);
    const geometry::Pose X_WC = robot_.X_WR * board_.X_RB * board_.X_BC;
    masked_ += shade_.update(budget_, X_WC, robot_.covariance, report_.known ? &report_.lamp : nullptr)->masks ? 1 : 0;
    behavior::LampBelief belief;
    belief.has_board = belief.readable = true;
    belief.known = report_.known;
    seek_.decide({true, 4.6, 3.2, 0.0}, belief, kPeriod);
  }

  illumination::Board board_;
  std::shared_ptr<const world::Map> map_;
  ProbesStage lamp_;
  ShadeStage shade_;
  UnlimitedBudget budget_;
  behavior::SeekLamp seek_;
  Switchboard switchboard_{{true, true, false}, kPeriod, seconds(0.5)};
  illumination::DrawnImage dark_;
  illumination::DrawnImage lit_;
  PlacedRobot robot_;
  MonoTime now_{};
  LampReport report_;
  Requests requests_;
  int masked_ = 0;
};

TEST_F(LightStagesAlloc, NothingOnceTheyAreMade) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const test::AllocationGuard guard;
  for (int i = 0; i < 6; ++i) image(true);
  EXPECT_TRUE(report_.known);
  for (int i = 0; i < 10; ++i) image(false);
  EXPECT_FALSE(report_.known) << "it went out";
  for (int i = 0; i < 6; ++i) image(true);
  requests_.check = CheckedLamp::kRoomLamp;
  for (int i = 0; i < 12; ++i) image(true);
  EXPECT_EQ(report_.lamp_proof.state, CheckState::kPassed) << reason_of(report_);
  EXPECT_TRUE(report_.known);
  requests_.check = CheckedLamp::kProbeLamp;
  for (int i = 0; i < 12; ++i) image(true);
  EXPECT_EQ(report_.probes_check.state, CheckState::kFault) << "no probe lamp shines in these pictures";
  EXPECT_FALSE(report_.known);
  EXPECT_GT(masked_, 10);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::stages::testing
