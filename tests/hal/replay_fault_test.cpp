// What people hand to --input by mistake, and what disks do to recordings.

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <opencv2/imgcodecs.hpp>

#include "hal/replay/replay_camera.h"
#include "tests/hal/recordings.h"

namespace cgsr::hal {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const cv::Size kSmall{64, 48};

ReplayParameters replay(const std::string& path) {
  ReplayParameters parameters;
  parameters.path = path;
  return parameters;
}

std::string start_error(const ReplayParameters& parameters) {
  ReplayCamera camera(parameters);
  const auto mode = camera.start();
  return mode ? "no error" : mode.error().message;
}

struct Tally {
  std::vector<int> numbers;
  std::vector<std::string> corrupt;
};

// Everything to the end of the stream.
Tally all_of(ReplayCamera& camera) {
  Tally tally;
  for (int i = 0; i < 1000; ++i) {
    const auto image = camera.next_image(MonoTime::max());
    if (image) {
      tally.numbers.push_back(number_of(image->view()));
    } else if (image.error() == CaptureFailure::kCorrupt) {
      tally.corrupt.push_back(camera.last_problem());
    } else {
      EXPECT_EQ(image.error(), CaptureFailure::kEndOfStream);
      return tally;
    }
  }
  ADD_FAILURE() << "the stream does not end";
  return tally;
}

// stderr as the person at the terminal sees it, while it lives.
class CapturedStderr {
 public:
  CapturedStderr() : kept_(dup(STDERR_FILENO)), file_(std::tmpfile()) {
    std::fflush(stderr);
    dup2(fileno(file_), STDERR_FILENO);
  }
  ~CapturedStderr() {
    std::fclose(file_);
    close(kept_);
  }
  CapturedStderr(const CapturedStderr&) = delete;
  CapturedStderr& operator=(const CapturedStderr&) = delete;

  std::string end() {
    std::fflush(stderr);
    dup2(kept_, STDERR_FILENO);
    std::rewind(file_);
    std::string text(4096, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), file_));
    return text;
  }

 private:
  int kept_;
  std::FILE* file_;
};

TEST(ReplayFault, NoFile) {
  TempFolder folder;
  EXPECT_THAT(start_error(replay(folder.file("nothing.avi"))), AllOf(HasSubstr("no file"), HasSubstr("nothing.avi")));
  EXPECT_THAT(start_error(replay("")), HasSubstr("no file"));
  EXPECT_THAT(start_error(replay("http://localhost/v.avi")), HasSubstr("no file"));
}

TEST(ReplayFault, AFolderWithoutImages) {
  TempFolder folder;
  EXPECT_THAT(start_error(replay(folder.path())), HasSubstr("holds no image"));
  write_bytes(folder.file("notes.txt"), "no image");
  EXPECT_THAT(start_error(replay(folder.path())), HasSubstr("holds no image"));
}

TEST(ReplayFault, NeitherFileNorFolder) {
  EXPECT_THAT(start_error(replay("/dev/null")), HasSubstr("neither a file nor a folder"));
}

TEST(ReplayFault, NotReadable) {
  TempFolder folder;
  write_video(folder.file("v.avi"), 2, kSmall);
  std::filesystem::permissions(folder.path(), std::filesystem::perms{0755});
  std::filesystem::permissions(folder.file("v.avi"), std::filesystem::perms::none);
  constexpr uid_t kNobody = 65534;  // root reads everything
  const bool was_root = geteuid() == 0;
  ASSERT_EQ(was_root ? seteuid(kNobody) : 0, 0);
  const std::string error = start_error(replay(folder.file("v.avi")));
  ASSERT_EQ(was_root ? seteuid(0) : 0, 0);
  EXPECT_THAT(error, HasSubstr("Permission denied"));
}

TEST(ReplayFault, ZeroLength) {
  TempFolder folder;
  write_bytes(folder.file("v.avi"), "");
  EXPECT_THAT(start_error(replay(folder.file("v.avi"))), HasSubstr("is empty"));
  write_bytes(folder.file("i.png"), "");
  EXPECT_THAT(start_error(replay(folder.file("i.png"))), HasSubstr("is empty"));
}

TEST(ReplayFault, NotAVideo) {
  TempFolder folder;
  std::string text;
  for (int i = 0; i < 500; ++i) text += "frame,found,x,y,width,height\n";
  std::string noise;
  for (unsigned i = 0, seed = 1; i < 20'000; ++i)
    noise += static_cast<char>((seed = seed * 1664525 + 1013904223) >> 24);
  // FFmpeg takes a .txt for a picture; an extension does not make a video; a playlist is a text that names files.
  for (const std::string name : {"n.txt", "n.avi", "n.mp4", "n.csv", "n"}) {
    for (const std::string& bytes : {text, noise}) {
      write_bytes(folder.file(name), bytes);
      EXPECT_THAT(start_error(replay(folder.file(name))), AllOf(HasSubstr("not a video"), HasSubstr(name)));
    }
  }
  write_video(folder.file("v.avi"), 3, kSmall);
  write_bytes(folder.file("list.m3u8"), "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n" + folder.file("v.avi") + "\n");
  EXPECT_THAT(start_error(replay(folder.file("list.m3u8"))), HasSubstr("not a video"));
}

TEST(ReplayFault, AnImageFileThatIsNone) {
  TempFolder folder;
  write_bytes(folder.file("i.jpg"), "this is no picture");
  EXPECT_THAT(start_error(replay(folder.file("i.jpg"))), HasSubstr("none of the 1 images"));
}

// What is before the cut is delivered, the image under it is not made up, and the end says what is missing.
TEST(ReplayFault, ATruncatedVideoDeliversWhatIsThere) {
  TempFolder folder;
  write_video(folder.file("v.avi"), 50, {160, 120});
  truncate(folder.file("v.avi"), 0.5);
  ReplayCamera camera(replay(folder.file("v.avi")));
  const auto mode = camera.start();
  ASSERT_TRUE(mode) << mode.error().message;
  const Tally tally = all_of(camera);
  ASSERT_GT(tally.numbers.size(), 10U);
  EXPECT_LT(tally.numbers.size(), 40U);
  for (std::size_t i = 0; i < tally.numbers.size(); ++i) EXPECT_EQ(tally.numbers[i], static_cast<int>(i));
  EXPECT_THAT(tally.corrupt, ElementsAre(HasSubstr("cut off"))) << "the image under the cut";
  EXPECT_THAT(camera.last_problem(), HasSubstr("of 50 announced images"));
}

// All pixels of everything that is delivered, in order.
std::vector<std::vector<std::uint8_t>> pixels_of(ReplayCamera& camera) {
  std::vector<std::vector<std::uint8_t>> images;
  CaptureFailure failure = CaptureFailure::kCorrupt;
  while (failure == CaptureFailure::kCorrupt) {
    const auto image = camera.next_image(MonoTime::max());
    if (image) {
      const std::uint8_t* first = image->view().data;
      images.emplace_back(first, first + image->view().stride_bytes * image->view().height_px);
    } else {
      failure = image.error();
    }
  }
  return images;
}

// Cut at every kind of place: whatever is delivered is, byte for byte, the beginning of what the whole video delivers.
TEST(ReplayFaultProperty, AVideoCutAnywhereGivesABeginning) {
  for (const std::string codec : {"MJPG", "XVID"}) {
    TempFolder folder;
    write_video(folder.file("whole.avi"), 12, kSmall, 25.0, true, codec);
    ReplayCamera uncut(replay(folder.file("whole.avi")));
    ASSERT_TRUE(uncut.start());
    const auto want = pixels_of(uncut);
    ASSERT_EQ(want.size(), 12U);
    const std::string whole = read_bytes(folder.file("whole.avi"));
    int opened = 0;
    for (std::size_t cut = 1; cut < whole.size(); cut += whole.size() / 97) {
      write_bytes(folder.file("v.avi"), whole.substr(0, cut));
      ReplayCamera camera(replay(folder.file("v.avi")));
      if (!camera.start()) continue;
      ++opened;
      const auto got = pixels_of(camera);
      ASSERT_LE(got.size(), want.size());
      for (std::size_t i = 0; i < got.size(); ++i) {
        ASSERT_TRUE(got[i] == want[i]) << codec << ", cut at byte " << cut << ", image " << i;
      }
    }
    EXPECT_GT(opened, 20) << codec;
  }
}

// Bytes that a bad disk changed: images may be refused or off in colour, nothing else happens.
TEST(ReplayFaultProperty, ADamagedVideoNeverDoesWorseThanRefuse) {
  TempFolder folder;
  write_video(folder.file("whole.avi"), 12, kSmall);
  const std::string whole = read_bytes(folder.file("whole.avi"));
  std::uint32_t seed = 20261121;
  const auto random = [&] { return (seed = seed * 1664525 + 1013904223) >> 8; };
  for (int trial = 0; trial < 150; ++trial) {
    std::string damaged = whole;
    for (int i = 0; i < 20; ++i) damaged[random() % damaged.size()] = static_cast<char>(random());
    write_bytes(folder.file("v.avi"), damaged);
    ReplayCamera camera(replay(folder.file("v.avi")));
    if (!camera.start()) continue;
    (void)all_of(camera);
  }
}

TEST(ReplayFault, AnMp4WithoutItsIndexIsNoVideo) {
  TempFolder folder;
  // The first box of an MP4 and nothing behind it: what a recorder leaves that was killed before it wrote the index.
  write_bytes(folder.file("v.mp4"), std::string("\0\0\0\x18"
                                                "ftypmp42\0\0\0\0mp42isom",
                                                24) +
                                        std::string("\0\0\x10\0mdat", 8) + std::string(4088, 'x'));
  EXPECT_THAT(start_error(replay(folder.file("v.mp4"))), AllOf(HasSubstr("not a video"), HasSubstr("moov")));
}

TEST(ReplayFault, ATruncatedImageIsRefusedAndTheNextOneFollows) {
  for (const std::string extension : {".jpg", ".png", ".ppm", ".bmp", ".tiff", ".webp"}) {
    TempFolder folder;
    write_folder(folder.file("f"), 5, {160, 120}, extension);
    truncate(folder.file("f/00002" + extension), 0.6);
    write_bytes(folder.file("f/00003" + extension), "");
    ReplayCamera camera(replay(folder.file("f")));
    const auto mode = camera.start();
    ASSERT_TRUE(mode) << mode.error().message;
    const Tally tally = all_of(camera);
    EXPECT_THAT(tally.numbers, ElementsAre(0, 1, 4)) << extension;
    EXPECT_THAT(tally.corrupt, ElementsAre(HasSubstr("00002"), AllOf(HasSubstr("00003"), HasSubstr("empty"))));
  }
}

TEST(ReplayFault, ABadFirstImageDoesNotHideTheRest) {
  TempFolder folder;
  write_folder(folder.file("f"), 4, kSmall);
  truncate(folder.file("f/00000.png"), 0.3);
  ReplayCamera camera(replay(folder.file("f")));
  ASSERT_TRUE(camera.start());
  const Tally tally = all_of(camera);
  EXPECT_THAT(tally.numbers, ElementsAre(1, 2, 3));
  EXPECT_EQ(tally.corrupt.size(), 1U);
}

TEST(ReplayFault, NoGoodImageAtAll) {
  TempFolder folder;
  write_folder(folder.file("f"), 3, kSmall);
  for (int i = 0; i < 3; ++i) truncate(folder.file(fmt::format("f/{:05}.png", i)), 0.3);
  EXPECT_THAT(start_error(replay(folder.file("f"))), AllOf(HasSubstr("none of the 3 images"), HasSubstr("00002.png")));
}

// The sequence counts the refused ones, so that boxes of a truth file stay with their images.
TEST(ReplayFault, RefusedImagesCount) {
  TempFolder folder;
  write_folder(folder.file("f"), 4, kSmall);
  truncate(folder.file("f/00001.png"), 0.3);
  ReplayCamera camera(replay(folder.file("f")));
  ASSERT_TRUE(camera.start());
  EXPECT_EQ(camera.next_image(MonoTime::max())->sequence(), 0U);
  EXPECT_EQ(camera.next_image(MonoTime::max()).error(), CaptureFailure::kCorrupt);
  const auto third = camera.next_image(MonoTime::max());
  ASSERT_TRUE(third);
  EXPECT_EQ(third->sequence(), 2U);
  EXPECT_EQ(number_of(third->view()), 2);
}

TEST(ReplayFault, SizeChangingMidwayInAFolder) {
  TempFolder folder;
  write_folder(folder.file("f"), 5, kSmall);
  ASSERT_TRUE(cv::imwrite(folder.file("f/00002.png"), numbered_image(2, {32, 24})));
  ASSERT_TRUE(cv::imwrite(folder.file("f/00003.png"), numbered_image(3, {65, 48})));
  for (const bool scaled : {false, true}) {
    auto parameters = replay(folder.file("f"));
    parameters.width_px = scaled ? 320 : 0;
    parameters.height_px = scaled ? 240 : 0;
    ReplayCamera camera(parameters);
    ASSERT_TRUE(camera.start());
    const Tally tally = all_of(camera);
    EXPECT_THAT(tally.numbers, ElementsAre(0, 1, 4));
    EXPECT_THAT(tally.corrupt,
                ElementsAre(AllOf(HasSubstr("image 2 is 32x24"), HasSubstr("64x48")), HasSubstr("image 3 is 65x48")));
  }
}

TEST(ReplayFault, SizeChangingMidwayInAVideo) {
  TempFolder folder;
  std::string stream;  // motion JPEG without a container: one image behind the other
  for (int i = 0; i < 20; ++i) {
    std::vector<std::uint8_t> image;
    const bool other = i >= 8 && i < 12;
    cv::imencode(".jpg", numbered_image(i, other ? cv::Size{320, 240} : cv::Size{160, 120}), image);
    stream.append(image.begin(), image.end());
  }
  write_bytes(folder.file("v.mjpeg"), stream);
  ReplayCamera camera(replay(folder.file("v.mjpeg")));
  const auto mode = camera.start();
  ASSERT_TRUE(mode) << mode.error().message;
  EXPECT_EQ(mode->width_px, 160);
  const Tally tally = all_of(camera);
  EXPECT_THAT(tally.numbers, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 12, 13, 14, 15, 16, 17, 18, 19));
  EXPECT_THAT(tally.corrupt, testing::SizeIs(4));
  EXPECT_THAT(tally.corrupt, testing::Each(HasSubstr("is 320x240")));
}

TEST(ReplayFault, AFolderThatVanishes) {
  TempFolder folder;
  write_folder(folder.file("f"), 4, kSmall);
  auto parameters = replay(folder.file("f"));
  parameters.loop = true;
  ReplayCamera camera(parameters);
  ASSERT_TRUE(camera.start());
  ASSERT_TRUE(camera.next_image(MonoTime::max()));
  std::filesystem::remove_all(folder.file("f"));
  CaptureFailure failure = CaptureFailure::kCorrupt;
  int tries = 0;
  for (; failure == CaptureFailure::kCorrupt && tries < 20; ++tries) {
    failure = camera.next_image(MonoTime::max()).error();
  }
  EXPECT_EQ(failure, CaptureFailure::kDisconnected) << "a loop over nothing must end";
  EXPECT_LT(tries, 10);
  EXPECT_THAT(camera.last_problem(), HasSubstr("No such file"));
}

TEST(ReplayFault, NonsenseRates) {
  TempFolder folder;
  write_video(folder.file("v.avi"), 3, kSmall, 1000.0);
  ReplayCamera camera(replay(folder.file("v.avi")));
  const auto mode = camera.start();
  ASSERT_TRUE(mode) << mode.error().message;
  EXPECT_EQ(mode->frame_period, Duration(33'333'333));
  EXPECT_THAT(camera.notes(), ElementsAre(HasSubstr("1000 Hz claimed")));

  for (const double rate : {-1.0, 0.01, 1e6, std::numeric_limits<double>::quiet_NaN()}) {
    auto parameters = replay(folder.file("v.avi"));
    parameters.rate_hz = rate;
    EXPECT_THAT(start_error(parameters), HasSubstr("rate_hz")) << rate;
  }
}

TEST(ReplayFault, AbsurdlyLarge) {
  TempFolder folder;
  ASSERT_TRUE(cv::imwrite(folder.file("wide.png"), cv::Mat(2, kLongestSide_px + 2, CV_8UC3, cv::Scalar::all(9))));
  EXPECT_THAT(start_error(replay(folder.file("wide.png"))), HasSubstr("larger than 8192"));
  ASSERT_TRUE(cv::imwrite(folder.file("high.jpg"), cv::Mat(kLongestSide_px + 2, 2, CV_8UC3, cv::Scalar::all(9))));
  EXPECT_THAT(start_error(replay(folder.file("high.jpg"))), HasSubstr("larger than 8192"));
  // A small file that unpacks to a lot: refused by its header, without the memory.
  ASSERT_TRUE(cv::imwrite(folder.file("bomb.png"), cv::Mat(8200, 8200, CV_8UC1, cv::Scalar::all(0))));
  EXPECT_THAT(start_error(replay(folder.file("bomb.png"))), AllOf(HasSubstr("bomb.png"), HasSubstr("8200x8200")));
  write_video(folder.file("v.avi"), 1, {kLongestSide_px + 2, 16});
  EXPECT_THAT(start_error(replay(folder.file("v.avi"))), HasSubstr("8192"));
}

TEST(ReplayFault, BadParameters) {
  TempFolder folder;
  write_folder(folder.file("f"), 3, kSmall);
  const auto with = [&](auto change) {
    auto parameters = replay(folder.file("f"));
    change(parameters);
    return start_error(parameters);
  };
  EXPECT_THAT(with([](auto& p) { p.width_px = 320; }), HasSubstr("go together"));
  EXPECT_THAT(with([](auto& p) { p.width_px = 321, p.height_px = 240; }), HasSubstr("321x240"));
  EXPECT_THAT(with([](auto& p) { p.width_px = 32000, p.height_px = 24000; }), HasSubstr("32000x24000"));
  EXPECT_THAT(with([](auto& p) { p.width_px = -320, p.height_px = -240; }), HasSubstr("-320x-240"));
  EXPECT_THAT(with([](auto& p) { p.slots = 0; }), HasSubstr("slots"));
  EXPECT_THAT(with([](auto& p) { p.slots = 65; }), HasSubstr("slots"));
  EXPECT_THAT(with([](auto& p) { p.first = -1; }), HasSubstr("negative"));
  EXPECT_THAT(with([](auto& p) { p.first = 3; }), HasSubstr("no image 3"));
  EXPECT_THAT(with([](auto& p) { p.first = 4; }), HasSubstr("has only 3 images"));
  EXPECT_THAT(with([](auto&) {}), HasSubstr("no error"));
}

// A start that failed can be tried again, and one that lost its file says so.
TEST(ReplayFault, StartAgainAfterAFailure) {
  TempFolder folder;
  ReplayCamera camera(replay(folder.file("v.avi")));
  EXPECT_FALSE(camera.start());
  write_video(folder.file("v.avi"), 3, kSmall);
  EXPECT_TRUE(camera.start());
  EXPECT_TRUE(camera.next_image(MonoTime::max()));
  camera.stop();
  std::filesystem::remove(folder.file("v.avi"));
  const auto again = camera.start();
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("no file"));
  EXPECT_EQ(camera.next_image(MonoTime::max()).error(), CaptureFailure::kDisconnected);
}

// The recording was replaced by one of another size while somebody still held an image.
TEST(ReplayFault, AnotherSizeAfterRestartWaitsForTheLeases) {
  TempFolder folder;
  write_video(folder.file("v.avi"), 3, kSmall);
  ReplayCamera camera(replay(folder.file("v.avi")));
  ASSERT_TRUE(camera.start());
  auto kept = camera.next_image(MonoTime::max());
  ASSERT_TRUE(kept);
  camera.stop();
  write_video(folder.file("v.avi"), 3, {128, 96});
  const auto again = camera.start();
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("still on lease"));
  EXPECT_EQ(number_of(kept->view()), 0);
  *kept = {};
  const auto mode = camera.start();
  ASSERT_TRUE(mode);
  EXPECT_EQ(mode->width_px, 128);
}

TEST(ReplayFault, LibrariesKeepOffTheTerminal) {
  TempFolder folder;
  write_video(folder.file("v.avi"), 20, kSmall);
  truncate(folder.file("v.avi"), 0.5);
  write_bytes(folder.file("n.mp4"), std::string(5000, 'x'));
  write_folder(folder.file("f"), 3, kSmall, ".jpg");
  truncate(folder.file("f/00001.jpg"), 0.5);
  CapturedStderr terminal;
  for (const std::string name : {"v.avi", "n.mp4", "f"}) {
    ReplayCamera camera(replay(folder.file(name)));
    if (camera.start()) (void)all_of(camera);
  }
  EXPECT_EQ(terminal.end(), "");
}

}  // namespace
}  // namespace cgsr::hal
