// Chapter 5's stages as the vision loop runs them, image after image: lamp found, gone and found anew, lamps switched to make sure, masks made.
#include <gtest/gtest.h>

#include "pipeline/behavior/seek_lamp.h"
#include "pipeline/switchboard.h"
#include "pipeline/what_is_shaded.h"
#include "pipeline/where_is_the_lamp.h"
#include "pipeline/world/load.h"
#include "tests/illumination/drawn_board.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::robot::testing {
namespace {

using illumination::CheckedLamp;
using illumination::CheckState;

constexpr Duration kPeriod = seconds(1.0 / 30.0);

class LightStagesAlloc : public ::testing::Test {
 protected:
  LightStagesAlloc()
      : board_(illumination::shipped_board()),
        map_(*world::load_map(CGSR_SOURCE_DIR "/config/maps/home/map.obj")),
        lamp_(board_, illumination::shipped_probes(), {}, {true, true, {}}),
        shade_(map_, board_.camera, {}),
        seek_({}, std::make_shared<behavior::FreeFloor>(map_, behavior::FreeFloorParameters{}), {}, {}) {
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
    while (const auto request = switchboard_.next(now_)) switchboard_.heard({*request, true, now_});
    const auto room = switchboard_.state(LampLine::kRoomLamp, now_);
    const auto& drawn = burns && !room.on ? lit_ : dark_;
    sight_ = lamp_.look(drawn.view(), &robot_, {switchboard_.state(LampLine::kProbeLamp, now_), room});
    switchboard_.want(LampLine::kProbeLamp, lamp_.wants_on(CheckedLamp::kProbeLamp));
    switchboard_.want(LampLine::kRoomLamp, lamp_.wants_on(CheckedLamp::kRoomLamp));
    const geometry::Pose X_WC = robot_.X_WR * board_.X_RB * board_.X_BC;
    masked_ += shade_.look(X_WC, robot_.covariance, sight_.known ? &sight_.lamp : nullptr).masks != nullptr ? 1 : 0;
    behavior::LampBelief belief;
    belief.has_board = belief.readable = true;
    belief.known = sight_.known;
    seek_.decide({true, 4.6, 3.2, 0.0}, belief, kPeriod);
  }

  illumination::Board board_;
  world::Map map_;
  WhereIsTheLamp lamp_;
  WhatIsShaded shade_;
  behavior::SeekLamp seek_;
  Switchboard switchboard_{{true, true, false}, kPeriod, seconds(0.5)};
  illumination::DrawnImage dark_;
  illumination::DrawnImage lit_;
  PlacedRobot robot_;
  MonoTime now_{};
  LampSight sight_;
  int masked_ = 0;
};

TEST_F(LightStagesAlloc, NothingOnceTheyAreMade) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const test::AllocationGuard guard;
  for (int i = 0; i < 6; ++i) image(true);
  EXPECT_TRUE(sight_.known);
  for (int i = 0; i < 10; ++i) image(false);
  EXPECT_FALSE(sight_.known) << "it went out";
  for (int i = 0; i < 6; ++i) image(true);
  lamp_.make_sure(CheckedLamp::kRoomLamp);
  for (int i = 0; i < 12; ++i) image(true);
  EXPECT_EQ(sight_.lamp_proof.state, CheckState::kPassed) << reason_of(sight_);
  EXPECT_TRUE(sight_.known);
  lamp_.make_sure(CheckedLamp::kProbeLamp);
  for (int i = 0; i < 12; ++i) image(true);
  EXPECT_EQ(sight_.probes_check.state, CheckState::kFault) << "no probe lamp shines in these pictures";
  EXPECT_FALSE(sight_.known);
  EXPECT_GT(masked_, 10);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::robot::testing
