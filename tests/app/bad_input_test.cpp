// What a user gets wrong: each is refused with a message that names it, nothing crashes, nothing half-done stays behind.
#include <sys/resource.h>
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "tests/app/program.h"

namespace cgsr::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class BadInputFault : public ::testing::Test {
 protected:
  Outcome track(const std::string& input, const std::string& region) {
    return run_cgsr({"track", "--input", input, "--learn", region, "--csv", scratch_ / "t.csv"});
  }
  std::string images(int count = 3) {
    region_ = make_images(scratch_ / "images", count);
    return scratch_ / "images";
  }
  std::string model() {
    const auto outcome = run_cgsr({"learn", "--input", images(), "--region", region_, "--output", scratch_ / "m"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return scratch_ / "m";
  }

  ScratchFolder scratch_;
  std::string region_ = "40,80,60,80";
};

void expect_refused(const Outcome& outcome, const std::string& words) {
  EXPECT_EQ(outcome.exit_code, 1) << outcome.errors;
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("error: "), HasSubstr(words)));
}

TEST_F(BadInputFault, NoFile) {
  expect_refused(track(scratch_ / "none.avi", region_), "none.avi");
}

TEST_F(BadInputFault, ATruthThatIsNoListOfBoxes) {
  const auto folder = images(4);
  const auto against = [&](const std::string& truth) {
    return run_cgsr({"track", "--input", folder, "--learn", region_, "--truth", truth});
  };
  expect_refused(against(folder), "expected a text file");
  expect_refused(against(folder + "/0000.png"), "0000.png:1: ");
  const std::string line = "40,80,60,80\n";
  write_text(scratch_ / "truth.txt", line + line + line);
  expect_refused(against(scratch_ / "truth.txt"), "has 3 lines for 4 images");
  write_text(scratch_ / "truth.txt", line + line + line + line + line);
  expect_refused(against(scratch_ / "truth.txt"), "has 5 lines for 4 images");
  write_text(scratch_ / "truth.txt", line + line + line + line + "\n");
  EXPECT_EQ(against(scratch_ / "truth.txt").exit_code, 0);
}

TEST_F(BadInputFault, NumbersAndNamesOfTheCommandLine) {
  const auto refused = [](const std::vector<std::string>& words, const std::string& message) {
    const auto outcome = run_cgsr(words);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr(message));
  };
  for (const std::string value : {"nan", "inf", "-inf", "0", "1e9", "ten", ""}) {
    refused({"run", "--duration", value},
            value.empty() ? "--duration" : "'" + value + "' is not a number in 0.001..1000000");
  }
  for (const std::string value : {"-1", "1.5", "nan", "99999999999999999999"}) {
    refused({"run", "--seed", value}, "'" + value + "' is not a whole number from 0");
    refused({"reproduce", "--seed", value, "--list"}, "'" + value + "' is not a whole number from 0");
  }
  refused({"track", "--inptu", "x"}, "there is no option '--inptu' (did you mean '--input'?)");
  refused({"map", "info", "--scael=2", "x.obj"}, "there is no option '--scael' (did you mean '--scale'?)");
  refused({"trak"}, "there is no command 'trak' (did you mean 'track'?)");
  refused({"trak", "--help"}, "there is no command 'trak'");
  refused({"calibrate", "camra"},
          "there is no command 'camra' (did you mean 'camera'?); cgsr calibrate --help names them");
  refused({"calibrate", "camera", "--bord", "9x6"},
          "there is no option '--bord' (did you mean '--board'?); cgsr calibrate camera --help names them");
  refused({"sim", "render", "--wrold", "home"},
          "there is no option '--wrold' (did you mean '--world'?); cgsr sim render --help names them");
  refused({"reproduce", "--sede", "3"},
          "there is no option '--sede' (did you mean '--seed'?); cgsr reproduce --help names them");
}

TEST_F(BadInputFault, NotAVideo) {
  write_text(scratch_ / "words.avi", "these are words, not pictures\n");
  expect_refused(track(scratch_ / "words.avi", region_), "words.avi");
}

TEST_F(BadInputFault, ZeroLength) {
  write_text(scratch_ / "empty.mp4", "");
  expect_refused(track(scratch_ / "empty.mp4", region_), "empty.mp4");
}

TEST_F(BadInputFault, FolderWithoutImages) {
  std::filesystem::create_directories(scratch_.path() / "void");
  expect_refused(track(scratch_ / "void", region_), "void");
}

TEST_F(BadInputFault, TruncatedVideoIsTrackedAsFarAsItGoes) {
  const auto folder = images(30);
  {
    cv::VideoWriter writer(scratch_ / "whole.avi", cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25.0, {320, 240});
    for (int i = 0; i < 30; ++i) writer.write(cv::imread(fmt::format("{}/{:04}.png", folder, i)));
  }
  const auto bytes = read_text(scratch_ / "whole.avi");
  write_text(scratch_ / "half.avi", bytes.substr(0, bytes.size() / 2));
  const auto outcome = track(scratch_ / "half.avi", region_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  const auto text = read_text(scratch_ / "t.csv");
  const auto rows = std::count(text.begin(), text.end(), '\n');
  EXPECT_GT(rows, 5);
  EXPECT_LT(rows, 31);
}

TEST_F(BadInputFault, ImageSizeChangesMidway) {
  const auto folder = images(4);
  cv::imwrite(folder + "/0002.png", cv::Mat(100, 100, CV_8UC3, cv::Scalar(1, 2, 3)));
  const auto outcome = track(folder, region_);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.errors, HasSubstr("100x100"));
  EXPECT_THAT(read_text(scratch_ / "t.csv"), AllOf(HasSubstr("\n2,0,"), HasSubstr("\n3,1,")));
}

TEST_F(BadInputFault, GreyVideoIsASingleColour) {
  const auto folder = images(3);
  for (int i = 0; i < 3; ++i) {
    cv::Mat image = cv::imread(fmt::format("{}/{:04}.png", folder, i), cv::IMREAD_GRAYSCALE);
    cv::imwrite(fmt::format("{}/{:04}.png", folder, i), image);
  }
  const auto outcome = track(folder, region_);
  expect_refused(outcome, "colour");
}

TEST_F(BadInputFault, RegionOutsideTheImage) {
  expect_refused(track(images(), "400,80,60,80"), "400");
}

TEST_F(BadInputFault, RegionOfOnePixel) {
  expect_refused(track(images(), "40,80,1,1"), "too small");
}

TEST_F(BadInputFault, RegionThatIsNone) {
  expect_refused(track(images(), "40,80,sixty,80"), "sixty");
  expect_refused(track(images(), "40,80,nan,80"), "nan");
}

TEST_F(BadInputFault, SingleColouredRegionIsRefusedOrWidenedWithTheReason) {
  const auto folder = images();
  const auto inside = run_cgsr({"learn", "--input", folder, "--region", "44,84,50,30", "--output", scratch_ / "m"});
  if (inside.exit_code == 0) {
    EXPECT_THAT(inside.output, HasSubstr("widened"));
  } else {
    expect_refused(inside, "colour");
  }
  cv::imwrite(scratch_ / "plain.png", cv::Mat(240, 320, CV_8UC3, cv::Scalar(40, 40, 220)));
  expect_refused(
      run_cgsr({"learn", "--input", scratch_ / "plain.png", "--region", "100,80,60,60", "--output", scratch_ / "p"}),
      "colour");
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "p"));
}

TEST_F(BadInputFault, DamagedModel) {
  auto bytes = read_text(model());
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  write_text(scratch_ / "damaged", bytes);
  expect_refused(run_cgsr({"track", "--input", scratch_ / "images", "--model", scratch_ / "damaged"}), "damaged");
}

TEST_F(BadInputFault, NotAModel) {
  images();
  write_text(scratch_ / "words", "not a model");
  expect_refused(run_cgsr({"track", "--input", scratch_ / "images", "--model", scratch_ / "words"}), "words");
}

TEST_F(BadInputFault, EveryErrorOfAConfigurationAtOnceWithItsLine) {
  write_text(scratch_ / "bad.toml", "[run]\npace = \"slow\"\nspeed = 3\n[stage.track]\nbudget_us = 90000\n");
  const auto outcome = run_cgsr({"check", "--config", scratch_ / "bad.toml"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("bad.toml:2"), HasSubstr("bad.toml:3"), HasSubstr("bad.toml:5"),
                                    HasSubstr("100..33000")));
}

TEST_F(BadInputFault, MalformedConfiguration) {
  write_text(scratch_ / "bad.toml", "[run\npace = 1\n");
  expect_refused(run_cgsr({"check", "--config", scratch_ / "bad.toml"}), "bad.toml:1");
}

TEST_F(BadInputFault, ScheduleThatDoesNotFitShowsTheSum) {
  Keys full;
  for (const char* const stage : {"decode", "localize", "probes", "shade", "search", "track", "identify", "decide"}) {
    full[std::string("stage.") + stage + ".budget_us"] = "33000";
  }
  write_text(scratch_ / "full.toml", extended(CGSR_SOURCE_DIR "/config/robots/video.toml", full));
  const auto outcome = run_cgsr({"check", "--config", scratch_ / "full.toml", "--input", images(), "--model", model()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("264000"));
}

TEST_F(BadInputFault, UnwritableOutputIsSaidBeforeTheWork) {
  const auto outcome =
      run_cgsr({"track", "--input", images(), "--learn", region_, "--csv", scratch_ / "no/such/folder/t.csv"});
  expect_refused(outcome, "no/such/folder/t.csv");
  expect_refused(run_cgsr({"track", "--input", images(), "--learn", region_, "--video", scratch_ / "no/such/t.avi"}),
                 "no/such/t.avi");
  expect_refused(run_cgsr({"learn", "--input", images(), "--region", region_, "--output", scratch_ / "m", "--preview",
                           scratch_ / "p.what"}),
                 "p.what: expected the name of a picture to end in .png");
  expect_refused(run_cgsr({"learn", "--input", images(), "--region", region_, "--output", scratch_ / "no/such/m"}),
                 "no/such/m");
}

// What a command reads survives it, whatever was mistyped, with --force too; nothing is begun that could not be finished.
TEST_F(BadInputFault, OutputsThatWouldDestroyAnInput) {
  const auto folder = images();
  const auto learned = model();
  const auto before = read_text(learned);
  write_text(scratch_ / "truth.txt", "40,80,60,80\n");
  write_text(scratch_ / "robot.toml", extended(CGSR_SOURCE_DIR "/config/robots/video.toml", {}));
  std::filesystem::create_symlink("m", scratch_ / "link");
  for (const std::string option : {"--csv", "--json"}) {
    for (const std::string& output :
         {scratch_ / "m", scratch_ / "link", scratch_ / "truth.txt", scratch_ / "robot.toml"}) {
      expect_refused(run_cgsr({"track", "--input", folder, "--model", learned, "--truth", scratch_ / "truth.txt",
                               "--config", scratch_ / "robot.toml", option, output, "--force"}),
                     option + " " + output + ": is read as");
    }
  }
  expect_refused(run_cgsr({"learn", "--input", folder, "--region", region_, "--output", scratch_ / "other", "--preview",
                           folder + "/0001.png", "--force"}),
                 "0001.png: is read as --input");
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "other"));
  expect_refused(run_cgsr({"run", "--config", scratch_ / "robot.toml", "--input", folder, "--model", learned, "--csv",
                           scratch_ / "run.csv", "--json", learned, "--force"}),
                 "is read as --model");
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "run.csv"));
  const std::string robot = scratch_ / "robot.toml";
  expect_refused(run_cgsr({"devices", "camera", "--setup", "--config", robot, "--output", robot, "--force"}),
                 "is read as --config");
  EXPECT_EQ(read_text(learned), before);
}

TEST_F(BadInputFault, OutputsOfTheSimulatorAndTheTables) {
  write_text(scratch_ / "notes.txt", "not ours\n");
  const std::string world = scratch_ / "world.toml";
  write_text(world, read_text(CGSR_SOURCE_DIR "/config/worlds/home.toml"));
  expect_refused(run_cgsr({"sim", "render", "--world", world, "--output", world, "--force"}), "to end in .png");
  std::filesystem::create_symlink("world.toml", scratch_ / "look.png");
  expect_refused(run_cgsr({"sim", "render", "--world", world, "--output", scratch_ / "look.png", "--force"}),
                 "is read as --world");
  expect_refused(
      run_cgsr({"sim", "run", "--scenario", "home-follow", "--duration", "1", "--truth", scratch_ / "notes.txt"}),
      "notes.txt: exists and is not a CSV file");
  expect_refused(run_cgsr({"reproduce", "figure-3.3", "--json", scratch_ / "notes.txt"}),
                 "notes.txt: exists and is not");
  EXPECT_EQ(read_text(scratch_ / "notes.txt"), "not ours\n");
}

TEST_F(BadInputFault, PeopleWhoAreNotThere) {
  const std::string people = scratch_ / "people.json";
  const auto folder = images();
  expect_refused(run_cgsr({"people", "identify", "--identities", people, "--input", folder}), "people.json");
  expect_refused(run_cgsr({"people", "forget", "--identities", people, "--name", "nobody"}), "people.json");
  expect_refused(run_cgsr({"people", "enroll", "--identities", people, "--name", "a", "--input", folder, "--cascade",
                           scratch_ / "none.xml"}),
                 "Debian's opencv-data has one");
  expect_refused(run_cgsr({"people", "enroll", "--identities", people, "--name", "a", "--input", folder,
                           "--eye-cascade", scratch_ / "none.xml"}),
                 "person.eye_cascade names another place, or none");
  expect_refused(run_cgsr({"people", "enroll", "--identities", people, "--name", "a", "--input", folder}),
                 "with exactly one face");
  EXPECT_FALSE(std::filesystem::exists(people));
}

// Somebody else's file is refused before an image is looked at; a damaged one is put aside when the new one is written, and here none is.
TEST_F(BadInputFault, AnIdentitiesFileThatIsNoneOrDamagedStaysWhereTheEnrolmentFails) {
  const std::string people = scratch_ / "people";
  const std::string damaged =
      "\xA2\x66"
      "format\x6F"
      "cgsr identities\x67"
      "payload cut off";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"these are no identities\n", "no identities file: it is something else"}, {damaged, "with exactly one face"}};
  for (const auto& [text, refusal] : cases) {
    write_text(people, text);
    expect_refused(run_cgsr({"people", "enroll", "--identities", people, "--name", "a", "--input", images()}), refusal);
    EXPECT_EQ(read_text(people), text);
    EXPECT_FALSE(std::filesystem::exists(people + ".damaged-1"));
  }
}

TEST_F(BadInputFault, OutputsThatWouldReplaceAFileOfAnotherKind) {
  const auto folder = images();
  write_text(scratch_ / "notes.txt", "not ours\n");
  const std::vector<std::string> words{
      "track", "--input", folder, "--learn", region_, "--csv", scratch_ / "t.csv", "--json", scratch_ / "notes.txt"};
  expect_refused(run_cgsr(words), "notes.txt: exists and is not a JSON object");
  EXPECT_EQ(read_text(scratch_ / "notes.txt"), "not ours\n");
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "t.csv"));
  auto forced = words;
  forced.emplace_back("--force");
  EXPECT_EQ(run_cgsr(forced).exit_code, 0);
  EXPECT_EQ(run_cgsr(words).exit_code, 0);  // its own kind now

  ASSERT_EQ(run_cgsr({"config", "new", "--webcam", "--output", scratch_ / "new.toml"}).exit_code, 0);
  ASSERT_EQ(run_cgsr({"config", "new", "--webcam", "--output", scratch_ / "new.toml"}).exit_code, 0);
  write_text(scratch_ / "new.toml", read_text(scratch_ / "new.toml") + "# mine\n");
  expect_refused(run_cgsr({"config", "new", "--webcam", "--output", scratch_ / "new.toml"}), "exists and is not");
}

TEST_F(BadInputFault, FullDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  expect_refused(run_cgsr({"track", "--input", images(), "--learn", region_, "--csv", "/dev/full"}), "/dev/full");
}

/// While it lives, what is started may write so much into a file and no more: a disk that fills up midway.
class SmallFiles {
 public:
  explicit SmallFiles(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    static_cast<void>(std::signal(SIGXFSZ, handler_));
  }
  SmallFiles(const SmallFiles&) = delete;
  SmallFiles& operator=(const SmallFiles&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

// An MP4 of so few pictures is written when it is closed: nothing before that can fail.
TEST_F(BadInputFault, AVideoThatCannotBeFinishedIsAFailure) {
  const auto folder = images(8);
  const auto learned = model();
  Outcome tracked;
  Outcome ran;
  {
    const SmallFiles limit(8 * 1024);
    tracked = run_cgsr({"track", "--input", folder, "--learn", region_, "--video", scratch_ / "t.mp4"});
    ran = run_cgsr({"run", "--config", CGSR_SOURCE_DIR "/config/robots/video.toml", "--input", folder, "--model",
                    learned, "--video", scratch_ / "r.mp4"});
  }
  expect_refused(tracked, "t.mp4");
  EXPECT_THAT(tracked.errors, HasSubstr("File too large"));
  EXPECT_EQ(ran.exit_code, 1) << ran.errors;
  EXPECT_THAT(ran.errors, AllOf(HasSubstr("r.mp4"), HasSubstr("File too large")));
}

TEST_F(BadInputFault, NoTerminalMeansNoControlCharacters) {
  const auto outcome = track(images(20), region_);
  EXPECT_THAT(outcome.errors + outcome.output, Not(HasSubstr("\033")));
  EXPECT_THAT(outcome.errors + outcome.output, Not(HasSubstr("\r")));
}

TEST_F(BadInputFault, KilledMidwayLeavesReadableOutput) {
  const auto folder = images(2000);
  RunningCgsr running(
      {"track", "--input", folder, "--learn", region_, "--csv", scratch_ / "t.csv", "--video", scratch_ / "t.avi"});
  const auto rows = [&] {
    const auto text = read_text(scratch_ / "t.csv");
    return std::count(text.begin(), text.end(), '\n');
  };
  while (rows() < 40 && !running.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  running.send(SIGKILL);
  EXPECT_EQ(running.wait().exit_code, 128 + SIGKILL) << "it ended before it could be killed: make more images";
  EXPECT_GE(rows(), 40);
  cv::VideoCapture video(scratch_ / "t.avi");
  cv::Mat picture;
  int pictures = 0;
  while (video.read(picture)) ++pictures;
  EXPECT_GE(pictures, 20);
}

TEST_F(BadInputFault, InterruptedTrackEndsInOrderAndSaysSo) {
  const auto folder = images(2000);
  RunningCgsr running({"track", "--input", folder, "--learn", region_, "--csv", scratch_ / "t.csv"});
  while (read_text(scratch_ / "t.csv").size() < 2000 && !running.ended())
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  running.send(SIGINT);
  const auto outcome = running.wait();
  EXPECT_EQ(outcome.exit_code, 3) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("until it was stopped"));
}

TEST_F(BadInputFault, CommandLineThatIsNotUnderstood) {
  EXPECT_EQ(run_cgsr({}).exit_code, 2);
  EXPECT_EQ(run_cgsr({"dance"}).exit_code, 2);
  EXPECT_EQ(run_cgsr({"track", "--input", "x"}).exit_code, 2);
  EXPECT_EQ(run_cgsr({"track", "--input", "x", "--learn", "1,2,3,4", "--model", "m"}).exit_code, 2);
}

}  // namespace
}  // namespace cgsr::app::testing
