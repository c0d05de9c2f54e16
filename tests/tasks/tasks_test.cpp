// What the tasks around the loops do with what devices and rings give them.
#include "hal/dummy/dummy_switches.h"

#include <algorithm>
#include <optional>

#include <gtest/gtest.h>

#include "src/tasks/capture_task.h"
#include "src/tasks/switch_task.h"
#include "tests/tasks/painted_camera.h"

namespace cgsr::tasks::testing {
namespace {

/// A camera that fails in whatever way the test says.
class MoodyCamera final : public hal::Camera {
 public:
  Result<hal::CameraMode> start() override { return hal::CameraMode{}; }
  tl::expected<ImageLease, hal::CaptureFailure> next_image(MonoTime give_up_at) override {
    longest_wait = std::max(longest_wait, give_up_at - MonoTime{});
    if (waiting && (*waiting)-- == 0) return tl::unexpected(hal::CaptureFailure::kTimeout);
    if (failure) return tl::unexpected(*failure);
    return painted.image(number++);
  }
  void stop() override {}
  [[nodiscard]] std::string last_problem() const override { return "moody"; }

  PaintedCamera painted;
  std::optional<hal::CaptureFailure> failure;
  std::optional<int> waiting;  ///< images that it holds; none: always another one.
  std::uint64_t number = 0;
  Duration longest_wait{};
};

TEST(CaptureTask, PassesOverWhatACameraHoldsAtTheStart) {
  for (const auto failure : {std::optional<hal::CaptureFailure>{}, std::optional(hal::CaptureFailure::kCorrupt)}) {
    MoodyCamera camera;
    SimulatedClock clock;
    Links links;
    CaptureTask capture(camera, PaintedCamera::kPeriod, links);
    camera.waiting = 7;
    camera.failure = failure;
    EXPECT_EQ(capture.pass_over_waiting(clock), 7) << "damaged ones too";
    EXPECT_LT(camera.longest_wait, PaintedCamera::kPeriod / 2) << "a new image is not waited for";
    EXPECT_EQ(links.capture.images + links.capture.timeouts + links.capture.corrupt, 0u) << "no image of the run";
    camera.waiting.reset();
    camera.failure.reset();
    EXPECT_TRUE(capture.step({}));
    ASSERT_EQ(links.images.statistics().pushed, 1u);
    EXPECT_EQ(links.images.pop()->sequence(), failure ? 0u : 7u);
  }
}

TEST(CaptureTask, PassesOverNoMoreThanACameraCanHoldAndStopsWithOneThatIsGone) {
  MoodyCamera camera;
  SimulatedClock clock;
  Links links;
  CaptureTask capture(camera, PaintedCamera::kPeriod, links);
  EXPECT_EQ(capture.pass_over_waiting(clock), 32) << "one that always has another";
  camera.failure = hal::CaptureFailure::kDisconnected;
  EXPECT_EQ(capture.pass_over_waiting(clock), 0);
  EXPECT_FALSE(links.camera_lost) << "the first step says so";
}

TEST(CaptureTask, CountsEveryWayToFailAndGoesOnWhereItCan) {
  MoodyCamera camera;
  Links links;
  CaptureTask capture(camera, PaintedCamera::kPeriod, links);
  for (const auto failure :
       {hal::CaptureFailure::kTimeout, hal::CaptureFailure::kNoSlot, hal::CaptureFailure::kCorrupt}) {
    camera.failure = failure;
    EXPECT_TRUE(capture.step({}));
  }
  EXPECT_EQ(links.capture.timeouts, 1u);
  EXPECT_EQ(links.capture.no_slot, 1u);
  EXPECT_EQ(links.capture.corrupt, 1u);
  EXPECT_EQ(links.capture.images, 0u);
}

TEST(CaptureTask, TellsTheEndOfARecordingFromALostCamera) {
  for (const bool lost : {false, true}) {
    MoodyCamera camera;
    Links links;
    CaptureTask capture(camera, PaintedCamera::kPeriod, links);
    camera.failure = lost ? hal::CaptureFailure::kDisconnected : hal::CaptureFailure::kEndOfStream;
    EXPECT_FALSE(capture.step({}));
    EXPECT_EQ(links.camera_lost, lost);
    EXPECT_EQ(links.images_ended, !lost);
    EXPECT_TRUE(links.image_came.wait_until(MonoTime{})) << "vision is told at once";
  }
}

TEST(CaptureTask, AFullRingNeverBlocksAndIsCounted) {
  MoodyCamera camera;
  Links links;
  CaptureTask capture(camera, PaintedCamera::kPeriod, links);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(capture.step({}));
  EXPECT_EQ(links.images.statistics().dropped, 6u);
  EXPECT_EQ(links.images.statistics().high_water, 4u);
}

class SwitchTaskOf : public ::testing::Test {
 protected:
  SwitchTaskOf() { EXPECT_TRUE(switches_.start()); }
  std::optional<ArmRequest> after_step() {
    problem_ = task_.step();
    return links_.arm_requests.pop();
  }
  hal::DummySwitches switches_{{{"arm", hal::LineDirection::kInput, true}}};
  Links links_;
  SimulatedClock clock_;
  SwitchTask task_{switches_, {"arm", {}}, clock_, links_};
  std::optional<std::string> problem_;
};

TEST_F(SwitchTaskOf, ASwitchThatIsOnAtBootDoesNotArm) {
  EXPECT_EQ(after_step(), std::nullopt);
  EXPECT_EQ(after_step(), std::nullopt);
}

TEST_F(SwitchTaskOf, EdgesArmAndDisarm) {
  after_step();
  switches_.press("arm", false);
  EXPECT_EQ(after_step(), ArmRequest::kDisarm);
  switches_.press("arm", true);
  EXPECT_EQ(after_step(), ArmRequest::kArm);
  EXPECT_EQ(after_step(), std::nullopt);
}

TEST_F(SwitchTaskOf, ALineThatDoesNotAnswerDisarmsOnceAndIsNamed) {
  after_step();
  switches_.stop();
  EXPECT_EQ(after_step(), ArmRequest::kDisarm);
  ASSERT_TRUE(problem_);
  EXPECT_NE(problem_->find("arm"), std::string::npos) << *problem_;
  EXPECT_EQ(after_step(), std::nullopt);
  EXPECT_EQ(problem_, std::nullopt);
}

TEST_F(SwitchTaskOf, ALineThatAnswersAgainArmsByItsNextEdgeOnly) {
  after_step();
  switches_.stop();
  after_step();
  ASSERT_TRUE(switches_.start());
  switches_.press("arm", true);
  EXPECT_EQ(after_step(), std::nullopt);
  ASSERT_TRUE(problem_);
  EXPECT_NE(problem_->find("answers again"), std::string::npos) << *problem_;
  EXPECT_EQ(after_step(), std::nullopt);
  EXPECT_EQ(problem_, std::nullopt);
  switches_.press("arm", false);
  EXPECT_EQ(after_step(), ArmRequest::kDisarm);
  switches_.press("arm", true);
  EXPECT_EQ(after_step(), ArmRequest::kArm);
}

}  // namespace
}  // namespace cgsr::tasks::testing
