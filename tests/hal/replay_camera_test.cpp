#include "hal/replay/replay_camera.h"

#include <array>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "hal/replay/bgr_to_yuyv.h"
#include "tests/hal/recordings.h"
#include "tests/support/real_data.h"

namespace cgsr::hal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const cv::Size kSmall{64, 48};

ReplayParameters replay(const std::string& path) {
  ReplayParameters parameters;
  parameters.path = path;
  return parameters;
}

// The numbers that the images carry, to the end of the stream.
std::vector<int> numbers(ReplayCamera& camera, int most = 1000) {
  std::vector<int> seen;
  while (static_cast<int>(seen.size()) < most) {
    const auto image = camera.next_image(MonoTime::max());
    if (!image) {
      EXPECT_EQ(image.error(), CaptureFailure::kEndOfStream) << camera.last_problem();
      break;
    }
    seen.push_back(number_of(image->view()));
  }
  return seen;
}

std::vector<int> counting(int from, int to) {
  std::vector<int> numbers;
  for (int i = from; i < to; ++i) numbers.push_back(i);
  return numbers;
}

TEST(ReplayCamera, AFolderIsReadInTheOrderOfItsNames) {
  TempFolder folder;
  const std::vector<std::string> names = {"b.png", "a.jpg", "c.bmp", "d.ppm", "Z.PNG"};
  for (int i = 0; i < 5; ++i) {
    std::string lower = names[static_cast<std::size_t>(i)] == "Z.PNG" ? "Z.png" : names[static_cast<std::size_t>(i)];
    ASSERT_TRUE(cv::imwrite(folder.file(lower), numbered_image(i, kSmall)));
  }
  std::filesystem::rename(folder.file("Z.png"), folder.file("Z.PNG"));
  write_bytes(folder.file("groundtruth.txt"), "1,2,3,4\n");
  write_bytes(folder.file("._a.jpg"), "what macOS leaves behind");
  std::filesystem::create_directory(folder.file("e.png"));
  ReplayCamera camera(replay(folder.path()));
  ASSERT_TRUE(camera.start());
  EXPECT_THAT(numbers(camera), ElementsAre(4, 1, 0, 2, 3));
}

TEST(ReplayCamera, SaysWhenNamesAreNotInTheOrderOfTheirNumbers) {
  TempFolder folder;
  for (const int i : {1, 2, 10}) {
    ASSERT_TRUE(cv::imwrite(folder.file(fmt::format("{}.png", i)), numbered_image(i, kSmall)));
  }
  ReplayCamera camera(replay(folder.path()));
  ASSERT_TRUE(camera.start());
  EXPECT_THAT(numbers(camera), ElementsAre(1, 10, 2));
  EXPECT_THAT(camera.notes(), ElementsAre(HasSubstr("order of their names")));
}

TEST(ReplayCamera, OneImageFileIsAStreamOfOne) {
  TempFolder folder;
  ASSERT_TRUE(cv::imwrite(folder.file("one.png"), numbered_image(7, kSmall)));
  ReplayCamera camera(replay(folder.file("one.png")));
  ASSERT_TRUE(camera.start());
  EXPECT_THAT(numbers(camera), ElementsAre(7));
}

TEST(ReplayCamera, AVideoComesWhole) {
  TempFolder folder;
  write_video(folder.file("v.avi"), 40, kSmall, 12.5);
  ReplayCamera camera(replay(folder.file("v.avi")));
  const auto mode = camera.start();
  ASSERT_TRUE(mode) << mode.error().message;
  EXPECT_EQ(mode->width_px, 64);
  EXPECT_EQ(mode->height_px, 48);
  EXPECT_EQ(mode->frame_period, std::chrono::milliseconds(80));
  EXPECT_EQ(numbers(camera), counting(0, 40));
  EXPECT_EQ(camera.last_problem(), "");
  EXPECT_EQ(numbers(camera), counting(0, 0)) << "the end stays the end";
}

// A lossless image arrives as the conversion of its pixels, nothing else.
TEST(ReplayCamera, PixelsAreTheConvertedOnes) {
  TempFolder folder;
  const cv::Mat image = numbered_image(3, kSmall);
  ASSERT_TRUE(cv::imwrite(folder.file("0.png"), image));
  ReplayCamera camera(replay(folder.path()));
  ASSERT_TRUE(camera.start());
  const auto lease = camera.next_image(MonoTime::max());
  ASSERT_TRUE(lease);
  std::vector<std::uint8_t> want(64 * 2);
  for (int y = 0; y < 48; ++y) {
    bgr_to_yuyv(image.ptr(y), 0, 64, 1, want.data(), 0);
    ASSERT_TRUE(std::equal(want.begin(), want.end(), lease->view().row(y))) << y;
  }
}

TEST(ReplayCamera, AsFastAsPossibleStampsAdvanceByThePeriod) {
  TempFolder folder;
  write_folder(folder.file("f"), 5, kSmall);
  auto parameters = replay(folder.file("f"));
  parameters.rate_hz = 10.0;
  ReplayCamera camera(parameters);
  ASSERT_TRUE(camera.start());
  for (int i = 0; i < 5; ++i) {
    const auto image = camera.next_image(MonoTime::max());
    ASSERT_TRUE(image);
    EXPECT_EQ(image->sequence(), static_cast<std::uint64_t>(i));
    EXPECT_EQ(image->stamp(), MonoTime{std::chrono::milliseconds(100 * i)});
  }
}

TEST(ReplayCamera, ADeadlineBeforeTheStampIsATimeoutAndLosesNothing) {
  TempFolder folder;
  write_folder(folder.file("f"), 3, kSmall);
  auto parameters = replay(folder.file("f"));
  parameters.rate_hz = 10.0;
  ReplayCamera camera(parameters);
  ASSERT_TRUE(camera.start());
  ASSERT_TRUE(camera.next_image(MonoTime{}));
  EXPECT_EQ(camera.next_image(MonoTime{std::chrono::milliseconds(99)}).error(), CaptureFailure::kTimeout);
  const auto image = camera.next_image(MonoTime{std::chrono::milliseconds(100)});
  ASSERT_TRUE(image);
  EXPECT_EQ(image->sequence(), 1U);
}

TEST(ReplayCamera, AFolderHas30HzUnlessToldOtherwise) {
  TempFolder folder;
  write_folder(folder.file("f"), 1, kSmall);
  ReplayCamera camera(replay(folder.file("f")));
  EXPECT_EQ(camera.start()->frame_period, Duration(33'333'333));
}

TEST(ReplayCamera, FirstAndCountChooseAPart) {
  TempFolder folder;
  write_folder(folder.file("f"), 20, kSmall);
  write_video(folder.file("v.avi"), 20, kSmall);
  for (const std::string name : {"f", "v.avi"}) {
    auto parameters = replay(folder.file(name));
    parameters.first = 5;
    parameters.count = 4;
    ReplayCamera camera(parameters);
    ASSERT_TRUE(camera.start());
    EXPECT_EQ(numbers(camera), counting(5, 9)) << name;
  }
}

TEST(ReplayCamera, LoopBeginsAgainAtFirst) {
  TempFolder folder;
  write_folder(folder.file("f"), 6, kSmall);
  write_video(folder.file("v.avi"), 6, kSmall);
  for (const std::string name : {"f", "v.avi"}) {
    auto parameters = replay(folder.file(name));
    parameters.first = 4;
    parameters.loop = true;
    ReplayCamera camera(parameters);
    ASSERT_TRUE(camera.start());
    EXPECT_THAT(numbers(camera, 5), ElementsAre(4, 5, 4, 5, 4)) << name;
    EXPECT_EQ(camera.next_image(MonoTime::max())->sequence(), 5U) << name;
  }
}

TEST(ReplayCamera, ScalesToTheSizeAskedFor) {
  TempFolder folder;
  write_folder(folder.file("f"), 3, {161, 121});
  for (const cv::Size size : {cv::Size{640, 480}, cv::Size{64, 48}, cv::Size{320, 24}}) {
    auto parameters = replay(folder.file("f"));
    parameters.width_px = size.width;
    parameters.height_px = size.height;
    ReplayCamera camera(parameters);
    const auto mode = camera.start();
    ASSERT_TRUE(mode) << mode.error().message;
    EXPECT_EQ(mode->width_px, size.width);
    EXPECT_EQ(mode->height_px, size.height);
    EXPECT_THAT(numbers(camera), ElementsAre(0, 1, 2));
    EXPECT_TRUE(camera.notes().empty()) << "nothing is dropped when scaling";
  }
}

TEST(ReplayCamera, AnOddLastColumnIsDroppedAndSaidSo) {
  TempFolder folder;
  write_folder(folder.file("f"), 1, {65, 47});
  ReplayCamera camera(replay(folder.file("f")));
  const auto mode = camera.start();
  ASSERT_TRUE(mode);
  EXPECT_EQ(mode->width_px, 64);
  EXPECT_EQ(mode->height_px, 47);
  EXPECT_THAT(camera.notes(), ElementsAre(HasSubstr("last column")));
  EXPECT_THAT(numbers(camera), ElementsAre(0));
}

// 16 bits, grey, transparent: what a folder may hold besides 8-bit colour.
TEST(ReplayCamera, OtherKindsOfPixelsAreConverted) {
  TempFolder folder;
  cv::Mat deep(kSmall, CV_16UC3, cv::Scalar(0x8000, 0x4000, 0xC000));
  ASSERT_TRUE(cv::imwrite(folder.file("0_deep.png"), deep));
  ASSERT_TRUE(cv::imwrite(folder.file("1_grey.png"), cv::Mat(kSmall, CV_8UC1, cv::Scalar(128))));
  ASSERT_TRUE(cv::imwrite(folder.file("2_grey.jpg"), cv::Mat(kSmall, CV_8UC1, cv::Scalar(128))));
  ASSERT_TRUE(cv::imwrite(folder.file("3_deep_grey.png"), cv::Mat(kSmall, CV_16UC1, cv::Scalar(0x8000))));
  ASSERT_TRUE(cv::imwrite(folder.file("4_clear.png"), cv::Mat(kSmall, CV_8UC4, cv::Scalar(0x80, 0x40, 0xC0, 0))));
  ReplayCamera camera(replay(folder.path()));
  ASSERT_TRUE(camera.start());
  const std::uint8_t bgr[] = {0x80, 0x40, 0xC0, 0x80, 0x40, 0xC0};
  std::uint8_t colour[4];
  bgr_to_yuyv(bgr, 6, 2, 1, colour, 4);
  for (int i = 0; i < 5; ++i) {
    const auto image = camera.next_image(MonoTime::max());
    ASSERT_TRUE(image) << camera.last_problem();
    const std::uint8_t* pixel = image->view().row(20) + 40;
    const bool grey = i == 1 || i == 2 || i == 3;
    EXPECT_NEAR(pixel[0], grey ? 126 : colour[0], 1) << i;
    EXPECT_NEAR(pixel[1], grey ? 128 : colour[1], grey ? 0 : 1) << i;
    EXPECT_NEAR(pixel[3], grey ? 128 : colour[3], grey ? 0 : 1) << i;
  }
}

// A phone lays its pictures on the side and writes so into EXIF; whoever gives a region in pixels saw them upright.
TEST(ReplayCamera, AJpegIsTurnedAsExifSays) {
  TempFolder folder;
  std::vector<std::uint8_t> jpeg;
  ASSERT_TRUE(cv::imencode(".jpg", numbered_image(5, kSmall), jpeg));
  const std::uint8_t turn_right[] = {0xFF, 0xE1, 0,    34,   'E', 'x', 'i', 'f', 0, 0, 'M', 'M', 0, 42, 0, 0, 0, 8,
                                     0,    1,    0x01, 0x12, 0,   3,   0,   0,   0, 1, 0,   6,   0, 0,  0, 0, 0, 0};
  jpeg.insert(jpeg.begin() + 2, std::begin(turn_right), std::end(turn_right));
  write_bytes(folder.file("phone.jpg"), std::string(jpeg.begin(), jpeg.end()));
  ReplayCamera camera(replay(folder.path()));
  const auto mode = camera.start();
  ASSERT_TRUE(mode) << mode.error().message;
  EXPECT_EQ(mode->width_px, 48);
  EXPECT_EQ(mode->height_px, 64);
}

TEST(ReplayCamera, AGreyVideoHasNeutralChroma) {
  TempFolder folder;
  write_video(folder.file("g.avi"), 5, kSmall, 25.0, false);
  ReplayCamera camera(replay(folder.file("g.avi")));
  ASSERT_TRUE(camera.start());
  for (int i = 0; i < 5; ++i) {
    const auto image = camera.next_image(MonoTime::max());
    ASSERT_TRUE(image) << camera.last_problem();
    EXPECT_EQ(number_of(image->view()), i);
    for (int y = 0; y < 48; ++y) {
      for (int x = 1; x < 128; x += 2) ASSERT_NEAR(image->view().row(y)[x], 128, 1) << x << ',' << y;
    }
  }
}

// A video without compression, in the YUV that cameras speak: what is stored is what arrives, within the rounding to B G R and
// back, and without a bias.
TEST(ReplayCamera, StoredYuvArrivesUnbiased) {
  TempFolder folder;
  std::string stream = "YUV4MPEG2 W64 H16 F25:1 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\n";
  const auto colour = [](int i) {  // all of them inside the B G R cube
    return std::array<int, 3>{40 + i * 160 / 50, 128 + (i * 7) % 25 - 12, 128 + (i * 11) % 25 - 12};
  };
  for (int i = 0; i < 50; ++i) {
    const auto [y, u, v] = colour(i);
    stream += "FRAME\n" + std::string(64 * 16, static_cast<char>(y)) + std::string(32 * 8, static_cast<char>(u)) +
              std::string(32 * 8, static_cast<char>(v));
  }
  write_bytes(folder.file("v.y4m"), stream);
  ReplayCamera camera(replay(folder.file("v.y4m")));
  const auto mode = camera.start();
  ASSERT_TRUE(mode) << mode.error().message;
  std::array<double, 3> bias{};
  for (int i = 0; i < 50; ++i) {
    const auto image = camera.next_image(MonoTime::max());
    ASSERT_TRUE(image) << camera.last_problem();
    const std::uint8_t* pair = image->view().row(7) + 24;
    const auto want = colour(i);
    const std::array<int, 3> got{pair[0], pair[1], pair[3]};
    for (std::size_t channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(got[channel], want[channel], 1) << i;
      bias[channel] += (got[channel] - want[channel]) / 50.0;
    }
  }
  for (const double mean : bias) EXPECT_NEAR(mean, 0.0, 0.25);
}

// ---- at its own rate ---------------------------------------------------------------------------------------------------

// A clock whose sleeper moves it: a replay at its own rate without the waiting.
class SleepMovesClock final : public Clock {
 public:
  [[nodiscard]] MonoTime now() const override { return now_; }
  void sleep_until(MonoTime wake_up_at) override { now_ = std::max(now_, wake_up_at); }
  void pass(Duration time) { now_ += time; }

 private:
  MonoTime now_{std::chrono::seconds(100)};
};

struct PacedReplay {
  explicit PacedReplay(int images, int slots = 3) {
    write_folder(folder.file("f"), images, kSmall);
    auto parameters = replay(folder.file("f"));
    parameters.pace = ReplayPace::kOwnRate;
    parameters.rate_hz = 10.0;
    parameters.slots = slots;
    camera = std::make_unique<ReplayCamera>(parameters, &clock);
  }
  auto next() { return camera->next_image(clock.now() + std::chrono::seconds(1)); }

  TempFolder folder;
  SleepMovesClock clock;
  std::unique_ptr<ReplayCamera> camera;
};

TEST(ReplayCamera, AtItsOwnRateAnImageComesWhenItIsDue) {
  PacedReplay replay(4);
  ASSERT_TRUE(replay.camera->start());
  const MonoTime began = replay.clock.now();
  for (int i = 0; i < 4; ++i) {
    const auto image = replay.next();
    ASSERT_TRUE(image);
    EXPECT_EQ(image->stamp(), began + std::chrono::milliseconds(100 * i));
    EXPECT_EQ(replay.clock.now(), image->stamp());
  }
  EXPECT_EQ(replay.next().error(), CaptureFailure::kEndOfStream);
}

TEST(ReplayCamera, AtItsOwnRateTheDeadlineCountsOnTheClock) {
  PacedReplay replay(4);
  ASSERT_TRUE(replay.camera->start());
  ASSERT_TRUE(replay.next());
  const MonoTime give_up_at = replay.clock.now() + std::chrono::milliseconds(60);
  EXPECT_EQ(replay.camera->next_image(give_up_at).error(), CaptureFailure::kTimeout);
  EXPECT_EQ(replay.clock.now(), give_up_at);
  EXPECT_EQ(replay.next()->sequence(), 1U);
}

TEST(ReplayCamera, AtItsOwnRateAnImageWithoutASlotIsLostAndCounted) {
  PacedReplay replay(8, 2);
  ASSERT_TRUE(replay.camera->start());
  auto first = replay.next();
  auto second = replay.next();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(replay.next().error(), CaptureFailure::kNoSlot);
  EXPECT_THAT(replay.camera->last_problem(), HasSubstr("all 2 slots are on lease"));
  EXPECT_EQ(replay.next().error(), CaptureFailure::kNoSlot);
  *first = {};
  const auto fifth = replay.next();
  ASSERT_TRUE(fifth);
  EXPECT_EQ(fifth->sequence(), 4U);
  EXPECT_EQ(number_of(fifth->view()), 4) << "the gap in the sequence is the gap in the recording";
}

// Slots hold what came while nobody asked; the older ones are gone, as in a driver's queue.
TEST(ReplayCamera, AtItsOwnRateWhoSleepsLosesTheOldest) {
  PacedReplay replay(20, 3);
  ASSERT_TRUE(replay.camera->start());
  ASSERT_TRUE(replay.next());
  replay.clock.pass(std::chrono::milliseconds(1000));  // image 10 is due now
  std::vector<std::uint64_t> sequences;
  std::vector<int> seen;
  for (int i = 0; i < 5; ++i) {
    const auto image = replay.next();
    ASSERT_TRUE(image);
    sequences.push_back(image->sequence());
    seen.push_back(number_of(image->view()));
  }
  EXPECT_THAT(sequences, ElementsAre(7, 8, 9, 10, 11));
  EXPECT_THAT(seen, ElementsAre(7, 8, 9, 10, 11));
  EXPECT_THAT(replay.camera->last_problem(), HasSubstr("images 1 to 6 are lost"));
}

TEST(ReplayCamera, StopDoesNotWaitForTheNextImage) {
  TempFolder folder;
  write_folder(folder.file("f"), 2, kSmall);
  auto parameters = replay(folder.file("f"));
  parameters.pace = ReplayPace::kOwnRate;
  parameters.rate_hz = 0.1;
  RealClock clock;
  ReplayCamera camera(parameters, &clock);
  ASSERT_TRUE(camera.start());
  ASSERT_TRUE(camera.next_image(MonoTime::max()));
  std::thread service([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    camera.stop();
  });
  const MonoTime began = clock.now();
  EXPECT_EQ(camera.next_image(MonoTime::max()).error(), CaptureFailure::kDisconnected);
  EXPECT_LT(clock.now() - began, std::chrono::seconds(2));
  service.join();
}

TEST(ReplayCamera, WhenSimulatedTimeEndsSoDoesTheStream) {
  TempFolder folder;
  write_folder(folder.file("f"), 5, kSmall);
  auto parameters = replay(folder.file("f"));
  parameters.pace = ReplayPace::kOwnRate;
  SimulatedClock clock;
  ReplayCamera camera(parameters, &clock);
  ASSERT_TRUE(camera.start());
  ASSERT_TRUE(camera.next_image(MonoTime::max()));
  std::thread end([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    clock.end();
  });
  EXPECT_EQ(camera.next_image(MonoTime::max()).error(), CaptureFailure::kEndOfStream);
  end.join();
}

TEST(ReplayCamera, ItsOwnRateNeedsAClock) {
  TempFolder folder;
  write_folder(folder.file("f"), 1, kSmall);
  auto parameters = replay(folder.file("f"));
  parameters.pace = ReplayPace::kOwnRate;
  EXPECT_FALSE(ReplayCamera(parameters).start());
}

// As fast as possible with a slow consumer: it waits for a slot, so that every image arrives.
TEST(ReplayCameraStress, TwoReadersAsFastAsPossibleLoseNothing) {
  TempFolder folder;
  write_folder(folder.file("f"), 10, kSmall);
  auto parameters = replay(folder.file("f"));
  parameters.loop = true;
  parameters.slots = 4;
  ReplayCamera camera(parameters);
  ASSERT_TRUE(camera.start());

  constexpr int kImages = 400;
  std::mutex mutex;
  std::vector<ImageLease> waiting;
  std::atomic<int> wrong{0};
  std::atomic<int> read{0};
  const auto reader = [&](unsigned seed) {
    std::mt19937 random(seed);
    while (read < kImages) {
      ImageLease lease;
      {
        const std::lock_guard lock(mutex);
        if (!waiting.empty()) {  // any of them: leases end in any order
          std::swap(waiting[random() % waiting.size()], waiting.back());
          lease = std::move(waiting.back());
          waiting.pop_back();
        }
      }
      if (!lease) {
        std::this_thread::yield();
        continue;
      }
      if (number_of(lease.view()) != static_cast<int>(lease.sequence() % 10)) ++wrong;
      ++read;
    }
  };
  std::thread first(reader, 1);
  std::thread second(reader, 2);
  for (int i = 0; i < kImages; ++i) {
    auto image = camera.next_image(MonoTime::max());
    if (!image) ADD_FAILURE() << camera.last_problem();
    const std::lock_guard lock(mutex);
    if (image) waiting.push_back(std::move(*image));
  }
  first.join();
  second.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(read, kImages);
}

// Real videos and folders, where they are at hand.
TEST(ReplayCamera, ReadsTheRealRecordings) {
  CGSR_NEEDS_REAL_DATA("tracking/coke/img");
  CGSR_NEEDS_REAL_DATA("people/vtest/vtest.avi");
  const std::string coke_folder = test::real_data("tracking/coke/img");
  ReplayCamera coke(replay(coke_folder));
  const auto mode = coke.start();
  ASSERT_TRUE(mode) << mode.error().message;
  EXPECT_EQ(mode->width_px, 640);
  EXPECT_EQ(mode->height_px, 480);
  int images = 0;
  while (coke.next_image(MonoTime::max())) ++images;
  const std::filesystem::directory_iterator files(coke_folder);
  EXPECT_EQ(images, std::distance(begin(files), end(files)));
  EXPECT_EQ(coke.last_problem(), "");

  auto some = replay(test::real_data("people/vtest/vtest.avi"));
  some.count = 100;
  ReplayCamera walkers(some);
  const auto video = walkers.start();
  ASSERT_TRUE(video) << video.error().message;
  EXPECT_EQ(video->width_px, 768);
  EXPECT_EQ(video->frame_period, std::chrono::milliseconds(100));
  images = 0;
  while (walkers.next_image(MonoTime::max())) ++images;
  EXPECT_EQ(images, 100);
  EXPECT_EQ(walkers.last_problem(), "");
}

}  // namespace
}  // namespace cgsr::hal
