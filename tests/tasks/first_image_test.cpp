// The first image of a robot that boots: the first whole one, and never an endless wait.
#include "src/boot/first_image.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <deque>
#include <memory>
#include <thread>

#include "src/boot/robot_state.h"
#include "tests/tasks/painted_camera.h"

namespace cgsr::boot {
namespace {

using hal::CaptureFailure;

/// Fails in the order that the test says; then its images are whole.
class StartingCamera final : public hal::Camera {
 public:
  explicit StartingCamera(std::deque<CaptureFailure> failures) : failures_(std::move(failures)) {}

  Result<hal::CameraMode> start() override { return hal::CameraMode{}; }
  tl::expected<ImageLease, CaptureFailure> next_image(MonoTime) override {
    if (failures_.empty()) return painted_.image(number_++);
    const CaptureFailure failure = failures_.front();
    failures_.pop_front();
    ++number_;
    return tl::unexpected(failure);
  }
  void stop() override {}
  [[nodiscard]] std::string last_problem() const override { return "its buffer was flagged"; }

 private:
  std::deque<CaptureFailure> failures_;
  std::uint64_t number_ = 0;
  tasks::testing::PaintedCamera painted_;
};

auto tries(int count) {
  return [count]() mutable -> std::optional<MonoTime> {
    if (count-- == 0) return std::nullopt;
    return MonoTime{};
  };
}

TEST(FirstImage, PassesOverDamagedAndMissingOnes) {
  StartingCamera camera({CaptureFailure::kCorrupt, CaptureFailure::kTimeout, CaptureFailure::kNoSlot});
  const auto image = first_good_image(camera, tries(4));
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->sequence(), 3u);
}

TEST(FirstImage, GivesUpWithWhatItMetAndWhatTheCameraSays) {
  StartingCamera camera({CaptureFailure::kCorrupt, CaptureFailure::kCorrupt, CaptureFailure::kTimeout});
  const auto image = first_good_image(camera, tries(3));
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().message, "no first image but 2 damaged: its buffer was flagged");
}

TEST(FirstImage, DoesNotWaitForACameraThatIsGoneOrARecordingThatEnded) {
  for (const auto end : {CaptureFailure::kDisconnected, CaptureFailure::kEndOfStream}) {
    StartingCamera camera({end});
    EXPECT_FALSE(first_good_image(camera, tries(10)));
  }
}

/// Never has an image, and waits for it as long as it is told.
class DarkCamera final : public hal::Camera {
 public:
  explicit DarkCamera(int* stops) : stops_(stops) {}
  Result<hal::CameraMode> start() override { return hal::CameraMode{}; }
  tl::expected<ImageLease, CaptureFailure> next_image(MonoTime give_up_at) override {
    RealClock clock;
    clock.sleep_until(give_up_at);
    return tl::unexpected(CaptureFailure::kTimeout);
  }
  void stop() override { ++*stops_; }
  [[nodiscard]] std::string last_problem() const override { return "no image"; }

 private:
  int* stops_;
};

/// A robot waits for its first image in a step that loads, and is told to end.
/// \return 0: in order, within a second; its camera was stopped.
int exit_code_of_a_wait(int signal, bool as_service) {
  StopRequest stop;
  const StopOnSignals signals(stop);
  int stops = 0;
  const auto begin = std::chrono::steady_clock::now();
  {
    RobotState state;
    state.setup.config.run.pace = config::Pace::kLive;
    state.setup.config.camera.kind = as_service ? config::CameraKind::kV4l2 : config::CameraKind::kReplay;
    if (as_service) state.setup.options.wait_for_devices = &stop;
    state.devices.camera = std::make_unique<DarkCamera>(&stops);
    state.loading.emplace(kInterruptedWhileLoading);
    std::thread killer([signal] {
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      kill(getpid(), signal);
    });
    const auto image = state.first_image();
    killer.join();
    if (image || !stop.requested()) return 10;
  }
  if (std::chrono::steady_clock::now() - begin > std::chrono::seconds(1)) return 11;
  return stops > 0 ? 0 : 12;
}

TEST(FirstImageDeathTest, ASignalEndsTheWaitInOrder) {
  for (const int signal : {SIGTERM, SIGINT}) {
    for (const bool as_service : {false, true}) {
      EXPECT_EXIT(std::_Exit(exit_code_of_a_wait(signal, as_service)), ::testing::ExitedWithCode(0), "")
          << signal << (as_service ? " of the service" : "");
    }
  }
}

}  // namespace
}  // namespace cgsr::boot
