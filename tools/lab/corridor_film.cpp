#include "tools/lab/corridor_film.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "hal/sim/render/truth_images.h"
#include "platform/config/reader.h"
#include "tools/lab/scenes/random.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

constexpr int kHueBins = 36;
constexpr int kLeastSaturation = 60;  // of 255, as for CAM-Shift: below, a hue means nothing
constexpr int kLeastValue = 32;

/// What one take has of its own.
void vary(sim::WorldSpec& spec, std::uint64_t seed) {
  Random random = Random(seed).fork(0xC0);
  sim::PersonSpec& walker = spec.person.front();
  walker.identity = random.below(sim::kIdentities);
  walker.height_m = random.uniform(1.65, 1.85);
  walker.walk.start_s += random.uniform(-0.3, 0.3);
  sim::RobotSpec& camera = spec.robot.front();
  camera.camera_down_deg += random.uniform(-1.5, 1.5);
  const double nearer_m = random.uniform(-0.3, 0.2);
  const double aside_m = random.uniform(-0.1, 0.1);
  for (sim::StopSpec& stop : walker.walk.stop) stop.at_m[1] += random.uniform(-0.1, 0.1);
  for (sim::StopSpec& stop : camera.walk.stop) {
    stop.at_m[0] += nearer_m;
    stop.at_m[1] += aside_m;
  }
}

int hue_bin(const cv::Vec3b& hsv) {
  return hsv[0] * kHueBins / 180;
}

bool has_hue(const cv::Vec3b& hsv) {
  return hsv[1] >= kLeastSaturation && hsv[2] >= kLeastValue;
}

}  // namespace

Result<std::unique_ptr<CorridorFilm>> CorridorFilm::make(std::uint64_t seed) {
  const std::filesystem::path file = std::filesystem::path(source_path("config/worlds")) / "corridor.toml";
  auto spec = config::read_file<sim::WorldSpec>(file);
  if (!spec) return tl::unexpected(spec.error());
  vary(*spec, seed);
  auto world = sim::build_world(*spec, file);
  if (!world) return tl::unexpected(world.error());
  std::unique_ptr<CorridorFilm> film(new CorridorFilm(std::move(*world), seed));
  const sim::Scene& scene = film->world_.scene;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (scene.parts[i].name != "walker/shirt") continue;
    film->shirt_ = static_cast<int>(i);
    film->walker_ = scene.parts[i].figure;
  }
  if (film->shirt_ < 0) return fail("corridor.toml: there is nobody called 'walker'");
  auto photographer = sim::Photographer::make(scene, scene.robots.front().camera, {});
  if (!photographer) return tl::unexpected(photographer.error());
  film->photographer_ = std::move(*photographer);
  film->first_radiance_ = {1.0, 1.0, 1.0};
  film->shoot(0);
  film->first_radiance_ = film->shirt_radiance();
  return film;
}

CorridorFilm::Shot CorridorFilm::shoot(int number) {
  const double at_s = number / kRate_hz;
  const std::vector<sim::Pose> X_WR = sim::scripted_robots(world_, at_s);
  sim::SwitchStates on;
  for (const sim::Lamp& lamp : world_.scene.lamps) on[lamp.switch_name] = true;
  const sim::Moment moment{sim::state_at(world_.scene, at_s, on, X_WR),
                           X_WR.front() * sim::mount_of(world_.scene.robots.front())};
  const sim::CameraModel& camera = world_.scene.robots.front().camera;
  std::vector<std::uint8_t> yuyv(std::size_t{2} * static_cast<std::size_t>(camera.width_px * camera.height_px));
  photographer_->take({moment}, world_.sensor, {static_cast<std::uint32_t>(seed_), static_cast<std::uint64_t>(number)},
                      {yuyv.data(), camera.width_px, camera.height_px, std::ptrdiff_t{2} * camera.width_px});
  Shot shot{image_of_yuyv(std::move(yuyv), camera.width_px, camera.height_px), {}};
  const sim::FigureView seen =
      sim::figure_view(photographer_->renderer(), moment.state, moment.X_WC, walker_, {shirt_});
  if (seen.in_view) shot.truth.shirt = seen.visible;
  const Light radiance = shirt_radiance();
  shot.truth.light = {radiance.r / first_radiance_.r, radiance.g / first_radiance_.g, radiance.b / first_radiance_.b};
  return shot;
}

/// The mean over the shirt's pixels in the last image.
Light CorridorFilm::shirt_radiance() const {
  const sim::GeometryImage& seen = photographer_->renderer().geometry();
  const std::vector<float>& rgb = photographer_->light().rgb;
  Light sum;
  int count = 0;
  for (std::size_t i = 0; i < seen.part.size(); ++i) {
    if (seen.part[i] != shirt_) continue;
    sum = {sum.r + rgb[3 * i], sum.g + rgb[3 * i + 1], sum.b + rgb[3 * i + 2]};
    ++count;
  }
  const double n = std::max(1, count);
  return {sum.r / n, sum.g / n, sum.b / n};
}

CorridorFilm::Scene CorridorFilm::scene_of(const Shot& shot) const {
  const sim::GeometryImage& seen = photographer_->renderer().geometry();
  cv::Mat hsv;
  cv::cvtColor(shot.image.bgr, hsv, cv::COLOR_BGR2HSV);
  std::vector<int> brightest;
  std::array<int, kHueBins> of_shirt{};
  std::array<int, kHueBins> of_background{};
  int background = 0;
  double value = 0.0;
  for (std::size_t i = 0; i < seen.part.size(); ++i) {
    const cv::Vec3b& color = hsv.at<cv::Vec3b>(static_cast<int>(i));
    const std::int32_t part = seen.part[i];
    value += color[2] / 255.0;
    if (part == shirt_) {
      brightest.push_back(color[2]);
      if (has_hue(color)) ++of_shirt[static_cast<std::size_t>(hue_bin(color))];
    } else if (part < 0 || world_.scene.parts[static_cast<std::size_t>(part)].figure < 0) {
      ++background;
      if (has_hue(color)) ++of_background[static_cast<std::size_t>(hue_bin(color))];
    }
  }
  Scene scene;
  scene.mean_luma = value / static_cast<double>(seen.part.size());
  int strong = 0;
  for (const int count : of_shirt) strong += count;
  for (std::size_t bin = 0; bin < kHueBins; ++bin) {
    if (of_shirt[bin] * 20 > strong) scene.background_of_its_hues += of_background[bin];
  }
  scene.background_of_its_hues /= std::max(1, background);
  std::ranges::sort(brightest);
  if (!brightest.empty()) scene.near_white = brightest[brightest.size() * 9 / 10] / 255.0;
  return scene;
}

Light CorridorFilm::scripted_light(double at_s) const {
  const sim::Rgb factor = sim::factor_at(world_.scene.ambient.script, at_s);
  return {factor[0], factor[1], factor[2]};
}

}  // namespace cgsr::lab
