#include "src/commands/localize_run.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "pipeline/localization/work.h"
#include "pipeline/world/load.h"
#include "platform/count_marks.h"
#include "platform/stop.h"
#include "platform/work_budget.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/config/load.h"
#include "src/input/camera_file.h"
#include "src/input/robot_calibration.h"
#include "src/output/candidate_plan.h"
#include "src/output/picture.h"
#include "src/plug_in/expectation.h"

namespace cgsr::app {
namespace {

constexpr const char* kNoPose = ",,,,,,";  // in the columns of one
constexpr int kMostLooks = 200;            // at one image, while a search is under way

Result<config::Localization> configuration_of(const LocalizeOptions& options) {
  auto config = config::load_localization(options.config);
  if (!config) return config;
  for (const auto& [name, method] : localization::kMethodNames) {
    if (name == options.method) config->localizer.method = method;
  }
  config::PriorParameters& prior = config->prior;
  if (options.sigma_m) prior.x_m = prior.y_m = prior.z_m = *options.sigma_m;
  if (options.sigma_deg) prior.heading_deg = prior.tilt_deg = *options.sigma_deg;
  return config;
}

std::string csv_columns() {
  return fmt::format("frame,corrected,reason,{},matches,rms_px", kPoseColumns);
}

Result<void> claim_outputs(const LocalizeOptions& options) {
  OutputClaims files(options.force);
  files.reads(options.map, "--map");
  files.reads(options.camera, "--camera");
  files.reads(options.input, "--input");
  files.reads(options.pose, "--pose");
  files.reads(options.priors, "--priors");
  files.reads(options.odometry, "--odometry");
  files.reads(options.mount, "--mount");
  reads_configuration(files, options.config, "--config");
  files.writes(options.csv, "--csv", csv_file(csv_columns()));
  files.writes(options.video, "--video", video_file());
  files.writes(options.json, "--json", json_object());
  files.writes(options.plan, "--plan", picture_file());
  return files.claim();
}

/// How far the map's middle is from a place, or the farthest corner from its middle: the scale of what the camera sees.
double viewed_m(const world::Map& map, const geometry::Pose& X_WC) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3f& vertex : map.vertices) bounds.extend(vertex.cast<double>());
  return std::max((X_WC.translation() - bounds.center()).norm(), 0.5 * bounds.diagonal().norm());
}

/// A pose to follow from was measured or found: unless its width was given, it is believed better than one that odometry carried. Its error is some pixels
/// in the image, so a pose before a model on a table is known better than one in a room: 5 mm at half a metre.
localization::PriorSigmas start_sigmas(const config::Localization& config, const LocalizeOptions& options,
                                       double viewed_m) {
  constexpr double kPlaceOfViewed = 0.01;
  constexpr double kPlace_m = 0.02;
  const double place_m = std::min(kPlace_m, kPlaceOfViewed * viewed_m);
  const double turn_deg = config.tracker.floor ? 1.0 : 0.5;
  config::PriorParameters start = config.prior;
  if (!options.sigma_m) {
    for (double* sigma : {&start.x_m, &start.y_m, &start.z_m}) *sigma = std::min(*sigma, place_m);
  }
  if (!options.sigma_deg) {
    for (double* sigma : {&start.heading_deg, &start.tilt_deg}) *sigma = std::min(*sigma, turn_deg);
  }
  return start.sigmas();
}

}  // namespace

Result<LocalizeRun> LocalizeRun::open(const LocalizeOptions& options) {
  LocalizeRun run;
  State& state = *run.state_;
  std::optional<EndAtOnceOnSignals> loading(std::in_place, kInterrupted);  // a large map takes seconds
  if (auto claimed = claim_outputs(options); !claimed) return tl::unexpected(claimed.error());
  auto config = configuration_of(options);
  if (!config) return tl::unexpected(config.error());
  state.config = *config;
  auto camera = read_camera(options.camera);
  if (!camera) return tl::unexpected(camera.error());
  state.camera = *camera;
  if (auto opened = run.open_images(options); !opened) return tl::unexpected(opened.error());
  auto map = world::load_map(options.map, options.load);
  if (!map) return tl::unexpected(map.error());
  state.map = std::make_shared<const world::Map>(std::move(*map));
  if (state.map->edges.empty()) return fail(fmt::format("{}: holds no edge to look for", options.map));
  if (auto opened = run.open_poses(options); !opened) return tl::unexpected(opened.error());
  if (options.anywhere) {
    auto search = FirstPose::make(*state.map, options.map, state.camera, run.X_RC_, state.config);
    if (!search) return tl::unexpected(search.error());
    state.first_pose = std::move(*search);
    run.plan_file_ = options.plan;
  } else if (auto opened = run.open_stage(); !opened) {
    return tl::unexpected(opened.error());
  }
  loading.reset();
  if (auto opened = run.open_outputs(options); !opened) return tl::unexpected(opened.error());
  return run;
}

Result<void> LocalizeRun::open_images(const LocalizeOptions& options) {
  auto input = ImageInput::open({.path = options.input});
  if (!input) return tl::unexpected(input.error());
  input_.emplace(std::move(*input));
  const auto& mode = input_->mode();
  const geometry::Camera& camera = state_->camera;
  if (mode.width_px != camera.width_px || mode.height_px != camera.height_px) {
    return fail(fmt::format("{}: images of {} x {} px: expected {} x {}, the size of the camera in {}", options.input,
                            mode.width_px, mode.height_px, camera.width_px, camera.height_px, options.camera));
  }
  notes_ = input_->notes();
  return {};
}

Result<void> LocalizeRun::open_poses(const LocalizeOptions& options) {
  if (!options.priors.empty()) {
    auto priors = read_poses(options.priors);
    if (!priors) return tl::unexpected(priors.error());
    priors_ = std::move(*priors);
    priors_file_ = options.priors;
    return {};
  }
  if (options.anywhere && !state_->config.tracker.floor) {
    return fail(
        fmt::format("{}: tracker.floor = false: --anywhere finds the pose of a robot on a floor, as with "
                    "config/localization/floor.toml",
                    options.config.empty() ? "without --config" : options.config));
  }
  if (options.anywhere && options.units > 0 && options.units < localization::kMinSearchUnits) {
    return fail(fmt::format("--units {}: --anywhere needs at least {} for each image, or 0 for all it asks for",
                            options.units, localization::kMinSearchUnits));
  }
  std::optional<geometry::Pose> start;
  if (!options.anywhere) {
    const auto given = read_pose(options.pose);
    if (!given) return tl::unexpected(given.error());
    start = *given;
  }
  geometry::Pose X_RC = geometry::Pose::Identity();
  if (!options.mount.empty()) {
    const auto mount = std::filesystem::path(options.mount).extension() == ".toml" ? read_mount(options.mount)
                                                                                   : read_pose(options.mount);
    if (!mount) return tl::unexpected(mount.error());
    X_RC = *mount;
  } else if (state_->config.tracker.floor) {
    return fail(
        fmt::format("{}: tracker.floor = true needs --mount: where the camera is on the robot", options.config));
  }
  if (!options.odometry.empty()) {
    auto odometry = read_poses(options.odometry);
    if (!odometry) return tl::unexpected(odometry.error());
    odometry_ = std::move(*odometry);
    odometry_file_ = options.odometry;
    // It carries a search along from image to image: none has to be finished in one.
    if (options.units > 0) units_ = static_cast<std::uint32_t>(options.units);
  }
  X_RC_ = X_RC;
  if (start) {
    const auto sigmas = start_sigmas(state_->config, options, viewed_m(*state_->map, *start * X_RC));
    start_ = localization::prior_at(*start, sigmas);
  }
  return {};
}

Result<void> LocalizeRun::open_stage() {
  State& state = *state_;
  auto expectation = make_expectation(*state.map, state.config.localizer);
  if (!expectation) return tl::unexpected(expectation.error());
  stages::LocalizationSetup setup;
  setup.map = state.map;
  setup.expectation = std::move(*expectation);
  setup.camera = state.camera;
  setup.X_RC = X_RC_;
  setup.localizer = state.config.localizer;
  setup.tracking = state.config.tracker;
  setup.start = start_;
  state.stage.emplace(std::move(setup));
  return {};
}

Result<void> LocalizeRun::open_outputs(const LocalizeOptions& options) {
  if (!options.csv.empty()) {
    auto csv = TextFile::create(options.csv);
    if (!csv) return tl::unexpected(csv.error());
    csv_.emplace(std::move(*csv));
    if (auto head = csv_->add_line(csv_columns()); !head) return head;
  }
  if (!options.video.empty()) {
    state_->expectation = std::make_unique<render::DepthRaster>(*state_->map, render::RasterParameters{});
    state_->overlay.emplace(*state_->map, *state_->expectation, state_->camera);
    auto video = VideoWriter::create(options.video, state_->overlay->picture_size(),
                                     1.0 / to_seconds(input_->mode().frame_period));
    if (!video) return tl::unexpected(video.error());
    video_.emplace(std::move(*video));
  }
  return {};
}

Result<const PoseRow*> LocalizeRun::row_for(const std::vector<PoseRow>& rows, const std::string& file) const {
  if (!rows.front().frame) {
    const auto at = static_cast<std::size_t>(frame_);
    if (at < rows.size()) return &rows[at];
    return fail(fmt::format("{}: holds {} poses and none for image {}", file, rows.size(), frame_));
  }
  const auto found = std::ranges::lower_bound(rows, frame_, {}, [](const PoseRow& row) { return *row.frame; });
  if (found != rows.end() && *found->frame == frame_) return &*found;
  return fail(fmt::format("{}: holds no pose for image {}", file, frame_));
}

localization::Correction LocalizeRun::follow(const ImageView& image, std::uint32_t units) {
  stages::LocalizeStage& stage = *state_->stage;
  auto budget = runtime::StageBudget::of_units(units);
  // What the first image costs is not counted: its prior is wide.
  const bool counted = images_ > 0;
  if (counted) count_stage_begin();
  for (int look = 0; look < kMostLooks; ++look) {
    tracked_ = stage.update(budget, image).camera;
    if (!stage.searching() || budget.refused()) break;
  }
  if (counted) units_most_ = std::max(units_most_, budget.granted());
  if (counted) {
    count_stage_end(stages::LocalizeStage::kName.data());
    count_image_end();
  }
  return tracked_.correction;
}

Result<localization::Correction> LocalizeRun::look(const ImageView& image) {
  if (!priors_.empty()) return look_at_prior(image);
  geometry::Pose X_R0R1 = geometry::Pose::Identity();
  if (!odometry_.empty()) {
    const auto row = row_for(odometry_, odometry_file_);
    if (!row) return tl::unexpected(row.error());
    if (X_OR_before_) X_R0R1 = X_OR_before_->inverse() * (*row)->X;
    X_OR_before_ = (*row)->X;
  }
  if (!state_->stage) return search(image, *X_OR_before_);
  stages::LocalizeStage& stage = *state_->stage;
  if (!odometry_.empty()) {
    // About the floor instead of an axle of unknown height: a millimetre of the camera's height.
    stage.lean(geometry::pitch_of(*X_OR_before_), 0.0);
  }
  // No robot waits for the first one: it is looked at until it says where the camera is.
  if (images_ == 0) return follow(image, runtime::StageBudget::kAll);
  const geometry::Pose X_WC_before = tracked_.X_WC;
  const bool corrected_before = tracked_.correction.corrected;
  stage.carry(odometry_.empty() ? X_RR_last_ : X_R0R1);
  const localization::Correction answer = follow(image, units_);
  // Without odometry: as it moved last, so it moves on; what ends a loss is no movement.
  if (odometry_.empty())
    X_RR_last_ = answer.corrected && corrected_before ? X_RC_ * (X_WC_before.inverse() * answer.X_WC) * X_RC_.inverse()
                                                      : geometry::Pose::Identity();
  return answer;
}

Result<localization::Correction> LocalizeRun::search(const ImageView& image, const geometry::Pose& X_OR) {
  FirstPose& first = *state_->first_pose;
  auto budget = runtime::StageBudget::of_units(units_);
  count_stage_begin();
  bool found = false;
  for (int look = 0; look < kMostLooks && !found && !budget.refused(); ++look) {
    found = first.see(image, X_OR, budget);
    if (first.phase() != global_localization::Phase::kTrying) break;  // from image to image
  }
  count_stage_end("find");
  count_image_end();
  units_most_ = std::max(units_most_, budget.granted());
  if (!found) return localization::Correction{.reason = localization::Reason::kSearching};
  found_in_ = frame_;
  tracked_ = first.found();
  start_ = {.X_WC = tracked_.X_WC, .covariance = tracked_.covariance};
  if (auto opened = open_stage(); !opened) return tl::unexpected(opened.error());
  return tracked_.correction;
}

Result<localization::Correction> LocalizeRun::look_at_prior(const ImageView& image) {
  const auto row = row_for(priors_, priors_file_);
  if (!row) return tl::unexpected(row.error());
  const auto prior = localization::prior_at((*row)->X, state_->config.prior.sigmas());
  stages::LocalizeStage& stage = *state_->stage;
  UnlimitedBudget budget;
  localization::Correction answer;
  stage.restart();
  count_stage_begin();
  for (int look = 0; look < kMostLooks; ++look) {
    answer = stage.correct(budget, image, prior);
    if (!stage.searching()) break;
  }
  count_stage_end(stages::LocalizeStage::kName.data());
  count_image_end();
  return answer;
}

Result<void> LocalizeRun::write(const ImageView& image, const localization::Correction& answer) {
  const bool known = state_->stage.has_value();
  if (csv_) {
    auto written =
        csv_->add_line(fmt::format("{},{},{},{},{},{:.3f}", frame_, answer.corrected ? 1 : 0, to_string(answer.reason),
                                   known ? pose_as_csv(answer.X_WC) : kNoPose, answer.matches, answer.rms_px));
    if (!written) return written;
  }
  if (!video_) return {};
  if (!known) {
    const std::string words = fmt::format("image {}   where am I: {}", frame_, to_string(state_->first_pose->phase()));
    return video_->add(state_->overlay->draw(image, std::nullopt, false, words));
  }
  const Eigen::Vector3d& p = answer.X_WC.translation();
  const std::string words = answer.corrected
                                ? fmt::format("image {}   at {:.3f} {:.3f} {:.3f} m   {} matches   rms {:.2f} px",
                                              frame_, p.x(), p.y(), p.z(), answer.matches, answer.rms_px)
                                : fmt::format("image {}   not corrected: {}", frame_, to_string(answer.reason));
  return video_->add(state_->overlay->draw(image, answer.X_WC, answer.corrected, words));
}

Result<bool> LocalizeRun::step() {
  auto next = input_->next();
  if (next.end) {
    if (!next.problem.empty()) notes_.push_back(next.problem);
    return false;
  }
  if (!next.image) {  // a damaged one: the next is another moment's
    notes_.push_back(next.problem);
    ++frame_;
    return true;
  }
  const auto answer = look(next.image.view());
  if (!answer) return tl::unexpected(answer.error());
  if (auto written = write(next.image.view(), *answer); !written) return tl::unexpected(written.error());
  corrected_ += answer->corrected ? 1 : 0;
  ++images_;
  ++frame_;
  return true;
}

Result<void> LocalizeRun::finish() {
  if (state_->first_pose) {
    const FirstPose& first = *state_->first_pose;
    notes_.push_back(first.outcome().empty()
                         ? fmt::format("first pose: not found: the images end while {}; a turn on the spot and a sixth "
                                       "of one more are needed, and then {}",
                                       to_string(first.phase()), "images without motion until it is found")
                         : first.outcome());
    if (auto drawn = draw_plan(); !drawn) return drawn;
  }
  return video_ ? video_->close() : Result<void>{};
}

Result<void> LocalizeRun::draw_plan() const {
  if (plan_file_.empty()) return {};
  return write_picture(plan_file_, draw_candidates(*state_->map, state_->first_pose->candidates()));
}

}  // namespace cgsr::app
