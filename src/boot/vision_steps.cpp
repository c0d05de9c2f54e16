// The steps that make the stages of the vision loop out of files: calibration, object, map, board, task, schedule.
#include <utility>

#include <fmt/format.h>

#include "pipeline/behavior/lookouts.h"
#include "pipeline/color/learn/learn.h"
#include "pipeline/color/learn/model_file.h"
#include "pipeline/localization/perceive.h"
#include "pipeline/localization/work.h"
#include "pipeline/stages/color_stages.h"
#include "pipeline/stages/finals_task.h"
#include "pipeline/stages/search_people_task.h"
#include "pipeline/stages/self_mask.h"
#include "pipeline/stages/tasks.h"
#include "pipeline/world/load.h"
#include "src/boot/boot_pose.h"
#include "src/boot/robot_plan.h"
#include "src/input/camera_file.h"
#include "src/input/robot_calibration.h"
#include "src/input/start_places.h"
#include "src/plug_in/expectation.h"

namespace cgsr::boot {
namespace {

constexpr double kSelfMaskMargin_px = 4.0;  // of the localizer's image
constexpr double kAreaMargin_m = 0.25;      // behaviours plan so far inside of the area in which wheels may turn

/// Algorithm 5.2 can do without knowing lamps: it then tracks without a mask. Any other task is refused.
Result<void> do_without(RobotState& state, const std::string& problem) {
  if (state.setup.config.task.kind != config::TaskKind::kLamp) return fail(problem);
  state.report.problems.push_back(problem + "; it tracks without a mask");
  return {};
}

Result<void> read_board(RobotState& state) {
  const config::Robot& config = state.setup.config;
  auto board = illumination::make_board(config.probes.board, state.calibration.X_RC, *state.calibration.camera);
  if (!board) return do_without(state, fmt::format("probes.board: {}", board.error().message));
  state.calibration.board = *board;
  if (auto checked = illumination::check_lamp(*board, config.lamp); !checked) {
    return do_without(state, fmt::format("lamp: {}", checked.error().message));
  }
  return {};
}

/// The camera's optics: as calibrated, else as the robot's file says.
geometry::Camera optics_of(const RobotState& state) {
  if (state.calibration.camera) return *state.calibration.camera;
  const config::Pinhole& pinhole = state.setup.config.camera.pinhole;
  geometry::Camera camera;
  camera.width_px = state.devices.mode.width_px;
  camera.height_px = state.devices.mode.height_px;
  camera.fx_px = pinhole.fx_px;
  camera.fy_px = pinhole.fy_px;
  camera.cx_px = pinhole.cx_px;
  camera.cy_px = pinhole.cy_px;
  return camera;
}

/// The object to track: of a file, or what a person shows in the camera's first image.
Result<color::ColorModel> loaded_or_learned(RobotState& state) {
  if (state.vision.model) return *state.vision.model;
  const auto image = state.first_image();
  if (!image) return tl::unexpected(image.error());
  const config::LearnRegion& region = state.setup.config.run.learn;
  const Box box{static_cast<double>(region.x_px), static_cast<double>(region.y_px),
                static_cast<double>(region.width_px), static_cast<double>(region.height_px)};
  const color::Sample sample{image->view(), box};
  auto learned = color::learn({&sample, 1}, state.setup.config.color.learn);
  if (!learned) return tl::unexpected(learned.error());
  state.report.notes.push_back("learned from the first image: " + learned->message);
  return std::move(learned->model);
}

Result<void> make_ball(RobotState& state, const color::ColorModel& model) {
  const hal::CameraMode& mode = state.devices.mode;
  const geometry::Camera optics = optics_of(state);
  auto ball = color::IntegratedTracker::create(model, state.setup.config.integrated, mode.width_px, mode.height_px,
                                               0.5 * (optics.fx_px + optics.fy_px));
  if (!ball) return tl::unexpected(ball.error());
  state.vision.parts.make<stages::TrackStage>(std::move(*ball));
  state.vision.parts.make<stages::DecodeStage>(stages::DecodeStage::Setup{mode.width_px, mode.height_px, {}});
  return {};
}

Result<void> make_tracker(RobotState& state, const color::ColorModel& model) {
  const hal::CameraMode& mode = state.devices.mode;
  auto made = stages::ColorStages::make(model, state.setup.config.color.track, mode.width_px, mode.height_px);
  if (!made) return tl::unexpected(made.error());
  VisionParts& parts = state.vision.parts;
  parts.put(std::move(made->decode));
  parts.put(std::move(made->search));
  parts.put(std::move(made->track));
  state.vision.learned = behavior::LearnedSize{model.width_px, model.height_px};
  return {};
}

/// \return null: there is no map, or no camera and so no pose to plan with.
std::shared_ptr<const behavior::FreeFloor> floor_of(const RobotState& state,
                                                    const behavior::FreeFloorParameters& floor) {
  if (!state.calibration.camera || !state.vision.map) return nullptr;
  return std::make_shared<behavior::FreeFloor>(*state.vision.map, floor);
}

behavior::SeekLamp seek_lamp_of(const RobotState& state) {
  const config::Robot& config = state.setup.config;
  const auto& board = config.probes.board;
  const auto& area = config.motion.keep_in;
  return {config.task.lamp, floor_of(state, config.task.lamp.floor),
          behavior::BoardPlace{board.position_m[0], board.position_m[2]},
          behavior::KeptArea{area.enabled, area.min_x_m + kAreaMargin_m, area.max_x_m - kAreaMargin_m,
                             area.min_y_m + kAreaMargin_m, area.max_y_m - kAreaMargin_m},
          config.motion};
}

/// The lookouts are planned once, before the first image.
Result<std::unique_ptr<stages::Task>> search_people(RobotState& state) {
  const config::Robot& config = state.setup.config;
  const behavior::SearchPeopleParameters& parameters = config.task.search_people;
  if (!state.vision.map) return fail("task.kind = \"search_people\" has no map to plan with");
  const geometry::Camera camera = optics_of(state);
  const double max_distance_m = parameters.face_width_m * camera.fx_px / parameters.min_face_px;
  behavior::LookoutPlan plan = behavior::plan_lookouts(
      *state.vision.map, {config.localization.start.x_m, config.localization.start.y_m},
      {parameters.min_distance_m, max_distance_m, parameters.max_unseen_share, parameters.floor});
  if (plan.lookouts.empty()) {
    return fail(
        fmt::format("task.kind = \"search_people\": from {:.2f}, {:.2f} m, where the robot starts, no place on the "
                    "map's free floor is reached from which people could be seen",
                    config.localization.start.x_m, config.localization.start.y_m));
  }
  state.report.notes.push_back(
      fmt::format("looks for people from {} places, which see {:.0f} % of the floor within "
                  "{:.1f} m",
                  plan.lookouts.size(), 100.0 * plan.seen_share, max_distance_m));
  behavior::SearchPeople search(parameters, behavior::FreeFloor(*state.vision.map, parameters.floor),
                                std::move(plan.lookouts), config.motion);
  return std::make_unique<stages::SearchPeopleTask>(std::move(search), parameters, camera);
}

Result<std::unique_ptr<stages::Task>> task_of(RobotState& state) {
  const config::Robot& config = state.setup.config;
  if (config.task.kind == config::TaskKind::kLamp) return std::make_unique<stages::LampTask>(seek_lamp_of(state));
  if (config.task.kind == config::TaskKind::kFollow) {
    return std::make_unique<stages::FollowTask>(behavior::Follow(config.follow, state.vision.learned, config.motion),
                                                optics_of(state));
  }
  if (config.task.kind == config::TaskKind::kPerson) {
    auto task = std::make_unique<stages::FollowPersonTask>(config.task.person, config.follow, config.motion,
                                                           optics_of(state), config.person.fill_light);
    task->keep_to(floor_of(state, config.task.person.floor));
    return task;
  }
  if (config.task.kind == config::TaskKind::kFinals) {
    auto task = std::make_unique<stages::FinalsTask>(config.task.finals, config.task.person, config.follow,
                                                     config.motion, optics_of(state), config.person.fill_light);
    task->keep_to(floor_of(state, config.task.person.floor));
    return task;
  }
  if (config.task.kind == config::TaskKind::kLine) {
    return std::make_unique<stages::WhoIsWhoTask>(behavior::LookAlong(config.task.line, config.motion),
                                                  optics_of(state));
  }
  if (config.task.kind == config::TaskKind::kSearchPeople) return search_people(state);
  auto places = behavior::parse_places(config.task.route.places_m);
  if (!places) return fail(fmt::format("task.route.places_m: {}", places.error().message));
  return std::make_unique<stages::RouteTask>(behavior::Route(config.task.route, std::move(*places), config.motion));
}

/// The search of the whole map for the pose, for a robot that nobody tells where it begins, or that may be lost for long.
Result<void> prepare_search(RobotState& state, bool first_pose, stages::LocalizationSetup& setup) {
  const config::RobotLocalization& known = state.setup.config.localization;
  if (!known.start.anywhere || (!first_pose && known.start.again_after_s <= 0.0)) return {};
  const int units = state.setup.config.stage.of<stages::LocalizeStage>().units;
  if (units < localization::kMinSearchUnits) {
    return fail(fmt::format("stage.localize.units = {}: localization.start.anywhere needs at least {}", units,
                            localization::kMinSearchUnits));
  }
  if (!known.tracker.floor) {
    return fail("localization.tracker.floor = false: localization.start.anywhere needs a robot on a level floor");
  }
  if (first_pose && state.setup.config.motion.keep_in.enabled) {
    state.report.notes.emplace_back(
        "motion.keep_in is seen from where the robot stands now, wherever in the map that is");
  }
  auto places = app::start_places(*state.vision.map, known.map);
  if (!places) return tl::unexpected(places.error());
  setup.places_m = std::move(*places);
  setup.seeks_first_pose = first_pose;
  setup.seek_turn_radps = known.start.turn_radps;
  setup.seek_again_after = seconds(known.start.again_after_s);
  state.report.notes.push_back(fmt::format("seeks its {} among {} places",
                                           first_pose ? "first pose" : "pose, once it is lost for long,",
                                           setup.places_m.size()));
  return {};
}

}  // namespace

/// The object's model, where the task needs one and its file is named.
Result<void> load_model(RobotState& state) {
  const config::Run& run = state.setup.config.run;
  if (!state.setup.config.needs_object() || (run.model.empty() && !run.learn.empty())) return {};
  if (run.model.empty()) {
    return fail(
        "neither run.model nor run.learn names an object: give --model FILE (cgsr learn makes one), or a region of the "
        "first image");
  }
  auto model = color::load_model(run.model);
  if (!model) return tl::unexpected(model.error());
  state.vision.model = std::move(*model);
  return {};
}

/// The map, where the robot has one.
Result<void> load_map(RobotState& state) {
  const std::string& file = state.setup.config.localization.map;
  if (file.empty()) return {};
  auto map = world::load_map(file);
  if (!map) return tl::unexpected(map.error());
  state.report.notes.push_back(
      fmt::format("map {}: {} surfaces, {} edges", file, map->surfaces.size(), map->edges.size()));
  state.vision.map = std::make_shared<const world::Map>(std::move(*map));
  return {};
}

/// Camera and mount, each where the robot's file names it: a calibrated camera serves every task, without a mount too.
Result<void> read_calibration(RobotState& state) {
  const config::RobotLocalization& known = state.setup.config.localization;
  if (!known.camera.empty()) {
    const auto camera = app::read_camera(known.camera);
    if (!camera) return tl::unexpected(camera.error());
    state.calibration.camera = *camera;
  }
  if (!known.mount.empty()) {
    const auto X_RC = app::read_mount(known.mount);
    if (!X_RC) return tl::unexpected(X_RC.error());
    state.calibration.X_RC = *X_RC;
  }
  return {};
}

/// The calibration in the size of the images that come, and the probe board by it.
Result<void> fit_calibration(RobotState& state) {
  auto& camera = state.calibration.camera;
  if (!camera) return {};
  const hal::CameraMode& mode = state.devices.mode;
  if (camera->width_px * mode.height_px != camera->height_px * mode.width_px) {
    const std::string problem = fmt::format(
        "{}: calibrates a camera of {}x{} px, the images have {}x{}: expected the same sides' ratio; is it another "
        "camera's file?",
        state.setup.config.localization.camera, camera->width_px, camera->height_px, mode.width_px, mode.height_px);
    camera.reset();
    return do_without(state, problem);
  }
  camera = camera->scaled_to(mode.width_px, mode.height_px);
  return state.setup.config.probes.board.probes == 0 ? Result<void>() : read_board(state);
}

Result<void> make_object(RobotState& state) {
  const hal::CameraMode& mode = state.devices.mode;
  if (!state.setup.config.needs_object()) {
    state.vision.parts.make<stages::DecodeStage>(stages::DecodeStage::Setup{mode.width_px, mode.height_px, {}});
    return {};
  }
  const auto model = loaded_or_learned(state);
  if (!model) return tl::unexpected(model.error());
  const config::Robot& config = state.setup.config;
  const bool by_shade = config.task.kind == config::TaskKind::kLamp || config.shade.lamp.given;
  return by_shade ? make_ball(state, *model) : make_tracker(state, *model);
}

/// The pose against the map, where the robot has one.
Result<void> make_localization(RobotState& state) {
  const config::RobotLocalization& known = state.setup.config.localization;
  if (!state.vision.map || !state.calibration.camera) return {};
  const auto first_image = known.start.marker.id < 0 ? Result<ImageLease>{} : state.first_image();
  if (!first_image) return tl::unexpected(first_image.error());
  const Calibration& calibration = state.calibration;
  auto boot = boot_pose(known.start, *calibration.camera, calibration.X_RC, first_image->view());
  if (!boot) return tl::unexpected(boot.error());
  state.report.notes.push_back("begins where " + boot->message + " says");
  auto expectation = make_expectation(*state.vision.map, known.localizer);
  if (!expectation) return tl::unexpected(expectation.error());
  stages::LocalizationSetup setup;
  setup.map = state.vision.map;
  setup.expectation = std::move(*expectation);
  setup.camera = *calibration.camera;
  setup.X_RC = calibration.X_RC;
  setup.axle_height_m = known.axle_height_m;
  setup.localizer = known.localizer;
  setup.tracking = known.tracker;
  setup.start = boot->prior;
  if (auto prepared = prepare_search(state, boot->anywhere, setup); !prepared) return prepared;
  if (calibration.board) {
    setup.self_mask = stages::self_mask(*calibration.board, localization::working_camera(*calibration.camera),
                                        calibration.X_RC, kSelfMaskMargin_px);
  }
  state.vision.parts.make<stages::LocalizeStage>(std::move(setup));
  return {};
}

/// The probes, where the robot carries some, and the shadows that follow from their lamp, or from one whose place the file gives.
Result<void> make_light(RobotState& state) {
  const auto& board = state.calibration.board;
  const config::Robot& config = state.setup.config;
  if (config.shade.lamp.given && state.vision.map && state.calibration.camera && config.probes.board.probes == 0) {
    state.vision.parts.make<stages::ShadeStage>(state.vision.map, *state.calibration.camera, config.shade);
    return {};
  }
  if (!board || !state.report.problems.empty()) return {};
  const stages::CheckParameters check{!config.switches.probe_lamp_line.empty(), !config.switches.room_lamp_line.empty(),
                                      config.switches.probe_lamp};
  VisionParts& parts = state.vision.parts;
  parts.make<stages::ProbesStage>(*board, config.probes, config.lamp, state.calibration.X_RC, check);
  state.report.notes.push_back(fmt::format("board with {} probe{}", board->probes, board->probes == 1 ? "" : "s"));
  if (state.vision.map) {
    parts.make<stages::ShadeStage>(state.vision.map, *state.calibration.camera, config.shade);
  }
  return {};
}

Result<void> make_task(RobotState& state) {
  auto task = task_of(state);
  if (!task) return tl::unexpected(task.error());
  state.vision.parts.make<stages::DecideStage>(std::move(*task));
  return {};
}

Result<void> make_loop(RobotState& state) {
  auto schedule = runtime::Schedule::make(runtime::rows_of(state.setup.config.stage), state.devices.mode.frame_period);
  if (!schedule) return tl::unexpected(schedule.error());
  // Stages are measured in real time either way; in lock-step nothing follows from it.
  state.vision.runner = std::make_unique<runtime::StageRunner>(
      state.clocks.real, *schedule, state.setup.live() ? runtime::BudgetSource::kClock : runtime::BudgetSource::kUnits,
      state.links.motion_stop);
  state.vision.loop = std::make_unique<VisionLoop>(*state.vision.runner, std::move(state.vision.parts));
  return state.vision.loop->bind();
}

}  // namespace cgsr::boot
