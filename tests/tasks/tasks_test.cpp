// What the tasks around the loops do with what devices and rings give them.
#include "hal/dummy/dummy_switches.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/dummy/kinematic_drive.h"
#include "src/tasks/capture_task.h"
#include "src/tasks/motion_task.h"
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

/// The switch worker and the motion loop, a control cycle after another; the worker may hang.
class ArmingReportFault : public ::testing::Test {
 protected:
  ArmingReportFault() {
    EXPECT_TRUE(switches_.start());
    links_.images_in_time = true;
    make_motion();
  }

  /// \param arm  as --arm does.  \param armed_at_start  as the robot's file does.
  void make_motion(bool arm = false, bool armed_at_start = false) {
    MotionParameters parameters = anywhere();
    parameters.armed_at_start = armed_at_start;
    motion_.reset();
    motion_loop_.emplace(std::make_unique<hal::KinematicDrive>(), parameters, MotionLoop::Mode::kLive);
    EXPECT_TRUE(motion_loop_->start());
    motion_.emplace(*motion_loop_, stop_, Duration::zero(), arm, links_);
  }

  static MotionParameters anywhere() {
    MotionParameters parameters;
    parameters.keep_in.enabled = false;
    return parameters;
  }

  /// \return what the wheels were told last.
  MotionStatus run(double duration_s, bool hung = false) {
    for (const MonoTime end = now_ + seconds(duration_s); now_ < end; now_ += kMotionPeriod) {
      clock_.advance_to(now_);
      if (!hung && now_ >= next_look_) {
        if (auto news = worker_.step()) news_.push_back(*news);
        next_look_ = now_ + kSwitchPeriod;
      }
      EXPECT_TRUE(links_.goals.push(Goal{{0.2, 0.0}, now_}));
      motion_->step(now_);
      while (const auto status = links_.motions.pop()) status_ = *status;
    }
    return status_;
  }
  void press(bool on) { switches_.press("arm", on); }
  /// Until the cycle after a look at the line.
  void run_past_a_look() {
    do {
      run(to_seconds(kMotionPeriod));
    } while (next_look_ != now_ - kMotionPeriod + kSwitchPeriod);
  }

  hal::DummySwitches switches_{{{"arm", hal::LineDirection::kInput}}};
  Links links_;
  SimulatedClock clock_;
  StopRequest stop_;
  SwitchTask worker_{switches_, {"arm", {}}, clock_, links_};
  std::optional<MotionLoop> motion_loop_;
  std::optional<MotionTask> motion_;
  MonoTime now_{};
  MonoTime next_look_{};
  MotionStatus status_;
  std::vector<std::string> news_;
};

TEST_F(ArmingReportFault, AWorkerThatHangsStopsTheRobotUntilTheSwitchIsOffAndOn) {
  run(1.5);
  press(true);
  ASSERT_GT(run(0.5).commanded.forward_mps, 0.0);

  EXPECT_TRUE(run(to_seconds(kMaxArmingReportAge) - 0.1, true).armed) << "a driver may block for a while";
  const MotionStatus hung = run(0.2, true);
  EXPECT_FALSE(hung.armed);
  EXPECT_EQ(hung.commanded.forward_mps, 0.0);
  EXPECT_EQ(hung.cause, StopCause::kSafetyFault);
  EXPECT_TRUE(news_.empty());

  const MotionStatus reports_again = run(2.0);
  EXPECT_FALSE(reports_again.armed) << "its level does not arm";
  EXPECT_EQ(reports_again.cause, StopCause::kDisarmed);
  ASSERT_EQ(news_.size(), 1u);
  EXPECT_NE(news_.front().find("answers again"), std::string::npos) << news_.front();
  press(false);
  EXPECT_FALSE(run(0.2).armed);
  press(true);
  EXPECT_TRUE(run(0.2).armed);
}

// Switched on while the worker hung: nobody knows when.
TEST_F(ArmingReportFault, AnEdgeThatFellIntoTheHangDoesNotArm) {
  run(1.5);
  run(2.0, true);
  press(true);
  EXPECT_FALSE(run(0.5).armed);
  press(false);
  run(0.1);
  press(true);
  EXPECT_TRUE(run(0.1).armed);
}

// Motion never takes the report for old: the worker reads the line a moment before it would.
TEST_F(ArmingReportFault, AHangThatEndsBetweenTwoMotionCyclesDisarms) {
  run(1.5);
  press(true);
  ASSERT_TRUE(run(0.5).armed);
  run_past_a_look();
  const MotionStatus hung = run(to_seconds(kMaxArmingReportAge), true);
  ASSERT_TRUE(hung.armed) << "not old yet";
  press(false);
  const MotionStatus reports_again = run(to_seconds(kMotionPeriod));
  EXPECT_FALSE(reports_again.armed);
  EXPECT_EQ(reports_again.cause, StopCause::kDisarmed);
  EXPECT_FALSE(run(1.0).armed);
}

// An arming that waits for the images does not outlast a hang: the switch may be off since.
TEST_F(ArmingReportFault, AHangEndsAnArmingThatIsPending) {
  for (const bool by_command : {true, false}) {
    for (const bool hangs : {false, true}) {
      make_motion(by_command, !by_command);
      links_.images_in_time = false;
      press(true);
      ASSERT_FALSE(run(1.5).armed);
      const MotionStatus hung = run(1.0, hangs);
      ASSERT_FALSE(hung.armed);
      if (hangs) press(false);
      links_.images_in_time = true;
      for (int cycle = 0; cycle < 100; ++cycle) {
        const bool armed = run(to_seconds(kMotionPeriod)).armed;
        if (hangs) {
          ASSERT_FALSE(armed) << "by " << (by_command ? "command" : "configuration") << ", cycle " << cycle;
        }
      }
      EXPECT_EQ(status_.armed, !hangs);
    }
  }
}

// A disarm that finds no room leaves the report old, and is repeated.
TEST_F(ArmingReportFault, AHangDisarmsThoughTheRequestsAreFullAtItsEnd) {
  run(1.5);
  run_past_a_look();
  while (links_.arm_requests.push(ArmRequest::kNone)) {
  }
  clock_.advance_to(now_ + seconds(1.0));
  EXPECT_EQ(worker_.step(), std::nullopt);
  EXPECT_TRUE(links_.arming_report.is_old(clock_.now())) << "nothing may be armed yet";
  while (links_.arm_requests.pop()) {
  }
  EXPECT_TRUE(worker_.step());
  EXPECT_EQ(links_.arm_requests.pop(), ArmRequest::kDisarm);
  EXPECT_FALSE(links_.arming_report.is_old(clock_.now()));
}

TEST_F(ArmingReportFault, ALineThatWasNeverReadDoesNotLetArmByCommandEither) {
  run(1.5, true);
  ASSERT_TRUE(links_.arm_requests.push(ArmRequest::kArm));
  EXPECT_FALSE(run(0.1, true).armed);
}

}  // namespace
}  // namespace cgsr::tasks::testing
