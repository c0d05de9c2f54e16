#include "pipeline/illumination/probe_observation.h"

#include "pipeline/illumination/lamp.h"
#include "tests/illumination/drawn_board.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLampHeight_m = 1.85;

// The mount is off by this; the image shows where the camera really is.
geometry::Pose real_camera(const Board& board) {
  geometry::Vector6d step;
  step << 0.003, -0.002, 0.002, 0.004, -0.005, 0.003;
  return geometry::moved(board.X_BC, step);
}

TEST(ProbeObservation, FindsTheShadowsOfDrawnTips) {
  const Board board = shipped_board();
  const auto X_BC = real_camera(board);
  for (const auto& [angle, way] : {std::pair{30.0, 150.0}, {35.0, 270.0}, {45.0, 60.0}, {55.0, 30.0}}) {
    Drawing drawing;
    drawing.lamps_B = {lamp_at(angle, way)};
    const auto image = draw(board, X_BC, drawing);
    ProbeObserver observer(board, shipped_probes(), kLampHeight_m);
    const auto seen = observer.observe(image.view());
    ASSERT_EQ(seen.status, ObservationStatus::kSeen) << angle;
    EXPECT_LT(geometry::step_between(X_BC, seen.registration.X_BC).head<3>().norm(), 0.003);
    EXPECT_LT(geometry::step_between(X_BC, seen.registration.X_BC).tail<3>().norm(), 0.004);
    int found = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      for (int k = 0; k < seen.probe[i].count; ++k) {
        const ProbeShadow& shadow = seen.probe[i].shadow[static_cast<std::size_t>(k)];
        if (shadow.lines < 2) continue;
        ++found;
        EXPECT_LT((shadow.p_BS - cast(drawing.lamps_B[0], board.probe[i].p_BA)).norm(), 0.003) << angle << ' ' << i;
      }
    }
    EXPECT_GE(found, 1) << angle;
    const auto lamps = locate_lamps(board, {}, seen);
    ASSERT_EQ(lamps.count, 1) << angle;
    EXPECT_LT((lamps.lamp[0].p_RL - board.X_RB * drawing.lamps_B[0]).norm(), 0.07) << angle;
  }
}

// How large the lamp is nobody tells: the softness of its shadow does.
TEST(ProbeObservation, FindsHowLargeALampIs) {
  const Board board = shipped_board();
  const auto X_BC = real_camera(board);
  constexpr int kParts = 21;
  ProbesParameters fixed = shipped_probes();
  fixed.shadow.lamp_radius_sigma_m = 1e-4;
  double fixed_off = 0.0;
  for (const double radius : {0.02, 0.10, 0.15}) {
    const Vector3d p_BL = lamp_at(40.0, 285.0);
    Drawing drawing;
    shine_from_ball(p_BL, 30.0, drawing, radius, kParts);
    const auto image = draw(board, X_BC, drawing);
    ProbeObserver observer(board, shipped_probes(), kLampHeight_m);
    const auto seen = observer.observe(image.view());
    int whole = 0;
    for (const auto& found : seen.probe) {
      for (int k = 0; k < found.count; ++k) {
        const ProbeShadow& shadow = found.shadow[static_cast<std::size_t>(k)];
        if (shadow.lines < 2) continue;
        ++whole;
        // The edges of a 2 cm lamp's shadow are as sharp as the camera: it is taken for one of 3 cm.
        EXPECT_NEAR(shadow.lamp_radius_m, radius, std::max(0.012, 0.25 * radius));
        EXPECT_LT(shadow.lamp_radius_sigma_m, 0.02) << radius;
      }
    }
    EXPECT_GE(whole, 1) << radius;
    const auto lamps = locate_lamps(board, {}, seen);
    ASSERT_EQ(lamps.count, 1) << radius;
    EXPECT_LT((lamps.lamp[0].p_RL - board.X_RB * p_BL).norm(), 0.07) << radius;

    ProbeObserver told_wrongly(board, fixed, kLampHeight_m);
    const auto wrong = locate_lamps(board, {}, told_wrongly.observe(image.view()));
    fixed_off = wrong.count == 0 ? 1.0 : (wrong.lamp[0].p_RL - board.X_RB * p_BL).norm();
  }
  EXPECT_GT(fixed_off, 0.07);  // 15 cm taken for 5
}

// Taken as it lies there, the shadow's edge would be where the image begins to hold the light, too far inside, and the lamp too near.
TEST(ProbeObservation, ABoardBrighterThanTheImageHoldsTellsByTheDarkSideOfItsShadows) {
  const Board board = shipped_board();
  for (const double way : {50.0, 285.0}) {
    const Vector3d p_BL = lamp_at(40.0, way);
    std::array<double, 2> sigma_m{};
    for (const bool too_bright : {false, true}) {
      Drawing drawing;
      drawing.board_level = too_bright ? 300.0 : 240.0;
      shine_from_ball(p_BL, drawing.board_level - 110.0, drawing, 0.12, 21);
      ProbeObserver observer(board, shipped_probes(), kLampHeight_m);
      const auto seen = observer.observe(draw(board, board.X_BC, drawing).view());
      ASSERT_EQ(seen.status, ObservationStatus::kSeen) << way;
      EXPECT_EQ(seen.saturated, too_bright ? 3 : 0);
      int whole = 0;
      for (std::size_t i = 0; i < 2; ++i) {
        for (int k = 0; k < seen.probe[i].count; ++k) {
          const ProbeShadow& shadow = seen.probe[i].shadow[static_cast<std::size_t>(k)];
          if (shadow.lines < 2) continue;
          ++whole;
          const Vector2d off = shadow.p_BS - cast(p_BL, board.probe[i].p_BA);
          EXPECT_LT(off.norm(), too_bright ? 0.008 : 0.003) << way << " " << i;
          EXPECT_NEAR(shadow.lamp_radius_m, 0.12, too_bright ? 2.0 * shadow.lamp_radius_sigma_m : 0.04)
              << way << ' ' << i;
          EXPECT_LT(shadow.lamp_radius_sigma_m, 0.05) << way << ' ' << i;
          EXPECT_NEAR(shadow.level, drawing.board_level, 0.15 * drawing.board_level) << way << ' ' << i;
          EXPECT_NEAR(shadow.seen_contrast, std::min(255.0, drawing.board_level) - 110.0, 8.0) << way << ' ' << i;
          sigma_m[too_bright ? 1 : 0] = std::max(sigma_m[too_bright ? 1 : 0], std::sqrt(shadow.covariance.trace()));
        }
      }
      EXPECT_GE(whole, 1) << way;
    }
    EXPECT_GT(sigma_m[1], 2.0 * sigma_m[0]);  // and says that it knows less
  }
}

// Light from behind the camera: of a tip's shadow a pixel or two stand out beside the cone.
TEST(ProbeObservation, FindsAShadowThatItsOwnConeAllButHides) {
  const Board board = shipped_board();
  const auto X_BC = real_camera(board);
  const Vector3d p_BL(-0.656, 0.27, 1.85);  // 20 degrees from the vertical
  Drawing drawing;
  shine_from_ball(p_BL, 30.0, drawing);
  const auto image = draw(board, X_BC, drawing);
  ProbeObserver observer(board, shipped_probes(), kLampHeight_m);
  const auto lamps = locate_lamps(board, {}, observer.observe(image.view()));
  ASSERT_EQ(lamps.count, 1);
  ASSERT_EQ(lamps.lamp[0].status, LampStatus::kFound);
  EXPECT_EQ(lamps.lamp[0].probes, 1);
  EXPECT_LT((lamps.lamp[0].p_RL - board.X_RB * p_BL).norm(), 0.06);
}

// Light from far aside: long shadows, a few grey levels darker than the board and twice as long as the rings reach.
TEST(ProbeObservation, FindsHowLongAWeakShadowIs) {
  const Board board = shipped_board();
  const auto X_BC = real_camera(board);
  const BoardView view(board.camera, X_BC);
  std::array<Outline, kMostProbes> behind;
  for (std::size_t i = 0; i < 2; ++i) {
    behind[i] = outline_of(board.probe[i].foot_B, board.probe[i].radius_m, cast(view.p_BC(), board.probe[i].p_BA));
  }
  int to_be_seen = 0;
  int found = 0;
  for (const auto& [angle, contrast] : {std::pair{60.0, 3.0}, {50.0, 4.0}}) {
    for (double way = 0.0; way < 360.0; way += 36.0) {
      const Vector3d p_BL = lamp_at(angle, way);
      Drawing drawing;
      drawing.noise = 0.7;
      shine_from_ball(p_BL, contrast, drawing);
      const auto image = draw(board, X_BC, drawing);
      ProbeObserver observer(board, shipped_probes(), kLampHeight_m);
      const auto seen = observer.observe(image.view());
      for (std::size_t i = 0; i < 2; ++i) {
        const Vector2d tip = cast(p_BL, board.probe[i].p_BA);
        if (is_seen(board, behind, tip)) ++to_be_seen;
        for (int k = 0; k < seen.probe[i].count; ++k) {
          const ProbeShadow& shadow = seen.probe[i].shadow[static_cast<std::size_t>(k)];
          if (shadow.lines < 2) continue;
          const double off = (shadow.p_BS - tip).norm();
          if (is_seen(board, behind, tip)) found += off < 0.012 ? 1 : 0;
          EXPECT_LT(off, std::max(0.012, 4.0 * std::sqrt(shadow.covariance.trace())))
              << angle << ' ' << way << ' ' << i;
        }
      }
    }
  }
  EXPECT_GT(to_be_seen, 10);
  EXPECT_GE(found, 0.9 * to_be_seen);
}

TEST(ProbeObservation, WhatIsNoShadowOfAProbeIsNotTakenForOne) {
  const Board board = shipped_board();
  const auto X_BC = real_camera(board);
  Drawing plain;
  Drawing dirt;
  dirt.darker = [](const Vector2d& p) {  // spots, some at the cones' feet
    double dark = 0.0;
    for (const Vector2d& spot :
         {Vector2d(0.03, 0.235), Vector2d(-0.03, 0.17), Vector2d(0.04, -0.24), Vector2d(0.0, 0.0)})
      dark += (p - spot).norm() < 0.012 ? 25.0 : 0.0;
    return dark;
  };
  Drawing hand;
  hand.darker = [](const Vector2d& p) {  // a straight edge across the board, and dark beyond
    return p.x() + 0.6 * p.y() > 0.15 ? 30.0 : 0.0;
  };
  Drawing texture;
  texture.darker = [](const Vector2d& p) { return 4.0 + 4.0 * std::sin(300.0 * p.x()) * std::sin(170.0 * p.y()); };
  for (Drawing drawing : {plain, dirt, hand, texture}) {
    for (const double level : {140.0, 258.0}) {  // and where all but them is clipped
      drawing.board_level = level;
      const auto image = draw(board, X_BC, drawing);
      ProbeObserver observer(board, shipped_probes(), kLampHeight_m);
      const auto seen = observer.observe(image.view());
      EXPECT_EQ(seen.probe[0].count + seen.probe[1].count, 0) << level << ' ' << to_string(seen.status);
    }
  }
}

// The quick search against the one that leaves nothing out.
TEST(ProbeObservationProperty, TheQuickSearchFindsWhatTheWholeOneDoes) {
  const Board board = shipped_board();
  const auto X_BC = real_camera(board);
  for (const double way : {60.0, 150.0, 230.0, 300.0}) {
    Drawing drawing;
    drawing.lamps_B = {lamp_at(35.0, way)};
    const auto image = draw(board, X_BC, drawing);
    const LumaView luma(image.view());
    for (int probe = 0; probe < 2; ++probe) {
      ShadowFinder quick(board, probe, {}, kLampHeight_m);
      ShadowFinder whole(board, probe, {}, kLampHeight_m);
      whole.search_everywhere();
      const auto a = quick.find(luma, X_BC);
      const auto b = whole.find(luma, X_BC);
      ASSERT_EQ(a.count, b.count) << way << ' ' << probe;
      for (std::size_t k = 0; k < static_cast<std::size_t>(a.count); ++k) {
        ASSERT_EQ(a.shadow[k].lines, b.shadow[k].lines);
        if (a.shadow[k].lines < 2) continue;
        EXPECT_LT((a.shadow[k].p_BS - b.shadow[k].p_BS).norm(), 0.0005) << way << ' ' << probe;
      }
    }
  }
}

TEST(ProbeObservation, TwoLampsThrowTwoShadows) {
  const Board board = shipped_board();
  Drawing drawing;
  drawing.lamps_B = {lamp_at(40, 160), lamp_at(40, 285)};
  const auto image = draw(board, board.X_BC, drawing);
  ProbeObserver observer(board, shipped_probes(), kLampHeight_m);
  const auto lamps = locate_lamps(board, {}, observer.observe(image.view()));
  ASSERT_EQ(lamps.count, 2);
  for (const auto& p_BL : drawing.lamps_B) {
    const double nearest =
        std::min((lamps.lamp[0].p_RL - board.X_RB * p_BL).norm(), (lamps.lamp[1].p_RL - board.X_RB * p_BL).norm());
    EXPECT_LT(nearest, 0.10);
  }
}

TEST(ProbeObservationFault, EachHasItsName) {
  const Board board = shipped_board();
  Drawing drawing;
  drawing.lamps_B = {lamp_at(40, 60)};
  const auto image = draw(board, board.X_BC, drawing);
  ProbeObserver observer(board, shipped_probes(), kLampHeight_m);
  EXPECT_EQ(observer.observe({}).status, ObservationStatus::kNoImage);
  ImageView smaller = image.view();
  smaller.width_px = 320;
  EXPECT_EQ(observer.observe(smaller).status, ObservationStatus::kWrongSize);

  DrawnImage grey = image;
  std::fill(grey.grey.begin(), grey.grey.end(), std::uint8_t{90});
  EXPECT_EQ(observer.observe(grey.view()).status, ObservationStatus::kNotRegistered);

  Drawing bright = drawing;
  bright.board_level = 300.0;
  bright.shadow_level = 10.0;
  const auto saturated = draw(board, board.X_BC, bright);
  EXPECT_EQ(observer.observe(saturated.view()).status, ObservationStatus::kSaturated);

  Drawing one_gone = drawing;
  one_gone.right_cone = false;
  const auto without = draw(board, board.X_BC, one_gone);
  const auto seen = observer.observe(without.view());
  EXPECT_EQ(seen.missing, 2);
  EXPECT_EQ(seen.probe[1].count, 0);
}

TEST(ProbeObservationAlloc, LookingAllocatesNothing) {
  const Board board = shipped_board();
  Drawing drawing;
  drawing.lamps_B = {lamp_at(40, 60)};
  const auto image = draw(board, board.X_BC, drawing);
  ProbeObserver observer(board, shipped_probes(), kLampHeight_m);
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const test::AllocationGuard guard;
  const auto seen = observer.observe(image.view());
  const auto lamps = locate_lamps(board, {}, seen);
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(lamps.count, 1);
}

}  // namespace
}  // namespace cgsr::illumination
