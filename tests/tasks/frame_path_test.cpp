// The whole way from an image to a wheel command, as the vision and motion threads walk it.
#include <gtest/gtest.h>

#include "hal/dummy/kinematic_drive.h"
#include "pipeline/stages/color_stages.h"
#include "pipeline/stages/tasks.h"
#include "src/config/robot.h"
#include "src/tasks/motion_task.h"
#include "src/tasks/vision_task.h"
#include "tests/support/allocation_guard.h"
#include "tests/tasks/painted_camera.h"

namespace cgsr::tasks::testing {
namespace {

/// A robot without threads and files: the loops, the links between them, and images that a test hands in.
class FramePath : public ::testing::Test {
 protected:
  FramePath()
      : schedule_(runtime::Schedule::make(runtime::rows_of(config_.stage), PaintedCamera::kPeriod)),
        runner_(clock_, *schedule_, runtime::BudgetSource::kUnits, links_.motion_stop),
        loop_(runner_, parts()),
        vision_(loop_, runner_, VisionSurroundings{}, stamps_, PaintedCamera::kPeriod, links_),
        motion_loop_(std::make_unique<hal::KinematicDrive>(), moving(), MotionLoop::Mode::kLive),
        motion_(motion_loop_, stop_, Duration::zero(), true, links_) {
    EXPECT_TRUE(loop_.bind());
    EXPECT_TRUE(motion_loop_.start());
  }

  /// Chapter 3's stages, and following.
  VisionParts parts() {
    VisionParts parts;
    auto color = *stages::ColorStages::make(camera_.learn(), config_.color.track, PaintedCamera::kWidth_px,
                                            PaintedCamera::kHeight_px);
    parts.put(std::move(color.decode));
    parts.put(std::move(color.search));
    parts.put(std::move(color.track));
    geometry::Camera optics;
    optics.fx_px = config_.camera.pinhole.fx_px;
    optics.cx_px = config_.camera.pinhole.cx_px;
    parts.make<stages::DecideStage>(
        std::make_unique<stages::FollowTask>(behavior::Follow(config_.follow, std::nullopt, config_.motion), optics));
    return parts;
  }

  static MotionParameters moving() {
    MotionParameters parameters;
    parameters.keep_in.enabled = false;
    return parameters;
  }

  /// One image through vision, and the motion control cycles until the next.
  void cycle(std::uint64_t number, bool absent = false) {
    ASSERT_TRUE(links_.images.push(camera_.image(number, absent)));
    ASSERT_TRUE(vision_.step());
    const MonoTime next{static_cast<std::int64_t>(number + 1) * PaintedCamera::kPeriod};
    for (; cycle_ < next; cycle_ += kMotionPeriod) motion_.step(cycle_);
    while (const auto report = links_.reports.pop()) frame_ = report->frame;
    while (links_.pictures.pop()) {
    }
    while (const auto status = links_.motions.pop()) status_ = *status;
  }

  PaintedCamera camera_;
  config::Robot config_;
  RealClock clock_;
  SimulatedClock stamps_;
  StopRequest stop_;
  Links links_;
  Result<runtime::Schedule> schedule_;
  runtime::StageRunner runner_;
  VisionLoop loop_;
  VisionTask vision_;
  MotionLoop motion_loop_;
  MotionTask motion_;
  MonoTime cycle_{};
  stages::FrameResult frame_;
  MotionStatus status_;
};

using FramePathAlloc = FramePath;

TEST_F(FramePath, AnImageGoesInAWheelCommandComesOut) {
  for (std::uint64_t i = 0; i < 200; ++i) cycle(i);
  ASSERT_TRUE(frame_.objects.value.first().object.found);
  EXPECT_GT(intersection(frame_.objects.value.first().object.box, PaintedCamera::patch(199)).area(),
            0.6 * PaintedCamera::patch(199).area());
  EXPECT_TRUE(status_.armed);
  EXPECT_EQ(status_.cause, StopCause::kNone);
  EXPECT_NE(status_.commanded.left_radps, 0.0);
}

TEST_F(FramePath, TheRobotStopsWhenTheObjectIsGoneAndFollowsAgainWhenItIsBack) {
  for (std::uint64_t i = 0; i < 120; ++i) cycle(i);
  ASSERT_EQ(frame_.decision.value.state, to_string(behavior::FollowState::kFollowing));
  for (std::uint64_t i = 120; i < 145; ++i) cycle(i, true);
  EXPECT_FALSE(frame_.objects.value.first().object.found);
  EXPECT_EQ(frame_.decision.value.state, to_string(behavior::FollowState::kStanding));
  EXPECT_EQ(status_.commanded.forward_mps, 0.0);
  cycle(145);
  cycle(146);
  EXPECT_EQ(frame_.decision.value.state, to_string(behavior::FollowState::kFollowing));
}

TEST_F(FramePath, WithoutImagesTheDeadManStopsTheWheels) {
  for (std::uint64_t i = 0; i < 200; ++i) cycle(i);
  ASSERT_NE(status_.commanded.left_radps, 0.0);
  const MonoTime last_stamp{199 * PaintedCamera::kPeriod};
  while (cycle_ < last_stamp + seconds(0.17)) motion_.step(cycle_ += kMotionPeriod);
  while (const auto status = links_.motions.pop()) status_ = *status;
  EXPECT_EQ(status_.cause, StopCause::kGoalStale);
  EXPECT_EQ(status_.commanded.forward_mps, 0.0);
  EXPECT_EQ(status_.commanded.left_radps, 0.0);
}

// Object present, absent and back: no code on the path from image to command takes memory, and no page is touched for the first time.
TEST_F(FramePathAlloc, NothingAllocatesAndNoPageFaultsAfterTheWarmUp) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  for (std::uint64_t i = 0; i < 90; ++i) cycle(i, i / 10 % 3 == 2);
  const test::AllocationGuard guard;
  for (std::uint64_t i = 90; i < 390; ++i) cycle(i, i / 10 % 3 == 2);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(guard.page_faults(), 0u);
}

}  // namespace
}  // namespace cgsr::tasks::testing
