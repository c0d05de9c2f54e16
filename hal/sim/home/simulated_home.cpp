#include "hal/sim/home/simulated_home.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "hal/sim/home/plan.h"
#include "hal/sim/home/simulated_camera.h"
#include "hal/sim/render/truth_images.h"
#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

MonoTime at_seconds(double time_s) {
  return MonoTime{seconds(time_s)};
}

double in_seconds(MonoTime time) {
  return to_seconds(time.time_since_epoch());
}

std::vector<SwitchLine> lines_of(const ScenarioSpec& spec) {
  std::vector<SwitchLine> lines;
  for (const LineSpec& line : spec.line) lines.push_back({line.name, line.input});
  return lines;
}

std::vector<SwitchEvent> line_script(const ScenarioSpec& spec) {
  std::vector<SwitchEvent> script;
  for (const auto& event : spec.line_event) {
    script.push_back({event.what, event.line, at_seconds(event.from_s), at_seconds(event.to_s)});
  }
  return script;
}

std::vector<BusEvent> bus_script(const ScenarioSpec& spec) {
  std::vector<BusEvent> script;
  for (const auto& event : spec.bus_event) {
    hal::CanFrame frame;
    frame.id = static_cast<std::uint16_t>(event.id);
    frame.size = 8;
    script.push_back({event.what, at_seconds(event.from_s), at_seconds(event.to_s), frame});
  }
  return script;
}

std::vector<BaseEvent> base_script(const ScenarioSpec& spec) {
  std::vector<BaseEvent> script;
  for (const auto& event : spec.base_event) {
    script.push_back({event.what, at_seconds(event.from_s), at_seconds(event.to_s),
                      static_cast<std::uint16_t>(event.word1), static_cast<std::uint16_t>(event.word2)});
  }
  return script;
}

std::size_t robot_named(const World& world, const std::string& name) {
  for (std::size_t i = 0; i < world.scene.robots.size(); ++i) {
    if (world.scene.robots[i].name == name) return i;
  }
  return 0;
}

int figure_named(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.figures.size() && !name.empty(); ++i) {
    if (scene.figures[i].name == name && scene.figures[i].kind != FigureKind::kRobot) return static_cast<int>(i);
  }
  return -1;
}

/// The pieces of a figure that a scenario names.
Result<std::vector<int>> parts_named(const Scene& scene, int figure, const std::vector<ObjectPartSpec>& names) {
  std::vector<int> parts;
  for (const ObjectPartSpec& wanted : names) {
    const std::size_t before = parts.size();
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
      if (scene.parts[i].figure == figure && scene.parts[i].name == wanted.name) parts.push_back(static_cast<int>(i));
    }
    if (parts.size() == before) return fail(fmt::format("object_part '{}': the object has no such piece", wanted.name));
  }
  return parts;
}

BasePlacement placement_of(const Scenario& scenario, const World& world, std::size_t robot, int seed) {
  const Pose& X_WR = world.X_WR_start[robot];
  const auto& walk = world.robot_walks[robot];
  BasePlacement placement;
  placement.x_m = X_WR.translation().x();
  placement.y_m = X_WR.translation().y();
  placement.heading_rad = walk ? walk->at(0.0).heading_rad : degrees(scenario.world.robot[robot].start_heading_deg);
  placement.seed = static_cast<std::uint64_t>(seed);
  return placement;
}

/// The robot's frame in the world, leaning about its axle.
Pose leaning(const BaseState& base, double axle_height_m) {
  Pose X_WR = pose_at({base.x_m, base.y_m, 0.0}, base.heading_rad);
  const double s = sine(base.pitch_rad);
  const double c = cosine(base.pitch_rad);
  Pose lean = Pose::Identity();
  lean.linear() << c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c;  // about +y, the left: positive leans forward
  const Eigen::Vector3d axle(0.0, 0.0, axle_height_m);
  lean.translation() = axle - lean.linear() * axle;
  return X_WR * lean;
}

/// The lamp that lights a place most, as if nothing stood between; -1: none burns.
int lamp_near(const SceneState& state, const Eigen::Vector3d& p_W) {
  int nearest = -1;
  double most = 0.0;
  for (std::size_t i = 0; i < state.lamps.size(); ++i) {
    const double light = static_cast<double>(state.lamps[i].intensity_cd.maxCoeff()) /
                         std::max(1e-6, (state.lamps[i].p_WL - p_W).squaredNorm());
    if (light <= most) continue;
    most = light;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

/// The lines as the robot's program has them, while the home looks at their levels.
class LinesPort final : public hal::Switches {
 public:
  explicit LinesPort(std::shared_ptr<SimulatedSwitches> lines) : lines_(std::move(lines)) {}
  Result<void> start() override { return lines_->start(); }
  [[nodiscard]] std::vector<std::string> names() const override { return lines_->names(); }
  Result<void> set(std::string_view name, bool on) override { return lines_->set(name, on); }
  Result<bool> read(std::string_view name) override { return lines_->read(name); }
  void stop() override { lines_->stop(); }

 private:
  std::shared_ptr<SimulatedSwitches> lines_;
};

}  // namespace

Result<std::unique_ptr<SimulatedHome>> SimulatedHome::make(const hal::SimulationParameters& parameters) {
  if (parameters.scenario.empty()) return fail("sim.scenario is empty: what shall be simulated?");
  if (parameters.width_px % 2 != 0) return fail(fmt::format("sim.width_px = {} is odd", parameters.width_px));
  auto scenario = load_scenario(parameters.scenario, static_cast<std::uint32_t>(parameters.seed));
  if (!scenario) return tl::unexpected(scenario.error());
  auto world = build_world(scenario->world, scenario->world_file);
  if (!world) return tl::unexpected(world.error());
  std::unique_ptr<SimulatedHome> home(new SimulatedHome(parameters, std::move(*scenario), std::move(*world)));
  if (auto opened = home->open_camera(); !opened) return tl::unexpected(opened.error());
  return home;
}

SimulatedHome::SimulatedHome(const hal::SimulationParameters& parameters, Scenario scenario, World world)
    : parameters_(parameters),
      scenario_(std::move(scenario)),
      world_(std::move(world)),
      robot_(robot_named(world_, scenario_.spec.robot)),
      object_(figure_named(world_.scene, scenario_.spec.object)),
      segway_(scenario_.spec.base, placement_of(scenario_, world_, robot_, parameters.seed),
              base_script(scenario_.spec), bus_script(scenario_.spec)),
      switches_(std::make_shared<SimulatedSwitches>(lines_of(scenario_.spec), line_script(scenario_.spec))),
      sensor_(world_.sensor) {}

Result<void> SimulatedHome::open_camera() {
  auto parts = parts_named(world_.scene, object_, scenario_.spec.object_part);
  if (!parts) return fail(fmt::format("{}: {}", parameters_.scenario, parts.error().message));
  object_parts_ = std::move(*parts);
  const CameraSpec& spec = scenario_.spec.camera;
  camera_ = world_.scene.robots[robot_].camera.scaled_to(parameters_.width_px, parameters_.height_px);
  if (!spec.distortion) camera_ = camera_.without_distortion();
  sensor_.noise = spec.noise;
  const double longest_s = spec.automatic_exposure ? AutoExposure{}.longest_exposure_s : 0.0;
  image_delay_ = seconds(std::max(sensor_.exposure_s, longest_s));
  const auto source = image_source();
  if (!source) return tl::unexpected(source.error());
  CacheOptions cache;
  if (parameters_.cache || *source != ImageSource::kRobotFile) cache.folder = image_cache_folder();
  cache.draws = *source != ImageSource::kRecorded;
  auto photographer = CachedPhotographer::make(world_.scene, camera_, {parameters_.threads, spec.edge_samples}, cache);
  if (!photographer) return tl::unexpected(photographer.error());
  photographer_ = std::move(*photographer);
  plan_ = make_plan(world_.scene);
  plan_.view_angle_rad = 2.0 * std::atan(0.5 * camera_.width_px / camera_.fx_px);
  return {};
}

std::unique_ptr<hal::Camera> SimulatedHome::take_camera() {
  const hal::CameraMode mode{camera_.width_px, camera_.height_px, PixelFormat::kYuyv, seconds(1.0 / camera_.rate_hz)};
  return std::make_unique<SimulatedCamera>(
      mode, image_delay_, at_seconds(scenario_.spec.ends_at_s), scenario_.spec.camera_event,
      [this](std::uint64_t number, MonoTime stamp, const YuyvBuffer& buffer) { take_image(number, stamp, buffer); },
      [this] { return now_.load(); });
}

std::unique_ptr<hal::Switches> SimulatedHome::take_switches() {
  return std::make_unique<LinesPort>(switches_);
}

void SimulatedHome::advance_to(MonoTime time) {
  now_ = std::max(now_.load(), time);
  switches_->advance_to(time);
  segway_.base().advance_to(time);
}

Moment SimulatedHome::moment_at(MonoTime time) {
  const double time_s = in_seconds(time);
  std::vector<Pose> X_WR = scripted_robots(world_, time_s);
  X_WR[robot_] = leaning(segway_.base().state_at(time), segway_.base().axle_height_m());
  Moment moment;
  moment.state = state_at(world_.scene, time_s, switched_at(time_s), X_WR);
  heed_robot(world_.scene, X_WR[robot_], moment.state);
  for (std::size_t i = 0; i < world_.scene.robots.size(); ++i) {  // the file's other robots are for other scenarios
    if (i != robot_) moment.state.presence[static_cast<std::size_t>(world_.scene.robots[i].figure)].present = false;
  }
  moment.X_WC = X_WR[robot_] * mount_of(world_.scene.robots[robot_]);
  return moment;
}

void SimulatedHome::take_image(std::uint64_t number, MonoTime stamp, const YuyvBuffer& buffer) {
  const int count = scenario_.spec.camera.blur_moments;
  std::vector<Moment> moments;
  moments.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) moments.push_back(moment_at(stamp + seconds(sensor_.exposure_s * (i + 0.5) / count)));
  const double luma =
      photographer_->take(moments, sensor_, {static_cast<std::uint32_t>(parameters_.seed), number}, buffer);
  remember(stamp, stamp + seconds(0.5 * sensor_.exposure_s), moments[moments.size() / 2]);
  if (scenario_.spec.camera.automatic_exposure) sensor_ = AutoExposure{}.next(sensor_, luma);
}

void SimulatedHome::remember(MonoTime stamp, MonoTime middle, const Moment& moment) {
  const BaseState base = segway_.base().state_at(middle);
  hal::ImageTruth truth;
  truth.stamp = stamp;
  truth.robot = {base.x_m, base.y_m, base.heading_rad};
  const Eigen::Quaterniond q(moment.X_WC.linear());
  for (int i = 0; i < 3; ++i) truth.camera_m[static_cast<std::size_t>(i)] = moment.X_WC.translation()(i);
  truth.camera_wxyz = {q.w(), q.x(), q.y(), q.z()};
  const int lamp = lamp_near(moment.state, moment.X_WC.translation());
  if (lamp >= 0) {
    truth.lamp_burns = true;
    const Eigen::Vector3d& p_WL = moment.state.lamps[static_cast<std::size_t>(lamp)].p_WL;
    truth.lamp_m = {p_WL.x(), p_WL.y(), p_WL.z()};
  }
  truth.robot_forward_mps = base.velocity.forward_mps;
  truth.robot_pitch_rad = base.pitch_rad;
  if (object_ >= 0) {
    const Figure& figure = world_.scene.figures[static_cast<std::size_t>(object_)];
    constexpr double kStep_s = 0.02;
    const double time_s = in_seconds(middle);
    const PathPoint now = figure.path.at(time_s);
    const Eigen::Vector2d step =
        (figure.path.at(time_s + kStep_s).p_W - figure.path.at(time_s - kStep_s).p_W).head<2>();
    const Eigen::Vector2d velocity = step / (2.0 * kStep_s);
    const Eigen::Vector2d away = now.p_W.head<2>() - moment.X_WC.translation().head<2>();
    truth.there = moment.state.presence[static_cast<std::size_t>(object_)].present;
    truth.object = {now.p_W.x(), now.p_W.y(), now.heading_rad};
    truth.object_mps = velocity.norm();
    truth.distance_m = away.norm();
    truth.nearing_mps = truth.distance_m > 0.0 ? -velocity.dot(away) / truth.distance_m : 0.0;
    photographer_->renderer().move_to(moment.state);  // an image out of the cache moved nothing
    const FigureView view =
        figure_view(photographer_->renderer(), moment.state, moment.X_WC, object_, object_parts_, lamp);
    truth.in_view = truth.there && view.in_view;
    truth.box = view.visible;
    if (view.visible_px > 0) truth.object_lit_share = static_cast<double>(view.lit_px) / view.visible_px;
  }
  const std::lock_guard lock(truth_mutex_);
  truths_.push_back(truth);
  if (truths_.size() > kTruthsKept) truths_.pop_front();
}

std::optional<hal::ImageTruth> SimulatedHome::truth(MonoTime stamp) const {
  const std::lock_guard lock(truth_mutex_);
  const auto found =
      std::find_if(truths_.begin(), truths_.end(), [&](const hal::ImageTruth& truth) { return truth.stamp == stamp; });
  return found == truths_.end() ? std::nullopt : std::optional(*found);
}

SwitchStates SimulatedHome::switched_at(double time_s) const {
  SwitchStates states;
  for (const Lamp& lamp : world_.scene.lamps) states[lamp.switch_name] = switches_->level(lamp.switch_name);
  // Two-way: the wall's switch turns over what the robot's line says. The last entry that has come counts.
  std::map<std::string, const WallSwitchSpec*> walls;
  for (const WallSwitchSpec& wall : scenario_.spec.wall_switch) {
    const WallSwitchSpec*& latest = walls[wall.lamp_line];
    if (wall.at_s <= time_s && (latest == nullptr || wall.at_s >= latest->at_s)) latest = &wall;
  }
  for (const auto& [line, wall] : walls) {
    if (wall != nullptr) states[line] = states[line] != wall->on;
  }
  return states;
}

std::vector<std::string> SimulatedHome::notes() const {
  const BasePlacement start = placement_of(scenario_, world_, robot_, parameters_.seed);
  return {fmt::format("world {}: {} parts, {} lamps; robot '{}' starts at {:.2f}, {:.2f} m", world_.scene.name,
                      world_.scene.parts.size(), world_.scene.lamps.size(), world_.scene.robots[robot_].name, start.x_m,
                      start.y_m),
          fmt::format("camera {}x{} at {:.0f} Hz, exposed {:.1f} ms; seed {}", camera_.width_px, camera_.height_px,
                      camera_.rate_hz, 1e3 * sensor_.exposure_s, parameters_.seed)};
}

}  // namespace cgsr::sim
