// The camera's driver on a scripted kernel: the contract of its interface, what it asks of a camera, and every fault.

#include <turbojpeg.h>

#include <memory>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hal/v4l2/find_camera.h"
#include "hal/v4l2/formats.h"
#include "hal/v4l2/jpeg_to_yuyv.h"
#include "hal/v4l2/v4l2_camera.h"
#include "tests/drivers/scripted_video.h"
#include "tests/hal/camera_contract.h"

namespace cgsr::hal {
namespace {

using test::ScriptedVideo;
using v4l2::JpegToYuyv;
using v4l2::StreamFormat;
using v4l2::V4l2Camera;
using v4l2::V4l2Parameters;

constexpr int kWidth_px = 64, kHeight_px = 48;

/// A picture of one colour (full-range YCbCr) as a camera would send it.
std::vector<std::uint8_t> jpeg_of(int luma, int u, int v, int subsampling = TJSAMP_422, int width_px = kWidth_px) {
  std::vector<std::uint8_t> planes[3];
  const unsigned char* starts[3] = {nullptr, nullptr, nullptr};
  const int values[3] = {luma, u, v};
  for (int i = 0; i < (subsampling == TJSAMP_GRAY ? 1 : 3); ++i) {
    const auto size = static_cast<std::size_t>(tjPlaneWidth(i, width_px, subsampling)) *
                      static_cast<std::size_t>(tjPlaneHeight(i, kHeight_px, subsampling));
    planes[i].assign(size, static_cast<std::uint8_t>(values[i]));
    starts[i] = planes[i].data();
  }
  tjhandle encoder = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  EXPECT_EQ(tjCompressFromYUVPlanes(encoder, starts, width_px, nullptr, kHeight_px, subsampling, &bytes, &size, 95, 0),
            0);
  std::vector<std::uint8_t> jpeg(bytes, bytes + size);
  tjFree(bytes);
  tjDestroy(encoder);
  return jpeg;
}

V4l2Parameters small() {
  V4l2Parameters parameters;
  parameters.width_px = kWidth_px;
  parameters.height_px = kHeight_px;
  parameters.rate_hz = 100.0;
  parameters.white_balance_k = 0;
  parameters.stall_s = 0.3;
  parameters.reopen_wait_s = 0.05;
  return parameters;
}

std::unique_ptr<V4l2Camera> camera_of(ScriptedVideo& kernel, const V4l2Parameters& parameters) {
  return std::make_unique<V4l2Camera>(parameters, std::make_unique<test::ScriptedVideoDevice>(kernel),
                                      [&kernel](const std::string& wanted) -> std::optional<std::string> {
                                        if (!kernel.plugged) return std::nullopt;
                                        return wanted;
                                      });
}

CameraRig scripted_camera(StreamFormat format) {
  auto kernel = std::make_shared<ScriptedVideo>();
  kernel->jpeg = jpeg_of(100, 90, 160);
  V4l2Parameters parameters = small();
  parameters.format = format;
  CameraRig rig;
  rig.camera = camera_of(*kernel, parameters);
  rig.clock = std::make_shared<RealClock>();
  rig.world = kernel;
  return rig;
}

/// The kernel's own virtual camera, or any other, where CGSR_TEST_CAMERA names one.
CameraRig real_camera() {
  const char* device = std::getenv("CGSR_TEST_CAMERA");
  if (device == nullptr) return {};
  V4l2Parameters parameters;
  parameters.device = device;
  CameraRig rig;
  rig.camera = std::make_unique<V4l2Camera>(parameters, v4l2::make_video_device(), v4l2::find_camera);
  rig.clock = std::make_shared<RealClock>();
  return rig;
}

std::vector<CameraCase> cameras() {
  std::vector<CameraCase> all = {{"yuyv", [] { return scripted_camera(StreamFormat::kYuyv); }},
                                 {"mjpeg", [] { return scripted_camera(StreamFormat::kMjpeg); }}};
  if (std::getenv("CGSR_TEST_CAMERA") != nullptr) all.push_back({"real", real_camera});
  return all;
}

INSTANTIATE_TEST_SUITE_P(V4l2, CameraContract, testing::ValuesIn(cameras()), CaseName());

struct V4l2 : testing::Test {
  void use(const V4l2Parameters& parameters) { camera = camera_of(kernel, parameters); }
  auto next(double within_s = 2.0) { return camera->next_image(kernel.clock.now() + seconds(within_s)); }
  /// Until an image comes, over timeouts and damaged ones.
  std::optional<ImageLease> image_within(double s) {
    const MonoTime end = kernel.clock.now() + seconds(s);
    while (kernel.clock.now() < end) {
      if (auto image = camera->next_image(kernel.clock.now() + seconds(0.05))) return std::move(*image);
    }
    return std::nullopt;
  }

  ScriptedVideo kernel;
  std::unique_ptr<V4l2Camera> camera;
};
using V4l2Fault = V4l2;

TEST_F(V4l2, LendsTheDriversOwnMemory) {
  use(small());
  ASSERT_TRUE(camera->start());
  const auto image = next();
  ASSERT_TRUE(image);
  bool is_the_drivers = false;
  for (const auto& memory : kernel.memory) is_the_drivers |= image->view().data == memory->data();
  EXPECT_TRUE(is_the_drivers);
}

TEST_F(V4l2, EnumeratesDiscreteAndStepwiseSizes) {
  test::ScriptedVideoDevice device(kernel);
  auto offered = v4l2::offered_formats(device);
  ASSERT_EQ(offered.size(), 2U);
  EXPECT_EQ(v4l2::fourcc_text(offered[0].fourcc), "YUYV");
  ASSERT_EQ(offered[0].sizes.size(), 1U);
  EXPECT_EQ(to_string(offered[0].sizes[0]), "64x48");
  ASSERT_EQ(offered[0].sizes[0].rates_hz.size(), 1U);
  EXPECT_NEAR(offered[0].sizes[0].rates_hz[0], 100.0, 1e-9);
  kernel.stepwise = true;
  offered = v4l2::offered_formats(device);
  EXPECT_EQ(to_string(offered[0].sizes[0]), "16x16 to 64x48 in steps of 2x2");
  EXPECT_TRUE(offered[0].sizes[0].holds(32, 24));
  EXPECT_FALSE(offered[0].sizes[0].holds(33, 24));
  EXPECT_FALSE(offered[0].sizes[0].holds(66, 24));
}

TEST_F(V4l2, SetsControlsInOrderAndSaysWhatTheCameraRefused) {
  kernel.controls[V4L2_CID_EXPOSURE_AUTO] = {0, 3, 3};
  kernel.controls[V4L2_CID_EXPOSURE_ABSOLUTE] = {1, 50, 7};
  kernel.controls[V4L2_CID_AUTO_WHITE_BALANCE] = {0, 1, 1};
  kernel.controls[V4L2_CID_WHITE_BALANCE_TEMPERATURE] = {2800, 6500, 5000, false};
  V4l2Parameters parameters = small();
  parameters.exposure_s = 0.010;  // 100 units: more than it has
  parameters.white_balance_k = 4600;
  parameters.gain = 5;
  use(parameters);
  ASSERT_TRUE(camera->start());
  EXPECT_EQ(kernel.controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(kernel.controls[V4L2_CID_AUTO_WHITE_BALANCE].value, 0);
  ASSERT_EQ(camera->notes().size(), 3U);
  EXPECT_NE(camera->notes()[0].find("exposure_s [100 us]: 100 was requested, 50 took effect"), std::string::npos)
      << camera->notes()[0];
  EXPECT_NE(camera->notes()[1].find("gain: the camera has no such control"), std::string::npos) << camera->notes()[1];
  EXPECT_NE(camera->notes()[2].find("4600 was requested, 5000 took effect"), std::string::npos) << camera->notes()[2];
}

TEST_F(V4l2, AStampOfTheEndOfAnImageIsCorrected) {
  kernel.stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
  V4l2Parameters parameters = small();
  parameters.end_of_frame_offset_s = 0.25;
  use(parameters);
  ASSERT_TRUE(camera->start());
  const MonoTime began = kernel.clock.now();
  const auto image = next();
  ASSERT_TRUE(image);
  EXPECT_LT(image->stamp(), began - seconds(0.1));
}

TEST_F(V4l2Fault, AGapInTheSequenceIsCountedAndShown) {
  use(small());
  ASSERT_TRUE(camera->start());
  const auto first = next();
  ASSERT_TRUE(first);
  kernel.skip_next = 3;
  std::uint64_t sequence = first->sequence();
  std::uint64_t lost = 0;
  for (int i = 0; i < 6; ++i) {
    const auto image = next();
    ASSERT_TRUE(image);
    lost += image->sequence() - sequence - 1;
    sequence = image->sequence();
  }
  EXPECT_EQ(lost, 3U);
  EXPECT_EQ(camera->counters().lost, 3U);
}

TEST_F(V4l2Fault, FlaggedAndShortImagesAreQueuedAgain) {
  use(small());
  ASSERT_TRUE(camera->start());
  ASSERT_TRUE(next());
  for (auto* trouble : {&kernel.flag_next, &kernel.short_next}) {
    *trouble = 10;  // more than there are buffers
    int corrupt = 0;
    for (int i = 0; i < 14; ++i) {
      const auto image = next();
      corrupt += !image && image.error() == CaptureFailure::kCorrupt ? 1 : 0;
    }
    EXPECT_EQ(corrupt, 10) << camera->last_problem();
    EXPECT_TRUE(next());
  }
  EXPECT_EQ(camera->counters().flagged, 20U);
}

TEST_F(V4l2Fault, AStalledStreamIsStartedAgain) {
  use(small());
  ASSERT_TRUE(camera->start());
  const auto before = next();
  ASSERT_TRUE(before);
  kernel.stalled = true;
  const auto none = next(0.2);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error(), CaptureFailure::kTimeout);
  (void)next(0.3);
  EXPECT_GE(camera->counters().restarts, 1U);
  EXPECT_NE(camera->last_problem().find("no image for 0.3 s"), std::string::npos) << camera->last_problem();
  kernel.stalled = false;
  const auto after = image_within(2.0);
  ASSERT_TRUE(after);
  EXPECT_GT(after->sequence(), before->sequence());
  EXPECT_GE(after->stamp(), before->stamp());
}

TEST_F(V4l2Fault, UnpluggedAndBackWithAllControlsAppliedAgain) {
  kernel.controls[V4L2_CID_AUTO_WHITE_BALANCE] = {0, 1, 1};
  kernel.controls[V4L2_CID_WHITE_BALANCE_TEMPERATURE] = {2800, 6500, 5000};
  V4l2Parameters parameters = small();
  parameters.white_balance_k = 4600;
  use(parameters);
  ASSERT_TRUE(camera->start());
  const auto kept = next();
  ASSERT_TRUE(kept);
  const auto pixels = copy_of(kept->view());
  kernel.plugged = false;
  const auto gone = next(0.2);
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error(), CaptureFailure::kTimeout);
  EXPECT_NE(camera->last_problem().find("gone for"), std::string::npos) << camera->last_problem();
  EXPECT_EQ(copy_of(kept->view()), pixels) << "a lease outlives the device";

  kernel.controls[V4L2_CID_AUTO_WHITE_BALANCE].value = 1;  // it forgot them
  kernel.controls[V4L2_CID_WHITE_BALANCE_TEMPERATURE].value = 5000;
  kernel.plugged = true;
  const auto image = image_within(1.0);
  ASSERT_TRUE(image);
  EXPECT_EQ(camera->counters().returns, 1U);
  EXPECT_EQ(kernel.controls[V4L2_CID_AUTO_WHITE_BALANCE].value, 0);
  EXPECT_EQ(kernel.controls[V4L2_CID_WHITE_BALANCE_TEMPERATURE].value, 4600);
  EXPECT_GT(image->sequence(), kept->sequence());
}

TEST_F(V4l2Fault, AnExposureThatTheCameraTakesOnlyOnceItStreamsIsSetAgain) {
  kernel.controls[V4L2_CID_EXPOSURE_AUTO] = {0, 3, 3, false};
  V4l2Parameters parameters = small();
  parameters.exposure_s = 0.010;
  use(parameters);
  ASSERT_TRUE(camera->start());
  kernel.controls[V4L2_CID_EXPOSURE_AUTO].sticks = true;
  for (int i = 0; i < 6; ++i) ASSERT_TRUE(next());
  EXPECT_EQ(kernel.controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_MANUAL);
}

TEST_F(V4l2Fault, AnErrorOfTheDriverStartsTheStreamAgain) {
  use(small());
  ASSERT_TRUE(camera->start());
  ASSERT_TRUE(next());
  kernel.dequeue_error = EIO;
  EXPECT_TRUE(image_within(1.0));
  EXPECT_EQ(camera->counters().restarts, 1U);
}

// A driver may say so at any time, and a reader may have every image but one: the stream goes on at once, and what is on lease stays as it is.
TEST_F(V4l2Fault, AChangeOfTheSourceStartsTheStreamAgainUnderReaders) {
  use(small());
  ASSERT_TRUE(camera->start());
  std::vector<ImageLease> kept;
  for (int i = 0; i + 1 < small().buffers; ++i) {
    auto image = next();
    ASSERT_TRUE(image);
    kept.push_back(std::move(*image));
  }
  const auto pixels = copy_of(kept.front().view());
  kernel.source_changed = true;
  const MonoTime changed = kernel.clock.now();
  ASSERT_TRUE(image_within(1.0)) << camera->last_problem();
  EXPECT_LT(to_seconds(kernel.clock.now() - changed), 0.2);
  EXPECT_EQ(camera->counters().restarts, 1U);
  EXPECT_EQ(kernel.opened, 1);
  EXPECT_EQ(copy_of(kept.front().view()), pixels);
  kept.clear();
  for (int i = 0; i < 2 * small().buffers; ++i) ASSERT_TRUE(next()) << "buffers were lost in the restart";
}

TEST_F(V4l2Fault, ASourceOfAnotherFormatIsNamedAndWaitedFor) {
  use(small());
  ASSERT_TRUE(camera->start());
  ASSERT_TRUE(next());
  kernel.width_px = 2 * kWidth_px;
  kernel.source_changed = true;
  (void)next(0.02);
  EXPECT_NE(camera->last_problem().find("another format"), std::string::npos) << camera->last_problem();
  kernel.width_px = kWidth_px;
  EXPECT_TRUE(image_within(1.0)) << camera->last_problem();
}

// The kernel keeps a device that is unplugged, and its number, as long as its memory is mapped.
TEST_F(V4l2Fault, MemoryOfACameraThatIsGoneIsUnmappedOnceItsReadersAreDone) {
  use(small());
  ASSERT_TRUE(camera->start());
  {
    const auto kept = next();
    ASSERT_TRUE(kept);
    kernel.plugged = false;
    (void)next(0.05);
    EXPECT_EQ(kernel.mapped, small().buffers);
  }
  (void)next(0.05);
  EXPECT_EQ(kernel.mapped, 0);
}

// v4l2loopback hands a buffer over again whether or not it was queued. Lent twice, the first return would end both leases, and the memory would be
// unmapped under the second reader.
TEST_F(V4l2Fault, ABufferThatAReaderHasIsNotLentAgain) {
  kernel.fills_in_turn = small().buffers;
  use(small());
  ASSERT_TRUE(camera->start());
  auto kept = next();
  ASSERT_TRUE(kept);
  int lost = 0;
  for (int i = 0; i < 3 * small().buffers; ++i) {
    const auto image = next();
    if (image) {
      EXPECT_NE(image->view().data, kept->view().data);
      EXPECT_GT(image->sequence(), kept->sequence());
    } else {
      EXPECT_EQ(image.error(), CaptureFailure::kNoSlot);
      EXPECT_NE(camera->last_problem().find("where a reader still has an older one"), std::string::npos);
      ++lost;
    }
  }
  EXPECT_EQ(lost, 3);
  camera->stop();
  EXPECT_EQ(kernel.mapped, small().buffers) << "unmapped under its reader";
  kept = tl::unexpected(CaptureFailure::kTimeout);
  ASSERT_TRUE(camera->start()) << "memory that is read no more stays mapped";
  for (int i = 0; i < 3 * small().buffers; ++i) ASSERT_TRUE(next()) << camera->last_problem();
}

TEST_F(V4l2Fault, ABufferThatCameBackWhileTheNextImageWasAwaitedIsLentAgain) {
  kernel.fills_in_turn = 1;
  use(small());
  ASSERT_TRUE(camera->start());
  for (int i = 0; i < 5; ++i) {
    auto image = next();
    ASSERT_TRUE(image) << camera->last_problem();
    std::thread reader([kept = std::move(*image)]() mutable {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      const ImageLease ends = std::move(kept);
    });
    EXPECT_TRUE(next()) << camera->last_problem();
    reader.join();
  }
}

TEST_F(V4l2Fault, SaysWhoHasTheCameraThatIsBusy) {
  use(small());
  kernel.used_by_another = true;
  const auto started = camera->start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().message.find("another program uses the camera"), std::string::npos)
      << started.error().message;
}

TEST_F(V4l2Fault, MemoryOfOldStreamsIsGivenBack) {
  use(small());
  ASSERT_TRUE(camera->start());
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(next());
    kernel.dequeue_error = EIO;
    ASSERT_TRUE(image_within(1.0));
  }
  EXPECT_LE(kernel.mapped, 2 * small().buffers);
  camera.reset();
  EXPECT_EQ(kernel.mapped, 0);
}

TEST_F(V4l2Fault, WhatTheCameraIsNotIsSaidAtStart) {
  V4l2Parameters parameters = small();
  parameters.width_px = 640;
  use(parameters);
  auto started = camera->start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().message.find("640x48 was requested, the camera gives YUYV 64x48; it offers YUYV: 64x48"),
            std::string::npos)
      << started.error().message;
  kernel.plugged = false;
  started = camera->start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().message.find("is not there"), std::string::npos) << started.error().message;
  kernel.plugged = true;
  kernel.capabilities = V4L2_CAP_META_CAPTURE;
  started = camera->start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().message.find("does not deliver images"), std::string::npos) << started.error().message;
}

TEST(V4l2Kernel, SaysThatThereIsNoSuchDevice) {
  V4l2Parameters parameters;
  parameters.device = "/dev/video-none";
  V4l2Camera camera(parameters, v4l2::make_video_device(), v4l2::find_camera);
  const auto started = camera.start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().message.find("/dev/video-none"), std::string::npos);
  EXPECT_FALSE(v4l2::find_camera(""));
  EXPECT_FALSE(v4l2::find_camera("no-such-id"));
}

TEST(V4l2Kernel, AFileThatIsNoVideoDeviceIsNamed) {
  V4l2Parameters parameters;
  parameters.device = "/dev/null";
  V4l2Camera camera(parameters, v4l2::make_video_device(), v4l2::find_camera);
  const auto started = camera.start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().message.find("no video device"), std::string::npos) << started.error().message;
}

// Limited range from full range, for every chroma format: 16 + 219 Y / 255, 128 + 224 (C - 128) / 255.
TEST(JpegToYuyvOf, EveryChromaFormat) {
  for (const int subsampling : {TJSAMP_444, TJSAMP_422, TJSAMP_420, TJSAMP_440, TJSAMP_411, TJSAMP_GRAY}) {
    JpegToYuyv decoder;
    std::vector<std::uint8_t> yuyv(2U * kWidth_px * kHeight_px);
    const auto problem = decoder.decode(jpeg_of(255, 90, 200, subsampling), kWidth_px, kHeight_px, yuyv.data());
    ASSERT_EQ(problem, "") << subsampling;
    for (std::size_t i = 0; i < yuyv.size(); i += 4) {
      ASSERT_NEAR(yuyv[i], 235, 1);
      ASSERT_NEAR(yuyv[i + 2], 235, 1);
      ASSERT_NEAR(yuyv[i + 1], subsampling == TJSAMP_GRAY ? 128 : 95, 2) << subsampling;
      ASSERT_NEAR(yuyv[i + 3], subsampling == TJSAMP_GRAY ? 128 : 191, 2) << subsampling;
    }
  }
}

TEST(JpegToYuyvOf, AnotherSizeACutImageAndNoImageAreRefused) {
  JpegToYuyv decoder;
  std::vector<std::uint8_t> yuyv(2U * kWidth_px * kHeight_px);
  EXPECT_NE(decoder.decode(jpeg_of(9, 9, 9, TJSAMP_422, 32), kWidth_px, kHeight_px, yuyv.data()).find("32x48"),
            std::string::npos);
  auto cut = jpeg_of(9, 9, 9);
  cut.resize(cut.size() / 2);
  EXPECT_NE(decoder.decode(cut, kWidth_px, kHeight_px, yuyv.data()), "");
  EXPECT_NE(decoder.decode({}, kWidth_px, kHeight_px, yuyv.data()), "");
}

// Damaged images by the thousand: refused or decoded, and not a byte beside the image is written.
TEST(JpegToYuyvFuzz, NeverWritesBesideTheImage) {
  JpegToYuyv decoder;
  std::mt19937_64 random(20261124);
  const int formats[] = {TJSAMP_444, TJSAMP_422, TJSAMP_420, TJSAMP_GRAY};
  constexpr std::size_t kGuard = 64;
  const std::size_t size = 2U * kWidth_px * kHeight_px;
  std::vector<std::uint8_t> memory(size + 2 * kGuard, 0xA5);
  int refused = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto jpeg = jpeg_of(static_cast<int>(random() % 256), 100, 150, formats[random() % 4]);
    const auto hits = random() % 8;
    for (std::uint64_t i = 0; i < hits; ++i) jpeg[random() % jpeg.size()] = static_cast<std::uint8_t>(random());
    if (random() % 4 == 0) jpeg.resize(random() % jpeg.size());
    if (!decoder.decode(jpeg, kWidth_px, kHeight_px, memory.data() + kGuard).empty()) ++refused;
  }
  for (std::size_t i = 0; i < kGuard; ++i) {
    ASSERT_EQ(memory[i], 0xA5);
    ASSERT_EQ(memory[size + kGuard + i], 0xA5);
  }
  EXPECT_GT(refused, kTrials / 10);
  EXPECT_LT(refused, kTrials);
}

}  // namespace
}  // namespace cgsr::hal
