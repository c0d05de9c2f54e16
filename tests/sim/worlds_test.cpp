#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "hal/sim/render/sensor.h"
#include "hal/sim/render/truth_images.h"
#include "hal/sim/scene/map_count.h"
#include "hal/sim/scene/portable_math.h"
#include "hal/sim/worlds/planar_world.h"
#include "hal/sim/worlds/world.h"
#include "platform/config/documentation.h"
#include "platform/config/reader.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

using testing::HasSubstr;

Result<World> load(const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(CGSR_SOURCE_DIR) / "config/worlds" / name;
  const auto spec = config::read_file<WorldSpec>(file);
  if (!spec) return tl::unexpected(spec.error());
  return build_world(*spec, file);
}

// What the first robot's camera sees by script.
struct Shot {
  SceneState state;
  Pose X_WC;
  cv::Mat bgr;
  RadianceImage light;
};

Shot shoot(const World& world, Renderer& renderer, double at_s, bool noise = false) {
  static const Sensor sensor;
  Shot shot;
  const std::vector<Pose> X_WR = scripted_robots(world, at_s);
  SwitchStates on;
  for (const Lamp& lamp : world.scene.lamps) on[lamp.switch_name] = true;
  shot.state = state_at(world.scene, at_s, on, {X_WR[0]});
  shot.X_WC = X_WR[0] * mount_of(world.scene.robots[0]);
  renderer.draw(shot.state, shot.X_WC, shot.light);
  cv::Mat yuyv(shot.light.height_px, shot.light.width_px, CV_8UC2);
  SensorSettings settings = world.sensor;
  settings.noise = noise;
  sensor.measure(shot.light, settings, 1, 0, {yuyv.data, yuyv.cols, yuyv.rows, yuyv.cols * 2}, renderer.workers());
  cv::cvtColor(yuyv, shot.bgr, cv::COLOR_YUV2BGR_YUYV);
  return shot;
}

TEST(Worlds, AllAreFitToBeRenderedAndNeitherDarkNorWhite) {
  int worlds = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(CGSR_SOURCE_DIR) / "config/worlds")) {
    if (entry.path().extension() != ".toml") continue;
    const auto world = load(entry.path().filename().string());
    ASSERT_TRUE(world) << world.error().message;
    EXPECT_EQ(world->scene.name, entry.path().stem().string());
    const auto renderer = renderer_for(world->scene, CameraModel().scaled_to(80, 60));
    const Shot shot = shoot(*world, *renderer, 0.0);
    const cv::Scalar mean = cv::mean(shot.bgr);
    const double brightness = (mean[0] + mean[1] + mean[2]) / 3;
    EXPECT_GT(brightness, 60) << entry.path();
    EXPECT_LT(brightness, 190) << entry.path();
    ++worlds;
  }
  EXPECT_GE(worlds, 6);
}

TEST(WorldsGolden, MapsHaveTheStatedSize) {
  const auto size = [](const char* name) {
    const auto world = load(name);
    EXPECT_TRUE(world) << world.error().message;
    const MapCount count = world ? count_map(world->scene) : MapCount{};
    return std::pair{count.surfaces, count.edges};
  };
  EXPECT_EQ(size("planar.toml"), (std::pair{169, 456}));
  EXPECT_EQ(size("occlusion.toml"), (std::pair{71, 147}));
  EXPECT_NEAR(size("home.toml").first, 530, 50);
}

TEST(WorldsProperty, ThePlanarWorldScales) {
  for (const int edges : {50, 150, 450, 456, 1250, 3725}) {
    for (const bool half : {false, true}) {
      WorldSpec spec;
      spec.name = "planar";
      spec.planar = {edges, half};
      spec.robot.resize(1);
      const auto world = build_world(spec, "planar.toml");
      ASSERT_TRUE(world) << world.error().message;
      const MapCount count = count_map(world->scene);
      EXPECT_LE(count.edges, half ? 2 * edges : edges);
      EXPECT_GT(count.edges, (half ? 2 * edges : edges) - 24) << edges;
    }
  }
}

TEST(Worlds, TheirPageSaysWhatTheReaderReads) {
  std::ifstream file(std::filesystem::path(CGSR_SOURCE_DIR) / "docs/worlds.md");
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_THAT(page, HasSubstr(config::markdown<WorldSpec>())) << "build/release/world_docs > docs/worlds.md";
}

std::string problems(const std::string& toml) {
  const auto document = config::Document::parse(toml, "bad.toml");
  if (!document) return document.error().message;
  const auto spec = config::read<WorldSpec>(*document);
  if (!spec) return spec.error().message;
  const auto world = build_world(*spec, "bad.toml");
  return world ? "" : world.error().message;
}

const std::string kGood = R"(name = "good"
[[material]]
name = "grey"
[[shape]]
name = "box"
material = "grey"
size_m = [1, 1, 1]
position_m = [3, 0, 0]
[[robot]]
)";

TEST(WorldFault, EveryMistakeIsNamedWithItsLine) {
  EXPECT_EQ(problems(kGood), "");
  EXPECT_THAT(problems(kGood + "[[shape]]\nname = \"m\"\nkind = \"mesh\"\nfile = \"none.obj\"\n"),
              HasSubstr("bad.toml:10: shape 'm': none.obj"));
  EXPECT_THAT(problems(kGood + "[[shape]]\nname = \"m\"\nmaterial = \"grey\"\nsize_m = [1, 2e3, 1]\n"),
              HasSubstr("2000 is not in 0..1000 m"));
  EXPECT_THAT(problems(kGood + "[[shape]]\nname = \"m\"\nmaterial = \"grey\"\nsize_m = [1, 1e-4, 1]\n"),
              HasSubstr("below 1 mm"));
  EXPECT_THAT(problems(kGood + "[[shape]]\nname = \"m\"\nmaterial = \"grey\"\nsize_m = [1, nan, 1]\n"),
              HasSubstr("bad.toml:13: shape[1].size_m[1] = nan"));
  EXPECT_THAT(problems(kGood + "[[shape]]\nname = \"m\"\nmaterial = \"oak\"\nsize_m = [1, 1, 1]\n"),
              HasSubstr("bad.toml:10: shape 'm': there is no material 'oak'"));
  EXPECT_THAT(problems(kGood + "[[lamp]]\nposition_m = [3, 0, 0.5]\n"),
              HasSubstr("bad.toml:10: lamp 'lamp' is inside 'box' (line 4)"));
  EXPECT_THAT(problems(kGood + "[[lamp]]\ncarried_by = \"nobody\"\n"), HasSubstr("there is no robot 'nobody'"));
  EXPECT_THAT(problems(kGood + "[[lamp]]\nlumen = 5\n"),
              HasSubstr("bad.toml:11: lamp[0].lumen is unknown; did you mean"));
  EXPECT_THAT(problems(kGood + "[[ball]]\nname = \"robot\"\nmaterial = \"grey\"\n"),
              HasSubstr("something else of that name"));
  EXPECT_THAT(problems("name = \"x\"\n"), HasSubstr("there is no [[robot]], and so no camera"));
  EXPECT_THAT(problems("name = \"x\"\n[[robot]]\nname = \"r\"\n[shape]\n"),
              HasSubstr("expected a list of sections [[shape]]"));
}

TEST(WorldFault, AllMistakesComeAtOnce) {
  const std::string all = problems(
      "[[shape]]\nname = \"a\"\nmaterial = \"oak\"\nsize_m = [1, 1, 1]\n[[shape]]\nname = \"b\"\nmaterial = "
      "\"elm\"\nsize_m = [1, 1, 1]\n"
      "[[lamp]]\nposition_m = [0, 0, 0.5]\n");
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 3) << all;
}

// Cut anywhere and with any byte changed, a world file is read, refused or built, never worse.
TEST(WorldFuzzProperty, DamagedFilesAreRefusedOrBuilt) {
  Seeded random(99);
  const std::string good = kGood +
                           "[[person]]\nname = \"p\"\nwalk = { stop = [{ at_m = [1, 2, 0] }] }\n[[ball]]\nmaterial = "
                           "\"grey\"\n[[lamp]]\nscript = [{ at_s = 1 }]\n";
  int built = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::string damaged = good;
    for (int i = 0; i < trial % 3; ++i) {
      const auto at = static_cast<std::size_t>(random.uniform(0, static_cast<double>(damaged.size())));
      damaged[at] = static_cast<char>(random.uniform(9, 127));
    }
    if (trial % 5 == 0)
      damaged.resize(static_cast<std::size_t>(random.uniform(0, static_cast<double>(damaged.size()))));
    const auto document = config::Document::parse(damaged, "damaged.toml");
    if (!document) continue;
    const auto spec = config::read<WorldSpec>(*document);
    if (!spec) continue;
    WorldSpec nobody = *spec;
    nobody.person.clear();  // their faces take long to paint
    built += build_world(nobody, "damaged.toml") ? 1 : 0;
  }
  EXPECT_GT(built, 100);
  EXPECT_LT(built, 300);
}

TEST(HomeWorld, TheTableStandsBesideTheLampAndPartOfTheFloorUnderItIsLit) {
  const auto world = load("home.toml");
  ASSERT_TRUE(world) << world.error().message;
  const auto renderer = renderer_for(world->scene, CameraModel().scaled_to(160, 120));
  const SceneState state = state_at(world->scene, 0.0, {{"living lamp", true}});
  const ShadowMasks masks = shadow_masks(*renderer, state, look_at({4.5, 3.2, 0.5}, {7.15, 3.2, 0.15}), 0);
  const auto shaded = [&](double x, double y) {
    const Pose X_WC = look_at({4.5, 3.2, 0.5}, {7.15, 3.2, 0.15});
    const Eigen::Vector3d p_C = X_WC.inverse() * Eigen::Vector3d(x, y, 0.0);
    const Eigen::Vector2d at = project(renderer->camera(), p_C.head<2>() / p_C.z());
    return masks.surface_shaded[static_cast<std::size_t>(std::lround(at.y()) * 160 + std::lround(at.x()))] == 255;
  };
  // The near edge of the table's top, x = 6.75 at 0.74 m, throws its shadow to x = 6 + 0.75 * 2.75 / 2.01 = 7.03 and more.
  EXPECT_FALSE(shaded(6.88, 3.2));
  EXPECT_TRUE(shaded(7.25, 3.2));
}

TEST(CorridorWorld, IsTheExperimentOfFigure33) {
  const auto world = load("corridor.toml");
  ASSERT_TRUE(world) << world.error().message;
  const auto renderer = renderer_for(world->scene, CameraModel().scaled_to(320, 240));
  int shirt = -1;
  for (std::size_t i = 0; i < world->scene.parts.size(); ++i) {
    if (world->scene.parts[i].name == "walker/shirt") shirt = static_cast<int>(i);
  }
  double before = 0.0;
  double after = 0.0;
  double shares = 0.0;
  for (const double at_s : {1.0, 5.0, 9.0, 13.0, 16.5, 20.5, 25.0, 31.0, 38.0}) {
    const Shot shot = shoot(*world, *renderer, at_s);
    const FigureView walker = figure_view(*renderer, shot.state, shot.X_WC, 0);
    EXPECT_EQ(walker.visible_px, walker.whole_px);
    EXPECT_GT(walker.visible_px, 4000);
    // The shirt's hues: of its strongly coloured pixels; near-white: its brightest ones.
    cv::Mat hsv;
    cv::cvtColor(shot.bgr, hsv, cv::COLOR_BGR2HSV);
    int background = 0;
    int of_its_hue = 0;
    std::vector<int> red;
    double light = 0.0;
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        const std::int32_t part = renderer->geometry().part[static_cast<std::size_t>(y * 320 + x)];
        const cv::Vec3b c = hsv.at<cv::Vec3b>(y, x);
        const int from_red = std::min<int>(c[0], 180 - c[0]);
        if (part == shirt) {
          red.push_back(shot.bgr.at<cv::Vec3b>(y, x)[2]);
          light += static_cast<double>(shot.light.at(x, y)[1]);
        } else if (part < 0 || world->scene.parts[static_cast<std::size_t>(part)].figure < 0) {
          ++background;
          of_its_hue += from_red <= 10 && c[1] > 80 ? 1 : 0;
        }
      }
    }
    std::sort(red.begin(), red.end());
    light /= static_cast<double>(red.size());
    const double share = static_cast<double>(of_its_hue) / background;
    shares += share / 9;
    EXPECT_GT(share, 0.2) << at_s;
    const int near_white = red[red.size() * 9 / 10];
    std::printf("%4.1f s: near-white encodes to %.3f, light %.0f, %.0f %% of the background share its hue\n", at_s,
                near_white / 255.0, light, 100.0 * share);
    if (at_s == 1.0) {
      EXPECT_GE(near_white, 0.95 * 255);
    }
    (at_s < 17 ? before : after) += light;
  }
  EXPECT_NEAR((after / 4) / (before / 5), 0.5, 0.1);
  EXPECT_NEAR(shares, 1.0 / 3.0, 0.1);
}

}  // namespace
}  // namespace cgsr::sim
