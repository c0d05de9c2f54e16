#include "hal/sim/scene/scene.h"

#include <cmath>

#include <gtest/gtest.h>

#include "hal/sim/scene/map_count.h"
#include "hal/sim/scene/portable_math.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

TEST(PortableMathProperty, AgreesWithTheLibrary) {
  Seeded random(1);
  for (int trial = 0; trial < 20000; ++trial) {
    const double angle = random.uniform(-1000, 1000);
    EXPECT_NEAR(sine(angle), std::sin(angle), 2e-13);
    EXPECT_NEAR(cosine(angle), std::cos(angle), 2e-13);
    const double x = random.uniform(-5, 5);
    const double y = random.uniform(-5, 5);
    EXPECT_NEAR(arc_tangent(y, x), std::atan2(y, x), 1e-14);
    const double e = random.uniform(-40, 40);
    EXPECT_NEAR(exponential(e) / std::exp(e), 1.0, 1e-14);
    const double v = random.uniform(0, 1);
    EXPECT_NEAR(srgb_encode(v), v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055, 1e-14);
    EXPECT_NEAR(srgb_decode(srgb_encode(v)), v, 1e-7) << "the standard's two pieces meet to 1e-7 only";
  }
  EXPECT_EQ(arc_tangent(0, -1), kPi);
  EXPECT_NEAR(arc_tangent(-1e-3, -1), std::atan2(-1e-3, -1), 1e-14);
  EXPECT_EQ(arc_tangent(0, 0), 0.0);
  EXPECT_EQ(srgb_encode(0), 0.0);
  EXPECT_EQ(srgb_encode(2), 1.0);
}

TEST(HeedRobot, TurnsWhoWatchesAndNobodyElse) {
  Scene scene;
  for (const bool watches : {true, false}) {
    Figure figure;
    figure.kind = FigureKind::kPerson;
    figure.path = Path::standing({2.0, 1.0, 0.0}, degrees(30));
    figure.watches_robot = watches;
    scene.figures.push_back(figure);
  }
  SceneState state = state_at(scene, 1.0);
  heed_robot(scene, pose_at({2.0, -3.0, 0.0}), state);
  const auto heading_of = [&](std::size_t figure) {
    const Eigen::Vector3d forward = state.X_WJ[figure][0].linear().col(0);
    return arc_tangent(forward.y(), forward.x());
  };
  EXPECT_NEAR(heading_of(0), degrees(-90), 1e-12);
  EXPECT_NEAR(heading_of(1), degrees(30), 1e-12);
  EXPECT_NEAR((state.X_WJ[0][0].translation() - Eigen::Vector3d(2.0, 1.0, 0.0)).norm(), 0.0, 1e-12);
}

// It comes towards the robot, on its way or half a metre beside it: it passes at the distance that it keeps, without a jump.
TEST(HeedRobot, WhoMakesWayPassesAtADistance) {
  for (const double beside_m : {-0.5, 0.0, 0.02, 0.5}) {
    Scene scene;
    Figure figure;
    figure.kind = FigureKind::kPerson;
    figure.path = *Path::make({{{3.0, beside_m, 0.0}, 1.0}, {{-3.0, beside_m, 0.0}, 1.0}}, 0.0, 10.0, false);
    figure.makes_way_m = 0.8;
    scene.figures.push_back(figure);
    Eigen::Vector3d last(3.0, beside_m, 0.0);
    double nearest_m = 9.0;
    for (double time_s = 0.0; time_s <= 6.0; time_s += 0.01) {
      SceneState state = state_at(scene, time_s);
      heed_robot(scene, pose_at({0.0, 0.0, 0.0}), state);
      const Eigen::Vector3d p_W = state.X_WJ[0][0].translation();
      EXPECT_LT((p_W - last).norm(), 0.15) << beside_m << ' ' << time_s;
      nearest_m = std::min(nearest_m, p_W.norm());
      last = p_W;
    }
    EXPECT_NEAR(nearest_m, 0.8, 0.01) << beside_m;
    EXPECT_NEAR((last - Eigen::Vector3d(-3.0, beside_m, 0.0)).norm(), 0.0, 0.01) << "it goes on";
  }
}

TEST(Path, WalksWaitsAndTurns) {
  const auto path =
      Path::make({{{0, 0, 0}, 1.0, 2.0}, {{4, 0, 0}, 2.0}, {{4, 3, 0}, 1.0, 1.0, degrees(180), true}}, 1.0, 2.0, false);
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_EQ(path->at(0.0).p_W.x(), 0.0);
  EXPECT_NEAR(path->at(2.9).p_W.x(), 0.0, 1e-12) << "waits until 3 s";
  EXPECT_NEAR(path->at(4.0).p_W.x(), 2.0, 1e-12);
  EXPECT_NEAR(path->at(4.0).speed_mps, 2.0, 1e-12);
  EXPECT_NEAR(path->at(6.5).p_W.y(), 1.5, 1e-12);
  EXPECT_NEAR(path->at(6.5).heading_rad, degrees(90), 1e-12);
  EXPECT_NEAR(path->at(5.0).heading_rad, degrees(45), 0.02) << "in the middle of a turn";
  EXPECT_NEAR(path->at(8.8).heading_rad, degrees(180), 1e-9);
  EXPECT_NEAR(path->at(100).walked_m, 7.0, 1e-12);
  EXPECT_EQ(path->at(100).speed_mps, 0.0);
  EXPECT_NEAR(path->duration_s(), 8.0, 1e-12);
}

// However it goes: no jump, never faster than it may, and turning no faster than told (legs long enough for the turn).
TEST(PathProperty, IsContinuous) {
  Seeded random(2);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Waypoint> stops;
    for (int i = 0; i < 5; ++i) {
      stops.push_back({{3.0 * i + random.uniform(-1, 1), random.uniform(-4, 4), 0},
                       random.uniform(0.3, 1.5),
                       i % 2 == 0 ? random.uniform(1, 2) : 0.0});
    }
    const auto path = Path::make(stops, 0.5, 2.0, trial % 2 == 0);
    ASSERT_TRUE(path);
    PathPoint before = path->at(0.0);
    for (double t = 0.01; t < 40; t += 0.01) {
      const PathPoint now = path->at(t);
      ASSERT_LT((now.p_W - before.p_W).norm(), 0.016) << t;
      ASSERT_LT(std::abs(wrap_angle(now.heading_rad - before.heading_rad)), 0.2) << t;
      ASSERT_GE(now.walked_m, before.walked_m - 1e-9) << t;
      before = now;
    }
  }
}

TEST(Path, RefusesWhatNeverArrives) {
  EXPECT_FALSE(Path::make({}, 0, 2, false));
  EXPECT_FALSE(Path::make({{{0, 0, 0}, 0.0}}, 0, 2, false));
  EXPECT_FALSE(Path::make({{{0, std::nan(""), 0}, 1.0}}, 0, 2, false));
  EXPECT_FALSE(Path::make({{{0, 0, 0}, 1.0, -1.0}}, 0, 2, false));
  EXPECT_TRUE(Path::make({{{0, 0, 0}}, {{0, 0, 0}}}, 0, 2, true)->at(5).p_W.isZero());
}

TEST(Figure, ABallRollsAsFarAsItGoes) {
  Figure ball;
  ball.joints[0].p_PJ = {0, 0, 0.1};
  ball.joints[0].drive = JointDrive::kRoll;
  ball.joints[0].amplitude_rad = 10.0;
  const Pose X = pose_joints(ball, pose_at({1, 0, 0}), 0.0, 0.1 * kPi / 2, 1.0)[0];
  EXPECT_NEAR(X.translation().z(), 0.1, 1e-12);
  EXPECT_LT((X.linear() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-12) << "the top goes forward";
}

TEST(Figure, HeadsTurnWithoutJumps) {
  const std::vector<HeadKey> script{{1.0, 1.0, 0.0}, {5.0, -0.5, 0.2}};
  EXPECT_EQ(head_at(script, 0.5).yaw_rad, 0.0);
  EXPECT_NEAR(head_at(script, 1.25).yaw_rad, 0.5, 1e-12);
  EXPECT_NEAR(head_at(script, 4.0).yaw_rad, 1.0, 1e-12);
  EXPECT_NEAR(head_at(script, 9.0).yaw_rad, -0.5, 1e-12);
}

TEST(Lights, FollowTheirScripts) {
  const std::vector<LightKey> script{{1.0, Rgb(1, 1, 1)}, {3.0, Rgb(0, 0.5F, 1)}};
  EXPECT_EQ(factor_at({}, 5.0), Rgb(1, 1, 1));
  EXPECT_EQ(factor_at(script, 0.0), Rgb(1, 1, 1));
  EXPECT_LT((factor_at(script, 2.0) - Rgb(0.5F, 0.75F, 1)).norm(), 1e-6F);
  EXPECT_EQ(factor_at(script, 9.0), Rgb(0, 0.5F, 1));
}

TEST(Robot, ItsBoardFillsTheLowerThirdOfTheImage) {
  RobotBody robot;
  robot.camera_down_rad = degrees(20);
  robot.has_board = true;
  const CameraModel camera = CameraModel().without_distortion();
  const Pose X_CR = mount_of(robot).inverse();
  const auto row = [&](double forward) {
    const Eigen::Vector3d p = X_CR * (robot.board.p_RB + Eigen::Vector3d(forward, 0, 0));
    return camera.fy_px * p.y() / p.z() + camera.cy_px;
  };
  EXPECT_NEAR(row(robot.board.depth_m / 2), 320, 20);
  EXPECT_GT(row(-robot.board.depth_m / 2), 470);
}

}  // namespace
}  // namespace cgsr::sim
