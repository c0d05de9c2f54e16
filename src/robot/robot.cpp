#include "src/robot/robot.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/core.h>

#include "hal/dummy/dummy_switches.h"
#include "hal/dummy/kinematic_drive.h"
#include "hal/replay/replay_camera.h"
#include "hal/rmp/rmp_drive.h"
#include "pipeline/color/learn.h"
#include "pipeline/color/model_file.h"
#include "pipeline/localization/perceive.h"
#include "pipeline/own_view.h"
#include "pipeline/world/load.h"
#include "src/input/camera_file.h"
#include "src/input/robot_calibration.h"
#include "src/plug_in/expectation.h"
#include "src/robot/boot_pose.h"
#include "src/robot/simulation_plugin.h"

namespace cgsr::robot {
namespace {

constexpr double kOwnMargin_px = 4.0;   // of the localizer's image
constexpr double kAreaMargin_m = 0.25;  // behaviours plan so far inside of the area in which wheels are let turn

}  // namespace

Result<std::unique_ptr<Robot>> Robot::build(const config::Robot& config, const RunOptions& options) {
  std::unique_ptr<Robot> robot(new Robot(config, options));
  for (const auto step : {&Robot::open_camera, &Robot::make_loops, &Robot::open_outputs, &Robot::open_base}) {
    if (auto done = (robot.get()->*step)(); !done) return tl::unexpected(done.error());
  }
  return robot;
}

Robot::Robot(const config::Robot& config, const RunOptions& options) : config_(config), options_(options) {}

Robot::~Robot() {
  if (motion_) motion_->stop();
  if (switches_) switches_->stop();
  if (camera_) camera_->stop();
}

Result<void> Robot::open_camera() {
  if (config_.camera.source == config::CameraSource::kSim) return open_simulation();
  auto camera = std::make_unique<hal::ReplayCamera>(config_.camera.replay, &real_clock_);
  auto mode = camera->start();
  if (!mode) return tl::unexpected(mode.error());
  notes_ = camera->notes();
  mode_ = *mode;
  camera_ = std::move(camera);
  return {};
}

Result<void> Robot::open_simulation() {
  auto simulation = load_simulation(config_.sim);
  if (!simulation) return tl::unexpected(simulation.error());
  simulation_ = std::move(*simulation);
  camera_ = simulation_->take_camera();
  first_due_ = MonoTime{simulation_->image_delay()};
  notes_ = simulation_->notes();
  auto mode = camera_->start();
  if (!mode) return tl::unexpected(mode.error());
  mode_ = *mode;
  return {};
}

/// The next image before the loops run.
Result<ImageLease> Robot::first() {
  const bool live = config_.run.pace == config::Pace::kLive;
  auto image = camera_->next_image(live ? real_clock_.now() + seconds(5.0) : first_due_);
  if (!image) return fail(fmt::format("no first image: {}", camera_->last_problem()));
  first_due_ += mode_.frame_period;
  return std::move(*image);
}

/// The object to follow: a file, or what a person shows in the camera's first image.
Result<color::ColorModel> Robot::learn_or_load() {
  if (!config_.run.model.empty()) return color::load_model(config_.run.model);
  const auto& region = config_.run.learn;
  if (region.empty()) return fail("neither run.model nor run.learn says what shall be followed");
  const auto image = first();
  if (!image) return tl::unexpected(image.error());
  const Box box{static_cast<double>(region.x_px), static_cast<double>(region.y_px),
                static_cast<double>(region.width_px), static_cast<double>(region.height_px)};
  const color::Sample sample{image->view(), box};
  auto learned = color::learn({&sample, 1}, config_.color.learn);
  if (!learned) return tl::unexpected(learned.error());
  notes_.push_back("learned from the first image: " + learned->words);
  return std::move(learned->model);
}

/// The object, where the task is to follow one.
Result<void> Robot::make_tracker(VisionParts& parts, std::optional<behavior::LearnedSize>& size) {
  if (config_.task.kind == config::TaskKind::kRoute) return {};
  const auto model = learn_or_load();
  if (!model) return tl::unexpected(model.error());
  if (config_.task.kind == config::TaskKind::kLamp) {
    const Pinhole& pinhole = config_.camera.pinhole;
    const double focal_px =
        camera_model_ ? 0.5 * (camera_model_->fx_px + camera_model_->fy_px) : 0.5 * (pinhole.fx_px + pinhole.fy_px);
    auto ball = color::IntegratedTracker::create(*model, config_.integrated, mode_.width_px, mode_.height_px, focal_px);
    if (!ball) return tl::unexpected(ball.error());
    parts.ball.emplace(std::move(*ball));
    return {};
  }
  auto tracker = color::Tracker::create(*model, config_.color.track, mode_.width_px, mode_.height_px);
  if (!tracker) return tl::unexpected(tracker.error());
  parts.tracker.emplace(std::move(*tracker));
  size = behavior::LearnedSize{model->width_px, model->height_px};
  return {};
}

/// Camera, mount and probe board, where the robot's file names them.
Result<void> Robot::read_calibration() {
  const config::RobotLocalization& known = config_.localization;
  if (known.camera.empty() || known.mount.empty()) return {};
  const auto camera = app::read_camera(known.camera);
  if (!camera) return tl::unexpected(camera.error());
  const auto X_RC = app::read_mount(known.mount);
  if (!X_RC) return tl::unexpected(X_RC.error());
  if (camera->width_px * mode_.height_px != camera->height_px * mode_.width_px) {
    return do_without(fmt::format("{}: is of a camera with {}x{} px, the images have {}x{}: another camera's file?",
                                  known.camera, camera->width_px, camera->height_px, mode_.width_px, mode_.height_px));
  }
  camera_model_ = camera->scaled_to(mode_.width_px, mode_.height_px);
  X_RC_ = *X_RC;
  return config_.probes.board.probes == 0 ? Result<void>() : read_board();
}

/// Algorithm 5.2 can do without knowing lamps: it then tracks without a mask. Any other task is refused.
Result<void> Robot::do_without(const std::string& problem) {
  if (config_.task.kind != config::TaskKind::kLamp) return fail(problem);
  problems_.push_back(problem + "; it tracks without a mask");
  return {};
}

Result<void> Robot::read_board() {
  auto board = illumination::make_board(config_.probes.board, X_RC_, *camera_model_);
  if (!board) return do_without(fmt::format("probes.board: {}", board.error().message));
  board_ = *board;
  if (auto checked = illumination::check_lamp(*board, config_.lamp); !checked) {
    return do_without(fmt::format("lamp: {}", checked.error().message));
  }
  return {};
}

/// The probes, where the robot carries some, and the shadows that follow from their lamp.
Result<void> Robot::make_light(VisionParts& parts) {
  if (!board_ || !problems_.empty()) return {};
  const config::Switches& switches = config_.switches;
  const CheckParameters check{!switches.probe_lamp_line.empty(), !switches.room_lamp_line.empty(), switches.probe_lamp};
  parts.lamp = std::make_unique<WhereIsTheLamp>(*board_, config_.probes, config_.lamp, check);
  notes_.push_back(fmt::format("board with {} probe{}", board_->probes, board_->probes == 1 ? "" : "s"));
  if (parts.where) parts.shade = std::make_unique<WhatIsShaded>(parts.where->map(), *camera_model_, config_.shade);
  return {};
}

/// The map, where the robot has one.
Result<void> Robot::make_whereabouts(VisionParts& parts) {
  const config::RobotLocalization& known = config_.localization;
  if (known.map.empty() || !camera_model_) return {};
  auto map = world::load_map(known.map);
  if (!map) return tl::unexpected(map.error());
  const auto first_image = known.start.marker.id < 0 ? Result<ImageLease>{} : first();
  if (!first_image) return tl::unexpected(first_image.error());
  auto boot = boot_pose(known.start, *camera_model_, X_RC_, first_image->view());
  if (!boot) return tl::unexpected(boot.error());
  KnownSelf self;
  notes_.push_back(fmt::format("map {}: {} surfaces, {} edges", known.map, map->surfaces.size(), map->edges.size()));
  self.map = std::make_unique<const world::Map>(std::move(*map));
  auto expectation = make_expectation(*self.map, known.localizer);
  if (!expectation) return tl::unexpected(expectation.error());
  self.expectation = std::move(*expectation);
  self.camera = *camera_model_;
  self.X_RC = X_RC_;
  self.axle_height_m = known.axle_height_m;
  self.odometry = config_.odometry;
  self.localizer = known.localizer;
  self.tracking = known.tracker;
  self.start = boot->prior;
  if (board_) {
    const geometry::Camera working = localization::working_camera(*camera_model_);
    self.own_pixels = own_pixels(*board_, working, X_RC_, kOwnMargin_px);
  }
  notes_.push_back("begins where " + boot->words + " says");
  parts.where = std::make_unique<WhereAmI>(std::move(self));
  return {};
}

Result<void> Robot::make_loops() {
  VisionParts parts;
  std::optional<behavior::LearnedSize> learned;
  if (auto read = read_calibration(); !read) return read;
  if (auto made = make_tracker(parts, learned); !made) return made;
  if (auto made = make_whereabouts(parts); !made) return made;
  if (auto made = make_light(parts); !made) return made;
  if (config_.task.kind == config::TaskKind::kRoute) {
    auto places = behavior::parse_places(config_.task.route.places_m);
    if (!places) return fail(fmt::format("task.route.places_m: {}", places.error().message));
    parts.route.emplace(config_.task.route, std::move(*places));
  }
  if (config_.task.kind == config::TaskKind::kLamp) {
    const auto& board = config_.probes.board;
    const auto& area = config_.motion.keep_in;
    parts.seek.emplace(
        config_.task.lamp,
        parts.where ? std::make_shared<behavior::FreeFloor>(parts.where->map(), config_.task.lamp.floor) : nullptr,
        behavior::BoardPlace{board.position_m[0], board.position_m[2]},
        behavior::KeptArea{area.enabled, area.min_x_m + kAreaMargin_m, area.max_x_m - kAreaMargin_m,
                           area.min_y_m + kAreaMargin_m, area.max_y_m - kAreaMargin_m});
  }
  std::array<bool, kLampLines> lamps{};
  std::ranges::transform(config_.switches.lamps(), lamps.begin(), [](const auto& name) { return !name.empty(); });
  parts.switchboard = Switchboard(lamps, mode_.frame_period, seconds(config_.switches.answer_timeout_s));
  auto schedule = runtime::Schedule::make(runtime::rows_of(config_.stage), mode_.frame_period);
  if (!schedule) return tl::unexpected(schedule.error());

  // Stages are measured in real time either way; in lock-step nothing follows from it.
  const bool live = config_.run.pace == config::Pace::kLive;
  runner_ = std::make_unique<runtime::StageRunner>(
      real_clock_, *schedule, live ? runtime::BudgetSource::kClock : runtime::BudgetSource::kUnits, links_.motion_stop);
  vision_ = std::make_unique<VisionLoop>(*runner_, std::move(parts), behavior::Follow(config_.follow, learned),
                                         config_.camera.pinhole, mode_.width_px, mode_.height_px);
  return vision_->bind();
}

Result<void> Robot::open_outputs() {
  RunOutputs outputs;
  if (!options_.csv.empty()) {
    auto csv = app::TextFile::create(options_.csv);
    if (!csv) return tl::unexpected(csv.error());
    if (auto head = csv->add_line(run_csv_head()); !head) return head;
    outputs.csv.emplace(std::move(*csv));
  }
  outputs.task = config_.task.kind;
  outputs.witness = options_.witness;
  if (simulation_) {
    outputs.simulation = simulation_.get();
    outputs.set_distance_m = config_.task.kind == config::TaskKind::kFollow ? config_.follow.distance_m : 0.0;
  }
  if (!options_.video.empty()) {
    outputs.overlay.emplace(mode_.width_px, mode_.height_px);
    cv::Size size = outputs.overlay->picture_size();
    if (simulation_) {
      outputs.plan.emplace(simulation_->plan(), size.height);
      size.width += outputs.plan->picture_size().width;
    }
    auto video = app::VideoWriter::create(options_.video, size, 1.0 / to_seconds(mode_.frame_period));
    if (!video) return tl::unexpected(video.error());
    outputs.video.emplace(std::move(*video));
  }
  housekeeping_ = std::make_unique<HousekeepingTask>(links_, runner_->schedule(), std::move(outputs));
  return {};
}

Result<void> Robot::open_base() {
  motion_ = std::make_unique<MotionLoop>(make_drive(), config_.motion,
                                         options_.dry_run ? MotionLoop::Mode::kDryRun : MotionLoop::Mode::kLive);
  if (auto started = motion_->start(); !started) return started;
  switches_ = make_switches();
  if (auto started = switches_->start(); !started) return started;
  return check_lines(*switches_, lines());
}

std::unique_ptr<hal::Drive> Robot::make_drive() {
  if (simulation_) return std::make_unique<hal::rmp::RmpDrive>(simulation_->take_can_bus(), config_.rmp);
  return std::make_unique<hal::KinematicDrive>(config_.drive);
}

std::unique_ptr<hal::Switches> Robot::make_switches() {
  if (simulation_) return simulation_->take_switches();
  std::vector<hal::DummyLine> lines;
  if (!config_.switches.arming_line.empty()) {
    lines.push_back({config_.switches.arming_line, hal::LineDirection::kInput, false});
  }
  for (const std::string& lamp : config_.switches.lamps()) {
    if (!lamp.empty()) lines.push_back({lamp, hal::LineDirection::kOutput, false});
  }
  return std::make_unique<hal::DummySwitches>(std::move(lines));
}

Result<void> Robot::run(StopRequest& stop) {
  Result<void> done;
  if (config_.run.pace == config::Pace::kLive) {
    done = run_live(stop);
  } else {
    run_lock_step(stop);
    done = camera_outcome();
  }
  housekeeping_->finish();
  if (auto left = leave_pose_for_next_run(); !left && done) return left;
  return done;
}

/// Only a pose that the robot believed to the end is worth anything to the next run.
Result<void> Robot::leave_pose_for_next_run() const {
  const auto& where = housekeeping_->tally().last_where;
  if (config_.localization.start.file.empty() || !where.robot.known) return {};
  return leave_pose(config_.localization.start.file,
                    geometry::pose_on_floor(where.robot.x_m, where.robot.y_m, where.robot.heading_rad));
}

Result<void> Robot::camera_outcome() const {
  if (!links_.camera_lost.load(std::memory_order_acquire)) return {};
  return fail(fmt::format("camera: {}", camera_->last_problem()));
}

}  // namespace cgsr::robot
