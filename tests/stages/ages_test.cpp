// Every reader of a stage's output states how old is too old: the producer is skipped, faults or lags, and the reader does without.
#include <optional>

#include <gtest/gtest.h>

#include "pipeline/stages/color_stages.h"
#include "pipeline/stages/tasks.h"
#include "pipeline/world/load.h"
#include "src/config/color.h"
#include "tests/support/counted_budget.h"
#include "tests/tasks/painted_camera.h"

namespace cgsr::stages {
namespace {

using tasks::testing::PaintedCamera;

template <class Output>
runtime::Aged<Output> aged(Output output, Duration age) {
  return {std::move(output), {}, age};
}

constexpr Duration kFrame = seconds(1.0 / 30.0);
constexpr Duration kNow = Duration::zero();

PoseEstimate known_pose() {
  PoseEstimate pose;
  pose.has_map = true;
  pose.robot = {true, 4.6, 3.2, 0.0};
  pose.camera.covariance = 1e-5 * geometry::Matrix6d::Identity();
  return pose;
}

LampReport known_lamp() {
  LampReport report;
  report.has_board = true;
  report.known = true;
  report.observation = illumination::ObservationStatus::kSeen;
  report.lamp.p_WL = {4.0, 3.0, 2.0};
  report.lamp.covariance = 1e-4 * Eigen::Matrix3d::Identity();
  return report;
}

class ColorEdges : public ::testing::Test {
 protected:
  ColorEdges()
      : stages_(*ColorStages::make(camera_.learn(), config::Color{}.track, PaintedCamera::kWidth_px,
                                   PaintedCamera::kHeight_px)),
        image_(camera_.image(0, false)),
        view_(stages_.decode->update(image_.view())) {}

  PaintedCamera camera_;
  ColorStages stages_;
  ImageLease image_;
  View view_;
  UnlimitedBudget budget_;
};

TEST_F(ColorEdges, SearchAndTrackReadTheLabelsOfThisImageAlone) {
  EXPECT_GT(stages_.search->update(budget_, aged(view_, kNow), {})->count, 0);
  EXPECT_EQ(stages_.search->update(budget_, aged(view_, kFrame), {})->count, 0);
  EXPECT_EQ(stages_.search->update(budget_, {}, {})->count, 0) << "decode never ran";

  const auto matches = aged(*stages_.search->update(budget_, aged(view_, kNow), {}), kNow);
  EXPECT_FALSE(
      stages_.track->update(budget_, image_.view(), aged(view_, kFrame), matches, {}, {}).first().object.found);
  EXPECT_TRUE(stages_.track->update(budget_, image_.view(), aged(view_, kNow), matches, {}, {}).first().object.found);
}

TEST_F(ColorEdges, EverySecondImageIsSearchedWhileTheObjectIsSure) {
  TrackedObjects objects;
  objects.count = 1;
  objects.next_search = {40.0, 40.0};
  objects.tracks.front().object.found = true;
  const auto searched = [&](double confidence) {
    objects.tracks.front().object.confidence = confidence;
    return stages_.search->update(budget_, aged(view_, kNow), aged(objects, kFrame)).has_value();
  };
  EXPECT_FALSE(searched(0.95));
  EXPECT_TRUE(searched(0.95));
  EXPECT_FALSE(searched(0.95));
  EXPECT_TRUE(searched(0.8)) << "in doubt";
  EXPECT_TRUE(searched(0.8));
  EXPECT_FALSE(searched(0.95));
  objects.tracks.front().object.found = false;
  EXPECT_TRUE(searched(0.95)) << "lost";
  EXPECT_TRUE(searched(0.0)) << "mode plain gives no confidence";
}

TEST_F(ColorEdges, TrackDoesWithoutWindowsThatAreTooOld) {
  const auto windows = *stages_.search->update(budget_, aged(view_, kNow), {});
  const auto old = aged(windows, TrackStage::kMaxMatchesAge + kFrame);
  EXPECT_FALSE(stages_.track->update(budget_, image_.view(), aged(view_, kNow), old, {}, {}).first().object.found);
  const auto young = aged(windows, TrackStage::kMaxMatchesAge);
  EXPECT_TRUE(stages_.track->update(budget_, image_.view(), aged(view_, kNow), young, {}, {}).first().object.found);
}

TEST_F(ColorEdges, TrackLooksForNothingWhenTheLastDecisionSaysSo) {
  const auto matches = aged(*stages_.search->update(budget_, aged(view_, kNow), {}), kNow);
  const Requests none{.track = false, .check = {}, .lamps = {}};
  EXPECT_FALSE(
      stages_.track->update(budget_, image_.view(), aged(view_, kNow), matches, {}, none).first().object.found);
}

class ShadeEdges : public ::testing::Test {
 protected:
  ShadeEdges()
      : map_(std::make_shared<const world::Map>(*world::load_map(CGSR_SOURCE_DIR "/config/maps/home/map.obj"))),
        stage_(map_, camera(), {}) {}

  /// One turn, in which the place of the lamp is prepared; from then on there are masks.
  void prepare() {
    EXPECT_EQ(stage_.update(budget_, aged(known_pose(), kNow), aged(known_lamp(), kNow))->status,
              ShadeStatus::kPreparing);
  }

  static geometry::Camera camera() {
    geometry::Camera camera;
    camera.width_px = 640;
    camera.height_px = 480;
    camera.fx_px = camera.fy_px = 600.0;
    camera.cx_px = 319.5;
    camera.cy_px = 239.5;
    return camera;
  }

  std::shared_ptr<const world::Map> map_;
  ShadeStage stage_;
  UnlimitedBudget budget_;
};

TEST_F(ShadeEdges, MasksNeedThePoseOfThisImage) {
  prepare();
  const auto lamp = aged(known_lamp(), kNow);
  EXPECT_EQ(stage_.update(budget_, aged(known_pose(), kFrame), lamp)->status, ShadeStatus::kPoseUnknown);
  EXPECT_EQ(stage_.update(budget_, {}, lamp)->status, ShadeStatus::kPoseUnknown);
  EXPECT_EQ(stage_.update(budget_, aged(known_pose(), kNow), lamp)->status, ShadeStatus::kMasked);
}

TEST_F(ShadeEdges, AChangeOfTheStatusIsAnEventOnce) {
  const auto pose = aged(known_pose(), kNow);
  const auto none = stage_.update(budget_, pose, {});
  ASSERT_EQ(none->events.size(), 1U);
  EXPECT_EQ(none->events.begin()->source, "shadow masks");
  EXPECT_EQ(none->events.begin()->state, "no lamp known");
  EXPECT_EQ(stage_.update(budget_, pose, {})->events.size(), 0U) << "as it was";
  EXPECT_EQ(stage_.update(budget_, {}, {})->events.begin()->state, to_string(ShadeStatus::kPoseUnknown));
}

TEST_F(ShadeEdges, ALampThatItsStageDoesNotRenewIsNotUsedForLong) {
  prepare();
  const auto pose = aged(known_pose(), kNow);
  EXPECT_EQ(stage_.update(budget_, pose, aged(known_lamp(), ShadeStage::kMaxLampAge))->status, ShadeStatus::kMasked);
  EXPECT_EQ(stage_.update(budget_, pose, aged(known_lamp(), ShadeStage::kMaxLampAge + kFrame))->status,
            ShadeStatus::kNoLamp);
  EXPECT_EQ(stage_.update(budget_, pose, {})->status, ShadeStatus::kNoLamp);
}

// A robot without probes has the lamp of its configuration; one with probes believes these, whatever the configuration says.
TEST_F(ShadeEdges, TheLampOfTheConfigurationCountsWithoutABoardAlone) {
  ShadeStageParameters parameters;
  parameters.lamp = {true, {4.0, 3.0, 2.0}, 0.05};
  ShadeStage given(map_, camera(), parameters);
  const auto pose = aged(known_pose(), kNow);
  EXPECT_EQ(given.update(budget_, pose, {})->status, ShadeStatus::kPreparing);
  EXPECT_EQ(given.update(budget_, pose, {})->status, ShadeStatus::kMasked);
  LampReport dark;
  dark.has_board = true;
  EXPECT_EQ(given.update(budget_, pose, aged(dark, kNow))->status, ShadeStatus::kNoLamp);
}

TEST_F(ShadeEdges, WithoutARoomForNewMasksItSaysSo) {
  prepare();
  std::vector<ShadowMasks> held;
  for (int i = 0; i < 20; ++i) {
    held.push_back(*stage_.update(budget_, aged(known_pose(), kNow), aged(known_lamp(), kNow)));
    if (held.back().status == ShadeStatus::kNoRoom) break;
  }
  EXPECT_EQ(held.back().status, ShadeStatus::kNoRoom);
  held.clear();
  EXPECT_EQ(stage_.update(budget_, aged(known_pose(), kNow), aged(known_lamp(), kNow))->status, ShadeStatus::kMasked);
}

TEST_F(ShadeEdges, ANewPlaceOfTheLampIsPreparedOverImages) {
  const auto pose = aged(known_pose(), kNow);
  LampReport lamp = known_lamp();
  const auto status = [&](int units) -> std::optional<ShadeStatus> {
    CountedBudget budget(units);
    const auto output = stage_.update(budget, pose, aged(lamp, kNow));
    if (!output) return std::nullopt;
    return output->status;
  };
  EXPECT_EQ(status(30), ShadeStatus::kPreparing) << "there were no silhouettes before";
  int images = 1;
  while (images < 200 && status(30) == ShadeStatus::kPreparing) ++images;
  EXPECT_GT(images, 5);
  EXPECT_LT(images, 200);
  EXPECT_EQ(status(30), ShadeStatus::kMasked);
  lamp.lamp.p_WL.x() += 0.1;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(status(30), std::nullopt) << "a little way: work on the new silhouettes, the last masks stay";
    EXPECT_EQ(status(30), ShadeStatus::kMasked) << "the old ones serve, widened";
  }
  lamp.lamp.p_WL.x() += 1.0;
  EXPECT_EQ(status(30), ShadeStatus::kPreparing) << "another lamp: the old ones would be wrong";
  EXPECT_EQ(status(30), ShadeStatus::kPreparing);
  EXPECT_EQ(status(100'000), ShadeStatus::kPreparing) << "done, and its turn with it";
  EXPECT_EQ(status(0), ShadeStatus::kMasked);
}

TEST(RouteEdges, ARobotStopsWhenItsPoseIsTooOld) {
  RouteTask task(behavior::Route({}, {{9.0, 3.2}}));
  FrameResult frame;
  const ImageView image;
  frame.pose = aged(known_pose(), kMaxPoseAge);
  Decision decision;
  for (int i = 0; i < 30; ++i) decision = task.decide(frame, image, kFrame);
  EXPECT_GT(decision.goal.forward_mps, 0.0);
  frame.pose.age = kMaxPoseAge + kFrame;
  decision = task.decide(frame, image, kFrame);
  EXPECT_TRUE(decision.halt);
  EXPECT_EQ(decision.goal.forward_mps, 0.0);
}

TEST(FollowEdges, ARobotStopsForAnObjectThatWasSeenTooLongAgo) {
  geometry::Camera optics;
  optics.fx_px = 600.0;
  optics.cx_px = 320.0;
  FollowTask task(behavior::Follow({}, behavior::LearnedSize{60.0, 60.0}), optics);
  FrameResult frame;
  frame.objects.value.count = 1;
  frame.objects.value.tracks.front().object = {true, {300.0, 200.0, 40.0, 40.0}, 0.1, {}, {}};
  frame.objects.age = kNow;
  ImageView image;
  image.width_px = 640;
  image.height_px = 480;
  EXPECT_FALSE(task.decide(frame, image, kFrame).halt);
  frame.objects.age = seconds(2.0);
  EXPECT_TRUE(task.decide(frame, image, kFrame).halt);
}

}  // namespace
}  // namespace cgsr::stages
