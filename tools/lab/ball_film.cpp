#include "tools/lab/ball_film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "hal/sim/render/truth_images.h"
#include "platform/config/reader.h"
#include "tools/lab/localization/place.h"
#include "tools/lab/scenes/random.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

constexpr double kRadius_m = 0.10;
constexpr double kEvening = 0.45;  // of the home's ambient light: what the window gives
constexpr std::array kLamp_lm{2600.0};
constexpr double kTable_m = 0.74;
constexpr double kBack_m = 5.0;  // from the table
constexpr double kHigh_m = 2.2;  // above what the camera sees
constexpr double kTable_x = 7.15;
constexpr double kMiddle_y = 3.2;

/// About 48 s: above the table, under it in shadow and lit, out of the image and back.
std::vector<BallStop> orange_way() {
  constexpr double kUp = kTable_m + 0.02;
  using enum BallScene;
  return {
      {{kTable_x, kMiddle_y, 0.95}, 0.4, 1.0, kAboveTable},
      {{kTable_x, 3.65, kUp}, 0.4, 0.0, kAboveTable},
      {{kTable_x - 0.2, 2.75, kUp}, 0.4, 0.5, kAboveTable},
      {{kTable_x, 3.5, 1.05}, 0.4, 0.0, kAboveTable},
      {{kTable_x, 2.8, 1.0}, 0.4, 0.0, kOnTheWay},
      {{kTable_x, 1.9, 0.9}, 0.6, 0.0, kOnTheWay},
      {{kTable_x + 0.15, 2.0, 0.0}, 0.7, 0.0, kOnTheWay},
      {{kTable_x + 0.25, 2.7, 0.0}, 0.4, 0.0, kInShadow},
      {{kTable_x + 0.25, 3.6, 0.0}, 0.3, 1.5, kInShadow},
      {{kTable_x + 0.3, 2.8, 0.0}, 0.3, 0.0, kInShadow},
      {{kTable_x + 0.2, 3.2, 0.0}, 0.25, 1.0, kOnTheWay},
      {{kTable_x - 0.32, 3.2, 0.0}, 0.3, 0.5, kUnderLit},
      {{kTable_x - 0.32, 3.6, 0.0}, 0.25, 0.5, kUnderLit},
      {{kTable_x - 0.32, 2.85, 0.0}, 0.25, 1.0, kUnderLit},
      {{kTable_x - 0.32, 3.4, 0.0}, 0.25, 0.0, kOnTheWay},
      {{6.2, 3.6, 0.0}, 0.6, 0.0, kOnTheWay},
      {{5.9, 6.2, 0.9}, 0.9, 2.0, kOnTheWay},  // out of view
      {{6.4, 4.0, 1.0}, 0.9, 0.0, kOnTheWay},
      {{kTable_x, 3.5, 1.0}, 0.6, 0.0, kReturned},
      {{kTable_x, 2.9, kUp}, 0.4, 0.5, kReturned},
      {{kTable_x, 3.3, 1.1}, 0.4, 0.5, kReturned},
      {{kTable_x, 3.3, kHigh_m}, 0.8, 0.0, kBrown},
  };
}

std::vector<BallStop> brown_way() {
  using enum BallScene;
  return {
      {{kTable_x, 3.1, kHigh_m}, 0.8, 0.0, kBrown}, {{kTable_x, 3.1, 1.05}, 0.8, 0.7, kBrown},
      {{kTable_x, 3.6, 1.1}, 0.4, 0.0, kBrown},     {{kTable_x, 2.8, 1.05}, 0.4, 0.0, kBrown},
      {{kTable_x, 3.4, 1.05}, 0.3, 0.0, kBrown},    {{kTable_x, 2.9, 1.1}, 0.3, 1000.0, kBrown},
  };
}

sim::BallSpec ball(const std::string& name, sim::WalkSpec walk, std::vector<sim::PresenceSpec> is_there) {
  sim::BallSpec spec;
  spec.name = name;
  spec.material = name;
  spec.radius_m = kRadius_m;
  spec.walk = std::move(walk);
  spec.presence = std::move(is_there);
  return spec;
}

sim::MaterialSpec paint(const std::string& name, const std::array<double, 3>& albedo) {
  sim::MaterialSpec spec;
  spec.name = name;
  spec.albedo = albedo;
  return spec;
}

/// The evening in the home: one lamp with a soft shadow, little else.
void light_up(sim::WorldSpec& spec) {
  spec.lamp.resize(1);
  spec.lamp[0].radius_m = 0.05;
  spec.lamp[0].globe_radius_m = 0.0;
  spec.lamp[0].lumens = kLamp_lm[0];
  spec.lamp[0].on = true;
  spec.lamp[0].switch_name.clear();
  for (double& lux : spec.ambient.illuminance_lux) lux *= kEvening;
}

}  // namespace

std::string_view to_string(BallScene scene) {
  constexpr std::array<std::string_view, kBallScenes> kNames{"above the table", "on the way", "under it, in shadow",
                                                             "under it, lit",   "returned",   "brown ball above it"};
  return kNames.at(static_cast<std::size_t>(scene));
}

sim::WalkSpec ball_walk(const std::vector<BallStop>& stops, double start_s, Random& random, BallScenes& scenes) {
  sim::WalkSpec walk;
  walk.start_s = start_s;
  double now_s = start_s;
  std::array<double, 3> last = stops.front().at_m;
  for (const BallStop& stop : stops) {
    sim::StopSpec spec;
    spec.at_m = {stop.at_m[0] + random.uniform(-0.02, 0.02), stop.at_m[1] + random.uniform(-0.05, 0.05), stop.at_m[2]};
    if (walk.stop.empty()) last = spec.at_m;
    spec.speed_mps = stop.speed_mps * random.uniform(0.95, 1.05);
    spec.wait_s = stop.wait_s;
    now_s += std::hypot(spec.at_m[0] - last[0], spec.at_m[1] - last[1], spec.at_m[2] - last[2]) / spec.speed_mps;
    scenes.emplace_back(now_s, stop.then);
    now_s += spec.wait_s;
    last = spec.at_m;
    walk.stop.push_back(spec);
  }
  return walk;
}

Result<std::unique_ptr<BallFilm>> BallFilm::make(std::uint64_t seed) {
  const std::filesystem::path file = std::filesystem::path(source_path("config/worlds")) / "home.toml";
  auto spec = config::read_file<sim::WorldSpec>(file);
  if (!spec) return tl::unexpected(spec.error());
  std::erase_if(spec->robot, [](const sim::RobotSpec& robot) { return !robot.has_board; });
  if (spec->robot.empty()) return fail("home.toml: there is no robot with a probe board");
  spec->object.clear();
  light_up(*spec);
  Random random = Random(seed).fork(0xBA11);
  Script script;
  script.errors = sim::CalibrationErrors::none();
  script.orange = ball_walk(orange_way(), 0.5, random, script.scenes);
  BallScenes of_brown;
  script.brown = ball_walk(brown_way(), script.scenes.back().first, random, of_brown);
  const double aside_m = random.uniform(-0.25, 0.25);
  const double turned_deg = random.uniform(-3.0, 3.0);
  spec->robot[0].start_m = {kTable_x - kBack_m + random.uniform(-0.2, 0.2), kMiddle_y + aside_m, 0.0};
  spec->robot[0].start_heading_deg = turned_deg;
  return make(std::move(*spec), file, std::move(script), seed);
}

Result<std::unique_ptr<BallFilm>> BallFilm::make(sim::WorldSpec world, const std::filesystem::path& name, Script script,
                                                 std::uint64_t seed) {
  world.material.push_back(paint("orange ball", {0.93, 0.47, 0.12}));
  world.material.push_back(paint("brown ball", {0.46, 0.25, 0.10}));
  world.ball = {ball("orange ball", std::move(script.orange), std::move(script.orange_is_there)),
                ball("brown ball", std::move(script.brown), std::move(script.brown_is_there))};
  auto built = sim::build_world(world, name);
  if (!built) return tl::unexpected(built.error());
  std::unique_ptr<BallFilm> film(new BallFilm(std::move(*built), seed));
  const sim::Scene& scene = film->world_.scene;
  film->scenes_ = std::move(script.scenes);
  for (std::size_t i = 0; i < scene.figures.size(); ++i) {
    if (scene.figures[i].name == "orange ball") film->orange_ = static_cast<int>(i);
    if (scene.figures[i].name == "brown ball") film->brown_ = static_cast<int>(i);
  }
  film->X_WC_ = sim::scripted_robots(film->world_, 0.0).front() * sim::mount_of(scene.robots.front());
  const sim::CalibratedCopy copy = sim::calibrated_copy(scene, 0, script.errors, static_cast<std::uint32_t>(seed));
  film->camera_ = camera_of(copy.camera);
  auto map = map_of(copy.map);
  if (!map) return tl::unexpected(map.error());
  film->map_ = std::move(*map);
  auto photographer =
      sim::CachedPhotographer::make(scene, scene.robots.front().camera, {}, {.folder = sim::image_cache_folder()});
  if (!photographer) return tl::unexpected(photographer.error());
  film->photographer_ = std::move(*photographer);
  return film;
}

BallFilm::Shot BallFilm::shoot(int number) {
  const double at_s = number / kRate_hz;
  const std::vector<sim::Pose> X_WR = sim::scripted_robots(world_, at_s);
  const sim::SceneState state = sim::state_at(world_.scene, at_s, {}, X_WR);
  const sim::CameraModel& camera = world_.scene.robots.front().camera;
  std::vector<std::uint8_t> yuyv(std::size_t{2} * static_cast<std::size_t>(camera.width_px * camera.height_px));
  photographer_->take({{state, X_WC_}}, world_.sensor,
                      {static_cast<std::uint32_t>(seed_), static_cast<std::uint64_t>(number)},
                      {yuyv.data(), camera.width_px, camera.height_px, std::ptrdiff_t{2} * camera.width_px});
  Shot shot{
      image_of_yuyv(std::move(yuyv), camera.width_px, camera.height_px), BallScene::kAboveTable, {}, {}, 0.0, 0.0};
  for (const auto& [from_s, scene] : scenes_) {
    if (at_s >= from_s) shot.scene = scene;
  }
  sim::Renderer& renderer = photographer_->renderer();
  renderer.move_to(state);
  const sim::FigureView orange = sim::figure_view(renderer, state, X_WC_, orange_, {}, 0);
  const sim::FigureView brown = sim::figure_view(renderer, state, X_WC_, brown_);
  if (orange.in_view) shot.orange = orange.visible;
  if (brown.in_view) shot.brown = brown.visible;
  shot.lit = orange.lit_px / std::max(1.0, static_cast<double>(orange.visible_px));
  shot.orange_height_m = state.X_WJ[static_cast<std::size_t>(orange_)].front().translation().z() - kRadius_m;
  return shot;
}

}  // namespace cgsr::lab
