// The first image of a robot that boots: the first whole one, and never an endless wait.
#include "src/boot/first_image.h"

#include <gtest/gtest.h>

#include <deque>

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

}  // namespace
}  // namespace cgsr::boot
