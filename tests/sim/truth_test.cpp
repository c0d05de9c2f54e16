#include "hal/sim/truth.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "hal/sim/render/photographer.h"
#include "hal/sim/scene/portable_math.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector3d;

// A ball before a wall, half hidden by a box; a lamp above.
struct Hall {
  Scene scene = dark_scene();
  Hall() {
    const int grey = matt(scene, Rgb::Constant(0.5F));
    scene.add_static("floor", make_rectangle(20, 20), grey);
    scene.add_static("screen", make_box({0.02, 1.0, 1.0}), grey, pose_at({1.5, -0.5, 0.5}));
    scene.add_static("roof", make_box({0.8, 0.8, 0.02}), grey, pose_at({3.0, 1.5, 0.8}));
    Figure ball;
    ball.name = "ball";
    ball.kind = FigureKind::kBall;
    ball.joints[0].p_PJ = {0, 0, 0.1};
    ball.path = Path::standing({2.5, 0.0, 0.0}, 0.0);
    scene.figures.push_back(ball);
    Part part;
    part.mesh = make_sphere(0.1);
    part.material = grey;
    part.figure = 0;
    scene.parts.push_back(part);
    add_lamp(scene, {3.0, 1.5, 2.75}, 800);
  }
};

const Pose kEye = look_at({0, 0, 0.3}, {2.5, 0, 0.1});

TEST(Truth, AFigureIsSeenAsFarAsItIsNotHidden) {
  Hall hall;
  const CameraModel camera = plain_camera(200, 150, 300);
  const auto renderer = renderer_for(hall.scene, camera);
  RadianceImage image;
  SceneState state = state_at(hall.scene, 0.0);
  renderer->draw(state, kEye, image);

  const FigureView half = figure_view(*renderer, state, kEye, 0, {}, 0);

  const double radius_px = 300 * 0.1 / std::sqrt(2.5 * 2.5 + 0.2 * 0.2);
  EXPECT_NEAR(half.whole_px, kPi * radius_px * radius_px, 0.05 * kPi * radius_px * radius_px);
  EXPECT_NEAR(half.visible_px, half.whole_px / 2.0, 0.12 * half.whole_px)
      << "the screen's edge goes through its middle";
  EXPECT_NEAR(half.whole.width, 2 * radius_px, 1.5);
  EXPECT_NEAR(half.visible.width, radius_px, 1.5);
  EXPECT_GT(half.lit_px, half.visible_px / 4);
  EXPECT_LT(half.lit_px, half.visible_px) << "its lower side is dark";

  hall.scene.figures[0].presence = {{0.0, false, 0}};
  state = state_at(hall.scene, 0.0);
  renderer->draw(state, kEye, image);
  EXPECT_FALSE(figure_view(*renderer, state, kEye, 0).in_view);
}

TEST(Truth, UnderARoofAFigureIsNotLit) {
  Hall hall;
  hall.scene.figures[0].path = Path::standing({3.0, 1.5, 0.0}, 0.0);
  const auto renderer = renderer_for(hall.scene, plain_camera(200, 150, 300));
  const Pose X_WC = look_at({0, 1.5, 0.3}, {3.0, 1.5, 0.1});
  const SceneState state = state_at(hall.scene, 0.0);
  RadianceImage image;
  renderer->draw(state, X_WC, image);
  const FigureView view = figure_view(*renderer, state, X_WC, 0, {}, 0);
  EXPECT_GT(view.visible_px, 100);
  EXPECT_EQ(view.lit_px, 0);
}

// The roof's volume is a box-like pyramid under it: a ray that crosses it is possibly shaded though it ends in the light.
TEST(Truth, PossiblyShadedIsWhereTheRayCrossesTheVolume) {
  const Hall hall;
  const CameraModel camera = plain_camera(100, 75, 90);
  const auto renderer = renderer_for(hall.scene, camera);
  const Pose X_WC = look_at({0.0, 1.5, 0.6}, {6.0, 1.5, 0.2});
  const SceneState state = state_at(hall.scene, 0.0);
  const ShadowMasks masks = shadow_masks(*renderer, state, X_WC, 0);
  const auto at = [&](const std::vector<std::uint8_t>& mask, const Vector3d& p_W) {
    const Vector3d p_C = X_WC.inverse() * p_W;
    const Eigen::Vector2d pixel = project(camera, p_C.head<2>() / p_C.z());
    return mask[static_cast<std::size_t>(std::lround(pixel.y()) * 100 + std::lround(pixel.x()))] == 255;
  };
  // The shadow on the floor reaches 0.4 * 2.75 / 1.96 = 0.56 m around (3, 1.5).
  EXPECT_TRUE(at(masks.surface_shaded, {3.0, 1.5, 0}));
  EXPECT_TRUE(at(masks.possibly_shaded, {3.0, 1.5, 0}));
  EXPECT_FALSE(at(masks.surface_shaded, {4.2, 1.5, 0}));
  EXPECT_TRUE(at(masks.possibly_shaded, {4.2, 1.5, 0})) << "a ball on the way there could be in the shade";
  EXPECT_FALSE(at(masks.surface_shaded, {1.2, 1.5, 0}));
  EXPECT_FALSE(at(masks.possibly_shaded, {1.2, 1.5, 0})) << "before the volume";
  int only_surface = 0;
  for (std::size_t i = 0; i < masks.surface_shaded.size(); ++i)
    only_surface += masks.surface_shaded[i] > masks.possibly_shaded[i] ? 1 : 0;
  EXPECT_EQ(only_surface, 0) << "one mask is inside the other";
}

TEST(Truth, MasksDoNotKnowWhatMoves) {
  Hall hall;
  hall.scene.figures[0].path = Path::standing({2.2, 0.8, 0.0}, 0.0);
  const auto renderer = renderer_for(hall.scene, plain_camera(80, 60, 80));
  const Pose X_WC = look_at({0.0, 0.8, 0.6}, {4.0, 0.8, 0.0});
  const ShadowMasks with = shadow_masks(*renderer, state_at(hall.scene, 0.0), X_WC, 0);
  hall.scene.figures[0].presence = {{0.0, false, 0}};
  RadianceImage image;
  renderer->draw(state_at(hall.scene, 0.0), X_WC, image);
  const ShadowMasks without = shadow_masks(*renderer, state_at(hall.scene, 0.0), X_WC, 0);
  EXPECT_EQ(with.surface_shaded, without.surface_shaded);
  EXPECT_EQ(with.possibly_shaded, without.possibly_shaded);
}

TEST(Truth, ProbeShadowsLieOnTheLineThroughLampAndApex) {
  Scene scene = dark_scene();
  scene.add_static("floor", make_rectangle(20, 20), matt(scene, Rgb::Constant(0.5F)));
  RobotBody body;
  body.has_board = true;
  body.camera_down_rad = degrees(20);
  const int robot = add_robot(scene, body);
  add_lamp(scene, {1.6, 0.5, 2.75}, 900);
  const Pose X_WR = pose_at({0.2, 0.1, 0}, 0.1);
  const SceneState state = state_at(scene, 0.0, {}, {X_WR});
  const auto renderer = renderer_for(scene, CameraModel());
  const Pose X_WC = X_WR * mount_of(scene.robots[0]);
  RadianceImage image;
  renderer->draw(state, X_WC, image);
  const auto shadows = probe_shadows(*renderer, state, X_WC, robot, 0);
  ASSERT_EQ(shadows.size(), 2U);
  for (const ProbeShadow& shadow : shadows) {
    EXPECT_TRUE(shadow.visible);
    EXPECT_NEAR(shadow.p_WS.z(), 0.90, 1e-9);
    const Vector3d along = (shadow.p_WA - shadow.p_WS).normalized();
    EXPECT_LT(along.cross((state.lamps[0].p_WL - shadow.p_WA).normalized()).norm(), 1e-9);
    // What was drawn agrees: just before the tip of the shadow the board is dark, just beyond it is lit.
    const Vector3d foot(shadow.p_WA.x(), shadow.p_WA.y(), 0.90);
    const auto green = [&](const Vector3d& p_W) {
      const Vector3d p_C = X_WC.inverse() * p_W;
      const Eigen::Vector2d pixel = project(renderer->camera(), p_C.head<2>() / p_C.z());
      return image.at(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())))[1];
    };
    const Vector3d outward = (shadow.p_WS - foot).normalized();
    EXPECT_EQ(green(shadow.p_WS - 0.025 * outward), 0.0F);
    EXPECT_GT(green(shadow.p_WS + 0.006 * outward), 1.0F);
  }
}

// The tick as a whole: without an image having been drawn, and the same whatever was asked before.
TEST(Truth, OfATickNeedsNoImage) {
  Hall hall;
  RobotBody body;
  body.name = "looker";
  body.has_board = true;
  body.camera_down_rad = degrees(20);
  const int robot = add_robot(hall.scene, body);
  const Pose X_WR = pose_at({1.6, 1.4, 0}, -0.3);
  const Pose X_WC = X_WR * mount_of(hall.scene.robots[0]);
  const SceneState state = state_at(hall.scene, 0.5, {}, {X_WR});
  const auto renderer = renderer_for(hall.scene, CameraModel().scaled_to(160, 120));

  const Truth truth = truth_at(*renderer, state, X_WC, {robot, 0, true, {}});

  ASSERT_EQ(truth.actors.size(), 1U) << "robots are not actors";
  EXPECT_EQ(truth.actors[0].name, "ball");
  EXPECT_TRUE(truth.actors[0].present);
  EXPECT_LT((truth.actors[0].p_WF - Vector3d(2.5, 0, 0)).norm(), 1e-9);
  ASSERT_EQ(truth.lamps.size(), 1U);
  EXPECT_TRUE(truth.lamps[0].on());
  ASSERT_TRUE(truth.X_WR);
  EXPECT_LT((truth.X_WR->translation() - X_WR.translation()).norm(), 1e-12);
  EXPECT_EQ(truth.probes.size(), 2U);
  ASSERT_TRUE(truth.masks);

  RadianceImage image;
  renderer->draw(state, X_WC, image);
  const FigureView seen = figure_view(*renderer, state, X_WC, 0, {}, 0);
  EXPECT_EQ(truth.actors[0].view.visible_px, seen.visible_px);
  int counted = 0;
  for (const std::int32_t part : renderer->geometry().part)
    counted += part >= 0 && hall.scene.parts[static_cast<std::size_t>(part)].figure == 0 ? 1 : 0;
  EXPECT_EQ(truth.actors[0].view.visible_px, counted) << "as many pixels as the image shows";

  truth_at(*renderer, state_at(hall.scene, 9.0), kEye, {});
  EXPECT_EQ(truth_csv_row(0, truth_at(*renderer, state, X_WC, {robot, 0, true, {}})), truth_csv_row(0, truth));
}

TEST(Truth, OfALampThatIsOffHasNoShadows) {
  Hall hall;
  RobotBody body;
  body.has_board = true;
  const int robot = add_robot(hall.scene, body);
  hall.scene.lamps[0].switch_name = "lamp";
  const auto renderer = renderer_for(hall.scene, CameraModel().scaled_to(80, 60));
  const Truth truth =
      truth_at(*renderer, state_at(hall.scene, 0.0, {}, {Pose::Identity()}), kEye, {robot, 0, true, {}});
  EXPECT_FALSE(truth.lamps[0].on());
  EXPECT_FALSE(truth.masks);
  ASSERT_EQ(truth.probes.size(), 2U);
  EXPECT_FALSE(truth.probes[0].visible);
  EXPECT_EQ(truth.actors[0].view.lit_px, 0);
}

TEST(TruthCsv, EveryRowHasTheHeadersColumns) {
  Hall hall;
  RobotBody body;
  body.has_board = true;
  const int robot = add_robot(hall.scene, body);
  hall.scene.figures[0].name = "ball, \"red\"";
  const auto columns = [](const std::string& line) {
    bool quoted = false;
    int count = 1;
    for (const char c : line) {
      quoted = c == '"' ? !quoted : quoted;
      count += c == ',' && !quoted ? 1 : 0;
    }
    return count;
  };
  const TruthOptions options{robot, 0, false, {}};
  const std::string header = truth_csv_header(hall.scene, options);
  EXPECT_NE(header.find("\"ball, \"\"red\"\".visible_px\""), std::string::npos) << header;
  const auto renderer = renderer_for(hall.scene, CameraModel().scaled_to(80, 60));
  for (const bool there : {true, false}) {
    for (const bool ball : {true, false}) {
      hall.scene.figures[0].presence = {{0.0, ball, 0}};
      const auto robots = there ? std::vector<Pose>{pose_at({1.6, 1.4, 0})} : std::vector<Pose>{};
      const std::string row =
          truth_csv_row(7, truth_at(*renderer, state_at(hall.scene, 0.25, {}, robots), kEye, options));
      EXPECT_EQ(columns(row), columns(header)) << row;
      EXPECT_EQ(row.substr(0, 11), "7,0.250000,");
      EXPECT_EQ(std::count(row.begin(), row.end(), '\n'), 1);
    }
  }
}

TEST(Photographer, SeveralMomentsBlurWhatMoves) {
  Hall hall;
  hall.scene.figures[0].path = *Path::make({{{2.5, 0.2, 0}}, {{2.5, 1.2, 0}, 5.0}}, 0.0, 2.0, false);
  const CameraModel camera = plain_camera(160, 120, 200);
  auto photographer = Photographer::make(hall.scene, camera, {1, 4});
  ASSERT_TRUE(photographer) << photographer.error().message;
  std::vector<std::uint8_t> bytes(160 * 120 * 2);
  const YuyvBuffer buffer{bytes.data(), 160, 120, 320};
  std::vector<Moment> moments;
  RadianceImage mean;
  for (int i = 0; i < 4; ++i) {
    moments.push_back({state_at(hall.scene, 0.02 + 0.01 * i), kEye});
    (*photographer)->take({moments.back()}, {}, {}, buffer);
    if (i == 0) mean = (*photographer)->light();
    for (std::size_t k = 0; k < mean.rgb.size() && i > 0; ++k) mean.rgb[k] += (*photographer)->light().rgb[k];
  }
  (*photographer)->take(moments, {}, {}, buffer);
  for (std::size_t k = 0; k < mean.rgb.size(); ++k) ASSERT_NEAR((*photographer)->light().rgb[k], mean.rgb[k] / 4, 1e-3);
}

}  // namespace
}  // namespace cgsr::sim
