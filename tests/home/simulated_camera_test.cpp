// The simulated camera: held to the contract of every camera, and every trouble that a script can make.
#include "hal/sim/home/simulated_camera.h"

#include <gtest/gtest.h>

#include "tests/hal/camera_contract.h"
#include "tests/home/rig.h"

namespace cgsr::sim {
namespace {

using hal::CaptureFailure;
using test::at;

constexpr Duration kDelay = seconds(0.01);

/// A camera of 16x2 pixels at 10 Hz whose images hold their number.
std::unique_ptr<SimulatedCamera> camera_with(std::vector<CameraEventSpec> script, MonoTime end = MonoTime::max(),
                                             const MonoTime* now = nullptr) {
  const hal::CameraMode mode{16, 2, PixelFormat::kYuyv, seconds(0.1)};
  return std::make_unique<SimulatedCamera>(
      mode, kDelay, end, std::move(script),
      [](std::uint64_t number, MonoTime, const YuyvBuffer& buffer) {
        std::fill_n(buffer.data, 64, static_cast<std::uint8_t>(number));
      },
      [now] { return now != nullptr ? *now : MonoTime{}; });
}

CameraEventSpec event(CameraTrouble what, double from_s, double to_s, double late_s = 0.0) {
  return {what, from_s, to_s, late_s};
}

TEST(SimulatedCamera, HandsOutAnImageOneDelayAfterItsStampAndNotBefore) {
  const auto camera = camera_with({});
  ASSERT_TRUE(camera->start());
  EXPECT_EQ(camera->next_image(at(0.009)).error(), CaptureFailure::kTimeout);
  const auto image = camera->next_image(at(0.01));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->stamp(), at(0.0));
  EXPECT_EQ(camera->next_image(at(0.1)).error(), CaptureFailure::kTimeout);
}

TEST(SimulatedCamera, EndsWithItsScenario) {
  const auto camera = camera_with({}, at(0.2));
  ASSERT_TRUE(camera->start());
  EXPECT_TRUE(camera->next_image(at(1.0)));
  EXPECT_TRUE(camera->next_image(at(1.0)));
  EXPECT_EQ(camera->next_image(at(1.0)).error(), CaptureFailure::kEndOfStream);
}

TEST(SimulatedCameraFault, ADroppedImageIsAGapInTheSequence) {
  const auto camera = camera_with({event(CameraTrouble::kDropped, 0.1, 0.3)});
  ASSERT_TRUE(camera->start());
  EXPECT_EQ(camera->next_image(at(1.0))->sequence(), 0u);
  EXPECT_EQ(camera->next_image(at(1.0))->sequence(), 3u);
}

TEST(SimulatedCameraFault, AFrozenImageHasTheLastOnesPixelsAndItsOwnNumber) {
  const auto camera = camera_with({event(CameraTrouble::kFrozen, 0.2, 0.4)});
  ASSERT_TRUE(camera->start());
  for (const int pixel : {0, 1, 1, 1, 4}) {
    const auto image = camera->next_image(at(1.0));
    ASSERT_TRUE(image);
    EXPECT_EQ(image->view().data[5], pixel) << image->sequence();
  }
}

TEST(SimulatedCameraFault, ACorruptImageIsSaidAndCounted) {
  const auto camera = camera_with({event(CameraTrouble::kCorrupt, 0.0, 0.1)});
  ASSERT_TRUE(camera->start());
  EXPECT_EQ(camera->next_image(at(1.0)).error(), CaptureFailure::kCorrupt);
  EXPECT_NE(camera->last_problem(), "");
  EXPECT_EQ(camera->next_image(at(1.0))->sequence(), 1u);
}

TEST(SimulatedCameraFault, ALateImageCostsThoseThatFallDueMeanwhile) {
  const auto camera = camera_with({event(CameraTrouble::kLate, 0.1, 0.15, 0.25)});
  ASSERT_TRUE(camera->start());
  EXPECT_EQ(camera->next_image(at(0.01))->sequence(), 0u);
  EXPECT_EQ(camera->next_image(at(0.35)).error(), CaptureFailure::kTimeout);
  EXPECT_EQ(camera->next_image(at(0.36))->sequence(), 1u);
  EXPECT_EQ(camera->next_image(at(0.42))->sequence(), 4u);
}

TEST(SimulatedCameraFault, AGoneCameraComesBackAfterAnotherStart) {
  MonoTime now{};
  const auto camera = camera_with({event(CameraTrouble::kGone, 0.1, 0.5)}, MonoTime::max(), &now);
  ASSERT_TRUE(camera->start());
  EXPECT_TRUE(camera->next_image(at(0.02)));
  now = at(0.2);
  EXPECT_EQ(camera->next_image(at(0.2)).error(), CaptureFailure::kDisconnected);
  camera->stop();
  EXPECT_FALSE(camera->start()) << "it is still gone";
  EXPECT_EQ(camera->next_image(at(0.6)).error(), CaptureFailure::kDisconnected) << "not started";
  now = at(0.6);
  ASSERT_TRUE(camera->start());
  const auto image = camera->next_image(at(0.7));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->sequence(), 0u);
  EXPECT_GE(image->stamp(), at(0.5));
}

TEST(SimulatedCameraFault, WithEverySlotOnLeaseAnImageIsLostAndSaidSo) {
  const auto camera = camera_with({});
  ASSERT_TRUE(camera->start());
  std::vector<ImageLease> held;
  for (int i = 0; i < 8; ++i) held.push_back(std::move(*camera->next_image(at(9.0))));
  EXPECT_EQ(camera->next_image(at(9.0)).error(), CaptureFailure::kNoSlot);
  held.pop_back();
  EXPECT_EQ(camera->next_image(at(9.0))->sequence(), 9u);
}

}  // namespace
}  // namespace cgsr::sim

namespace cgsr::hal {
namespace {

CameraRig rendered() {
  auto file = std::make_shared<sim::test::ScenarioFile>("");
  CameraRig rig;
  std::shared_ptr<sim::SimulatedHome> home = sim::test::make_home(*file);
  rig.camera = home->take_camera();
  rig.world = home;
  return rig;
}

INSTANTIATE_TEST_SUITE_P(Simulated, CameraContract, testing::Values(CameraCase{"rendered", rendered}), CaseName());

}  // namespace
}  // namespace cgsr::hal
