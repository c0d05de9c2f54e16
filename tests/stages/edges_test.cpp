// Every edge between two stages, with a producer that skips its turns, faults, or has nothing new: the reader uses its last output up to the age
// that the reader states, and not one frame longer.
#include <functional>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "pipeline/runtime/stage.h"
#include "pipeline/stages/ball_track.h"
#include "pipeline/stages/color_stages.h"
#include "pipeline/stages/decide_stage.h"
#include "pipeline/stages/tasks.h"
#include "pipeline/world/load.h"
#include "src/config/color.h"
#include "tests/color/ball_scene.h"
#include "tests/illumination/drawn_board.h"
#include "tests/support/counted_budget.h"
#include "tests/tasks/painted_camera.h"

namespace cgsr::stages {
namespace {

using tasks::testing::PaintedCamera;

constexpr Duration kFrame = std::chrono::milliseconds(50);  // every age that a stage states is a whole number of these
constexpr int kLongest = 59;                                // frames

enum class Failure { kSkips, kFaults, kLags };

/// Gives its output in the first frame; then, where it has a turn at all, it throws or has nothing new.
template <class Value>
struct Producer {
  using Output = Value;
  static constexpr std::string_view kName = "producer";
  Value value;
  Failure failure;

  std::optional<Value> update(int frame) const {
    if (frame == 0) return value;
    if (failure == Failure::kFaults) throw std::runtime_error("made up");
    return std::nullopt;
  }
};

/// What readers get of an output so many frames after it was made.
template <class Value>
runtime::Aged<Value> after(int frames, Failure failure, const Value& value) {
  const SimulatedClock clock;
  runtime::MotionStop stop;
  const runtime::StageParameters row{failure == Failure::kSkips ? kLongest + 1 : 1, 0, 1000, 0,
                                     runtime::OnOverrun::kSkip};
  auto schedule = runtime::Schedule::make({{"producer", row}}, kFrame);
  runtime::StageRunner runner(clock, *schedule, runtime::BudgetSource::kUnits, stop);
  runtime::Stage<Producer<Value>> stage(std::make_unique<Producer<Value>>(Producer<Value>{value, failure}));
  EXPECT_TRUE(runner.bind(stage));
  for (int frame = 0; frame <= frames; ++frame) {
    runner.begin_frame({MonoTime{} + frame * kFrame, static_cast<std::uint64_t>(frame), true});
    runner.run(stage, frame);
    runner.end_frame();
  }
  return stage.last();
}

PoseEstimate known_pose() {
  PoseEstimate pose;
  pose.has_map = true;
  pose.robot = {true, 4.6, 3.2, 0.0};
  pose.camera.state = localization::TrackState::kTracking;
  pose.camera.covariance = 1e-5 * geometry::Matrix6d::Identity();
  return pose;
}

LampReport known_lamp() {
  LampReport report;
  report.has_board = true;
  report.known = true;
  report.requests_probe_lamp = true;
  report.lamp.p_WL = {4.0, 3.0, 2.0};
  report.lamp.covariance = 1e-4 * Eigen::Matrix3d::Identity();
  return report;
}

geometry::Camera camera_of(int width_px, int height_px) {
  geometry::Camera camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.fx_px = camera.fy_px = width_px;
  camera.cx_px = 0.5 * (width_px - 1);
  camera.cy_px = 0.5 * (height_px - 1);
  return camera;
}

std::shared_ptr<const world::Map> home() {
  static const auto kMap =
      std::make_shared<const world::Map>(*world::load_map(CGSR_SOURCE_DIR "/config/maps/home/map.obj"));
  return kMap;
}

/// Chapter 3's stages before an image in which the object is, never run before.
struct Color {
  PaintedCamera camera;
  ColorStages stages =
      *ColorStages::make(camera.learn(), config::Color{}.track, PaintedCamera::kWidth_px, PaintedCamera::kHeight_px);
  ImageLease image = camera.image(0, false);
  UnlimitedBudget budget;

  View view() { return stages.decode->update(image.view()); }
  color::SearchResult windows() { return *stages.search->update(budget, after(0, Failure::kLags, view()), {}); }
};

bool search_reads_decode(int frames, Failure failure) {
  Color c;
  return c.stages.search->update(c.budget, after(frames, failure, c.view()), {})->count > 0;
}

bool search_reads_track(int frames, Failure failure) {
  Color c;
  TrackedObjects objects;
  objects.next_search = {100.0, 100.0};
  const auto view = after(0, failure, c.view());
  const int first = c.stages.search->update(c.budget, view, {})->windows;
  return c.stages.search->update(c.budget, view, after(frames, failure, objects))->windows != first;
}

bool track_reads_decode(int frames, Failure failure) {
  Color c;
  const auto windows = after(0, failure, c.windows());
  return c.stages.track->update(c.budget, c.image.view(), after(frames, failure, c.view()), windows, {}, {})
      .first()
      .object.found;
}

bool track_reads_search(int frames, Failure failure) {
  Color c;
  const auto view = after(0, failure, c.view());
  return c.stages.track->update(c.budget, c.image.view(), view, after(frames, failure, c.windows()), {}, {})
      .first()
      .object.found;
}

bool track_reads_shade(int frames, Failure failure) {
  auto tracker =
      color::IntegratedTracker::create(test::ball_model(), {}, test::kBallWidth_px, test::kBallHeight_px, 300.0);
  TrackStage track(std::move(*tracker));
  const test::QuarterMask quarter;
  Pool<shade::ShadeMasks> pool(1, shade::ShadeMasks{40, 30, quarter.cells, quarter.cells});
  const auto masks = after(frames, failure, ShadowMasks{ShadeStatus::kMasked, pool.take()});
  UnlimitedBudget budget;
  auto room = test::ball_room();
  return track.update(budget, room.photograph(1.5, 1), {}, {}, masks, {}).first().ball.mask_used;
}

/// A brown ball whose ray may be shaded, in a map where nothing throws shade on its place.
bool track_reads_places(int frames, Failure failure) {
  constexpr double kShade = 0.45;
  auto tracker =
      color::IntegratedTracker::create(test::ball_model(), {}, test::kBallWidth_px, test::kBallHeight_px, 300.0);
  TrackStage track(std::move(*tracker));
  static const world::Map kNothing;
  const auto volumes = std::make_shared<shade::ShadowVolumes>(kNothing, shade::ShadeParameters());
  volumes->look(geometry::Pose::Identity(), camera_of(test::kBallWidth_px, test::kBallHeight_px), {0.0, -2.0, 0.0});
  const test::QuarterMask quarter;
  Pool<shade::ShadeMasks> pool(1, shade::ShadeMasks{40, 30, quarter.cells, quarter.cells});
  const auto masks = after(frames, failure, ShadowMasks{ShadeStatus::kMasked, pool.take(), {}, volumes});
  UnlimitedBudget budget;
  auto room = test::ball_room(kShade);
  test::paint_ball(room, {240.0, 185.0, 15.0}, kShade);
  return !track.update(budget, room.photograph(1.5, 1), {}, {}, masks, {}).first().ball.found;
}

bool localize_reads_decode(int frames, Failure failure) {
  LocalizationSetup setup;
  setup.map = home();
  setup.camera = camera_of(640, 480);
  setup.start = localization::prior_at(geometry::Pose::Identity(), {});
  LocalizeStage localize(std::move(setup));
  const std::vector<std::uint8_t> pixels(std::size_t{640} * 480 * 2, 128);
  const ImageView image{pixels.data(), 640, 480, std::ptrdiff_t{640} * 2, PixelFormat::kYuyv};
  DecodeStage decode({640, 480, {}, {}});
  UnlimitedBudget budget;
  return localize.update(budget, image, after(frames, failure, decode.update(image)), std::nullopt).has_map;
}

bool probes_reads_localize(int frames, Failure failure) {
  const auto board = illumination::make_board(illumination::shipped_probes().board, illumination::shipped_mount(),
                                              illumination::shipped_camera());
  ProbesStage probes(*board, illumination::shipped_probes(), {}, illumination::shipped_mount());
  const int width_px = board->camera.width_px;
  const int height_px = board->camera.height_px;
  const std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width_px * height_px), 128);
  const ImageView image{pixels.data(), width_px, height_px, width_px, PixelFormat::kGrey8};
  return probes.update(image, after(frames, failure, known_pose()), LampLines{}, Requests{}).pose_known;
}

ShadeStatus shade_status(const runtime::Aged<PoseEstimate>& pose, const runtime::Aged<LampReport>& lamp) {
  ShadeStage shade(home(), camera_of(640, 480), {});
  CountedBudget nothing(0);
  return shade.update(nothing, pose, lamp)->status;  // kPreparing: both were used
}

bool shade_reads_localize(int frames, Failure failure) {
  const auto lamp = after(0, failure, known_lamp());
  return shade_status(after(frames, failure, known_pose()), lamp) == ShadeStatus::kPreparing;
}

bool shade_reads_probes(int frames, Failure failure) {
  const auto pose = after(0, failure, known_pose());
  return shade_status(pose, after(frames, failure, known_lamp())) == ShadeStatus::kPreparing;
}

bool route_reads_localize(int frames, Failure failure) {
  RouteTask task(behavior::Route({}, {{9.0, 3.2}}));
  FrameResult frame;
  frame.pose = after(frames, failure, known_pose());
  return !task.decide(frame, ImageView{}, kFrame).halt;
}

bool follow_reads_track(int frames, Failure failure) {
  FollowTask task(behavior::Follow({}, behavior::LearnedSize{60.0, 60.0}), camera_of(640, 480));
  TrackedObjects objects;
  objects.count = 1;
  objects.tracks.front().object = {true, {300.0, 200.0, 40.0, 40.0}, 0.1, {}, {}};
  FrameResult frame;
  frame.objects = after(frames, failure, objects);
  ImageView image;
  image.width_px = 640;
  image.height_px = 480;
  return !task.decide(frame, image, kFrame).halt;
}

bool decide_reads_probes(int frames, Failure failure) {
  DecideStage decide(std::make_unique<RouteTask>(behavior::Route({}, {{9.0, 3.2}})));
  FrameResult frame;
  frame.lamp = after(frames, failure, known_lamp());
  return decide.update(ImageLease{}, frame).requests.lamps[static_cast<std::size_t>(LampLine::kProbeLamp)];
}

struct Edge {
  std::string name;
  Duration max_age;
  std::function<bool(int frames, Failure failure)> uses;
};

std::vector<Edge> edges() {
  return {{"SearchReadsDecode", Duration::zero(), search_reads_decode},
          {"SearchReadsTrack", seconds(0.5), search_reads_track},
          {"TrackReadsDecode", Duration::zero(), track_reads_decode},
          {"TrackReadsSearch", TrackStage::kMaxMatchesAge, track_reads_search},
          {"TrackReadsShade", kMaxMaskAge, track_reads_shade},
          {"TrackReadsPlaces", kMaxPlacesAge, track_reads_places},
          {"LocalizeReadsDecode", Duration::zero(), localize_reads_decode},
          {"ProbesReadsLocalize", Duration::zero(), probes_reads_localize},
          {"ShadeReadsLocalize", Duration::zero(), shade_reads_localize},
          {"ShadeReadsProbes", ShadeStage::kMaxLampAge, shade_reads_probes},
          {"RouteReadsLocalize", kMaxPoseAge, route_reads_localize},
          {"FollowReadsTrack", seconds(behavior::FollowParameters{}.max_box_age_s), follow_reads_track},
          {"DecideReadsProbes", kMaxLampReportAge, decide_reads_probes}};
}

class Edges : public ::testing::TestWithParam<Edge> {};

TEST_P(Edges, ReadNothingOlderThanTheyState) {
  const int frames = static_cast<int>(GetParam().max_age / kFrame);
  ASSERT_EQ(frames * kFrame, GetParam().max_age);
  for (const Failure failure : {Failure::kSkips, Failure::kFaults, Failure::kLags}) {
    EXPECT_TRUE(GetParam().uses(frames, failure)) << static_cast<int>(failure);
    EXPECT_FALSE(GetParam().uses(frames + 1, failure)) << static_cast<int>(failure);
    EXPECT_FALSE(GetParam().uses(kLongest, failure)) << static_cast<int>(failure);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Edges, ::testing::ValuesIn(edges()), [](const auto& edge) { return edge.param.name; });

}  // namespace
}  // namespace cgsr::stages
