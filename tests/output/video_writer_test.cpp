#include "src/output/video_writer.h"

#include <csignal>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <opencv2/videoio.hpp>

#include "hal/replay/replay_camera.h"
#include "tests/hal/recordings.h"

namespace cgsr::app {
namespace {

using hal::numbered_image;
using hal::TempFolder;
using testing::AllOf;
using testing::HasSubstr;

const cv::Size kSize{160, 120};

// What somebody else's player makes of the file.
int pictures_by_opencv(const std::string& path) {
  cv::VideoCapture video(path, cv::CAP_FFMPEG);
  cv::Mat picture;
  int count = 0;
  while (video.read(picture)) ++count;
  return count;
}

struct Replayed {
  int pictures = 0;
  int damaged = 0;
  int out_of_order = 0;
};

Replayed replayed(const std::string& path) {
  hal::ReplayParameters parameters;
  parameters.path = path;
  hal::ReplayCamera camera(parameters);
  Replayed result;
  if (const auto mode = camera.start(); !mode) {
    ADD_FAILURE() << mode.error().message;
    return result;
  }
  while (true) {
    const auto image = camera.next_image(MonoTime::max());
    if (image) {
      if (hal::number_of(image->view()) != result.pictures % 60) ++result.out_of_order;
      ++result.pictures;
    } else if (image.error() == hal::CaptureFailure::kCorrupt) {
      ++result.damaged;
    } else {
      return result;
    }
  }
}

class VideoWriterOf : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] std::string path(const std::string& name = "v") const { return folder_.file(name + GetParam()); }
  TempFolder folder_;
};

TEST_P(VideoWriterOf, WhatIsWrittenCanBeReadBack) {
  auto video = VideoWriter::create(path(), kSize, 12.5);
  ASSERT_TRUE(video) << video.error().message;
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(video->add(numbered_image(i, kSize)));
  ASSERT_TRUE(video->close());
  EXPECT_TRUE(video->close()) << "idempotent";
  EXPECT_EQ(video->pictures(), 50);
  EXPECT_EQ(pictures_by_opencv(path()), 50);
  const Replayed back = replayed(path());
  EXPECT_EQ(back.pictures, 50);
  EXPECT_EQ(back.damaged, 0);
  EXPECT_EQ(back.out_of_order, 0);
  EXPECT_NEAR(cv::VideoCapture(path(), cv::CAP_FFMPEG).get(cv::CAP_PROP_FPS), 12.5, 0.01);
}

TEST_P(VideoWriterOf, ColoursSurvive) {
  auto video = VideoWriter::create(path(), kSize, 25.0);
  ASSERT_TRUE(video);
  const cv::Mat picture(kSize, CV_8UC3, cv::Scalar(40, 90, 200));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(video->add(picture));
  ASSERT_TRUE(video->close());
  cv::VideoCapture back(path(), cv::CAP_FFMPEG);
  cv::Mat seen;
  ASSERT_TRUE(back.read(seen));
  const cv::Scalar mean = cv::mean(seen);
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(mean[channel], cv::mean(picture)[channel], 6) << channel;
}

TEST_P(VideoWriterOf, OddSizesLoseTheirLastColumnAndRow) {
  auto video = VideoWriter::create(path(), {161, 121}, 25.0);
  ASSERT_TRUE(video) << video.error().message;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(video->add(numbered_image(i, {161, 121})));
  ASSERT_TRUE(video->close());
  EXPECT_EQ(replayed(path()).pictures, 5);
}

// Writes until it is killed; tells through the pipe how many pictures add() has returned for.
[[noreturn]] void write_until_killed(const std::string& path, int pipe) {
  auto video = VideoWriter::create(path, kSize, 25.0);
  for (int i = 0; video; ++i) {
    if (!video->add(numbered_image(i, kSize))) break;
    if (write(pipe, "+", 1) != 1) break;
  }
  _exit(1);
}

TEST_P(VideoWriterOf, AKilledProgramLeavesAReadableVideo) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) write_until_killed(path(), ends[1]);
  close(ends[1]);
  int added = 0;
  char sign = 0;
  while (added < 100 && read(ends[0], &sign, 1) == 1) ++added;
  kill(child, SIGKILL);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "it ended by itself";
  close(ends[0]);
  ASSERT_EQ(added, 100);

  const int half_a_second = 13;
  const int promised = std::string(GetParam()) == ".mp4" ? added - half_a_second : added;
  EXPECT_GE(pictures_by_opencv(path()), promised);
  const Replayed back = replayed(path());
  EXPECT_GE(back.pictures, promised);
  EXPECT_LE(back.damaged, 1);
  EXPECT_EQ(back.out_of_order, 0);
}

// While it is being written it can be watched, without any closing.
TEST_P(VideoWriterOf, GrowsWithEveryPicture) {
  auto video = VideoWriter::create(path(), kSize, 25.0);
  ASSERT_TRUE(video);
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(video->add(numbered_image(i, kSize)));
  EXPECT_GE(pictures_by_opencv(path()), std::string(GetParam()) == ".mp4" ? 17 : 30);
}

// /dev/full takes nothing: every write ends with 'no space left on device'.
TEST_P(VideoWriterOf, AFullDiskIsSaid) {
  std::filesystem::create_symlink("/dev/full", path());
  auto video = VideoWriter::create(path(), kSize, 25.0);
  ASSERT_FALSE(video);
  EXPECT_THAT(video.error().message, AllOf(HasSubstr("No space left on device"), HasSubstr(path())));
}

// A disk that fills up midway, played by the limit on file sizes: the error comes with the picture, stays, and what was written
// before can be read.
TEST_P(VideoWriterOf, ADiskThatFillsUpIsSaidAtOnceAndKeepsTheBeginning) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{64 * 1024, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  auto video = VideoWriter::create(path(), kSize, 25.0);
  int added = 0;
  Result<void> result;
  for (; video && result && added < 10'000; ++added) result = video->add(numbered_image(added, kSize));
  const Result<void> again = video ? video->add(numbered_image(0, kSize)) : fail("");
  const Result<void> closed = video ? video->close() : fail("");
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);

  ASSERT_TRUE(video);
  ASSERT_FALSE(result) << "nobody noticed";
  EXPECT_THAT(result.error().message, AllOf(HasSubstr("cannot write"), HasSubstr("File too large")));
  EXPECT_FALSE(again);
  ASSERT_FALSE(closed) << "close() reports what went wrong before";
  EXPECT_EQ(closed.error().message, result.error().message);
  EXPECT_GT(replayed(path()).pictures, 3);
}

TEST_P(VideoWriterOf, UnwritablePathsAreSaid) {
  EXPECT_THAT(VideoWriter::create(path("missing/v"), kSize, 25.0).error().message,
              AllOf(HasSubstr("No such file or directory"), HasSubstr("missing/v")));
  std::filesystem::create_directory(path("folder"));
  EXPECT_THAT(VideoWriter::create(path("folder"), kSize, 25.0).error().message, HasSubstr("directory"));
}

TEST_P(VideoWriterOf, PicturesOfAnotherSizeOrTypeAreRefusedAndTheVideoGoesOn) {
  auto video = VideoWriter::create(path(), kSize, 25.0);
  ASSERT_TRUE(video);
  ASSERT_TRUE(video->add(numbered_image(0, kSize)));
  EXPECT_FALSE(video->add(numbered_image(1, {80, 60})));
  EXPECT_FALSE(video->add(cv::Mat(kSize, CV_8UC1)));
  EXPECT_FALSE(video->add(cv::Mat()));
  EXPECT_TRUE(video->add(numbered_image(1, kSize)));
  ASSERT_TRUE(video->close());
  EXPECT_FALSE(video->add(numbered_image(2, kSize))) << "closed";
  EXPECT_EQ(replayed(path()).pictures, 2);
}

INSTANTIATE_TEST_SUITE_P(Containers, VideoWriterOf, testing::Values(".avi", ".mkv", ".mp4"),
                         [](const auto& test) { return std::string(test.param).substr(1); });

TEST(VideoWriterFault, OtherEndingsSizesAndRatesAreRefused) {
  TempFolder folder;
  EXPECT_THAT(VideoWriter::create(folder.file("v.txt"), kSize, 25.0).error().message, HasSubstr(".avi, .mkv or .mp4"));
  EXPECT_THAT(VideoWriter::create(folder.file("v"), kSize, 25.0).error().message, HasSubstr(".avi, .mkv or .mp4"));
  EXPECT_FALSE(VideoWriter::create(folder.file("v.avi"), {0, 0}, 25.0));
  EXPECT_FALSE(VideoWriter::create(folder.file("v.avi"), kSize, 0.0));
  EXPECT_FALSE(VideoWriter::create(folder.file("v.avi"), kSize, std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(std::filesystem::exists(folder.file("v.avi")));
}

TEST(VideoWriter, MovingClosesWhatWasThere) {
  TempFolder folder;
  auto first = VideoWriter::create(folder.file("1.avi"), kSize, 25.0);
  auto second = VideoWriter::create(folder.file("2.avi"), kSize, 25.0);
  ASSERT_TRUE(first && second);
  ASSERT_TRUE(first->add(numbered_image(0, kSize)));
  *first = std::move(*second);
  ASSERT_TRUE(first->add(numbered_image(0, kSize)));
  ASSERT_TRUE(first->close());
  EXPECT_EQ(replayed(folder.file("1.avi")).pictures, 1);
  EXPECT_EQ(replayed(folder.file("2.avi")).pictures, 1);
}

}  // namespace
}  // namespace cgsr::app
