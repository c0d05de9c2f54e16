// The commands do what they say, in the words the README uses.
#include <filesystem>
#include <sstream>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "tests/app/program.h"

namespace cgsr::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(CommandLine, HelpNamesEveryCommand) {
  const auto help = run_cgsr({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command : {"run", "check", "config", "learn", "track", "map", "reproduce", "sim"})
    EXPECT_THAT(help.output, HasSubstr(command));
}

TEST(CommandLine, ACommandThatThereIsNotIsNamed) {
  const auto slip = run_cgsr({"trak", "--input", "somewhere"});
  EXPECT_NE(slip.exit_code, 0);
  EXPECT_THAT(slip.errors, HasSubstr("there is no command 'trak'"));
}

TEST(CommandLine, EveryCommandExplainsItself) {
  for (const char* command : {"run", "check", "learn", "track"}) {
    const auto help = run_cgsr({command, "--help"});
    EXPECT_EQ(help.exit_code, 0) << command;
    EXPECT_THAT(help.output, HasSubstr("--config")) << command;
  }
}

// Another program answers, as if it were this one.
TEST(CommandLine, SimHandsOver) {
  const auto help = run_cgsr({"sim", "--help"});
  EXPECT_EQ(help.exit_code, 0) << help.errors;
  EXPECT_THAT(help.output, HasSubstr("render"));
  const auto info = run_cgsr({"sim", "info", "--world", "planar"});
  EXPECT_EQ(info.exit_code, 0) << info.errors;
  EXPECT_THAT(info.output, HasSubstr("planar: a map of 169 surfaces and 456 edges"));
  const auto refused = run_cgsr({"sim", "info", "--world", "palace"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.errors, HasSubstr("there is no world 'palace'; there are"));
}

TEST(CommandLine, LearnWritesAModelAndAPicture) {
  const ScratchFolder scratch;
  const auto region = make_images(scratch / "images", 1);
  const auto learned =
      run_cgsr({"learn", "--input", scratch / "images", "--region", region, "--output", scratch / "m"});
  ASSERT_EQ(learned.exit_code, 0) << learned.errors;
  EXPECT_THAT(learned.output, HasSubstr("distinctiveness"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "m"));
  EXPECT_FALSE(cv::imread(scratch / "m.png").empty());
}

TEST(CommandLine, LearnTakesSeveralViews) {
  const ScratchFolder scratch;
  make_images(scratch / "images", 5);
  const auto learned = run_cgsr({"learn", "--input", scratch / "images", "--region", "40,80,60,80", "--at", "0",
                                 "--region", "48,80,60,80", "--at", "4", "--output", scratch / "m"});
  EXPECT_EQ(learned.exit_code, 0) << learned.errors;
}

TEST(CommandLine, TrackWritesTheColumnsOfTheDesignAndFindsTheObject) {
  const ScratchFolder scratch;
  const auto region = make_images(scratch / "images", 20);
  std::string truth;
  for (int i = 0; i < 20; ++i) truth += std::to_string(40 + 2 * i) + ",80,60,80\n";
  write_text(scratch / "truth.txt", truth);
  const auto tracked =
      run_cgsr({"track", "--input", scratch / "images", "--learn", region, "--truth", scratch / "truth.txt", "--csv",
                scratch / "t.csv", "--json", scratch / "t.json", "--video", scratch / "t.avi"});
  ASSERT_EQ(tracked.exit_code, 0) << tracked.errors;

  const auto rows = lines_of(read_text(scratch / "t.csv"));
  ASSERT_EQ(rows.size(), 21u);
  EXPECT_EQ(rows[0], "frame,found,x,y,width,height,divergence,light_r,light_g,light_b,confidence");
  EXPECT_THAT(rows[1], StartsWith("0,1,40.00,80.00,60.00,80.00,"));
  EXPECT_THAT(rows[20], StartsWith("19,1,"));

  const auto json = nlohmann::json::parse(read_text(scratch / "t.json"));
  EXPECT_EQ(json["images"], 19);
  EXPECT_TRUE(json["losses"].empty());
  EXPECT_TRUE(json["reacquisitions"].empty());
  EXPECT_EQ(json["truth"]["images"], 19);
  EXPECT_GT(json["truth"]["iou"].get<double>(), 0.7);
  EXPECT_EQ(json["config_sha256"].get<std::string>().size(), 64u);

  cv::VideoCapture video(scratch / "t.avi");
  EXPECT_EQ(static_cast<int>(video.get(cv::CAP_PROP_FRAME_COUNT)), 20);
}

TEST(CommandLine, TrackNamesTheImagesOfLossAndReacquisition) {
  const ScratchFolder scratch;
  const auto region = make_images(scratch / "images", 40);
  for (int i = 15; i < 28; ++i) {  // the object is gone
    const auto path = scratch / fmt::format("images/{:04}.png", i);
    ASSERT_TRUE(std::filesystem::exists(path)) << path;
    cv::Mat image = cv::imread(path);
    image.setTo(cv::Scalar(90, 110, 100));
    cv::imwrite(path, image);
  }
  const auto tracked =
      run_cgsr({"track", "--input", scratch / "images", "--learn", region, "--json", scratch / "t.json"});
  ASSERT_EQ(tracked.exit_code, 0) << tracked.errors;
  const auto json = nlohmann::json::parse(read_text(scratch / "t.json"));
  ASSERT_EQ(json["losses"].size(), 1u);
  ASSERT_EQ(json["reacquisitions"].size(), 1u);
  EXPECT_NEAR(json["losses"][0].get<int>(), 17, 4);
  EXPECT_NEAR(json["reacquisitions"][0].get<int>(), 28, 4);
  EXPECT_THAT(tracked.output, HasSubstr(fmt::format("lost at image {}", json["losses"][0].get<int>())));
  EXPECT_THAT(tracked.output, HasSubstr(fmt::format("found again at image {}", json["reacquisitions"][0].get<int>())));
}

TEST(CommandLine, ABoxThatIsPartlyOutsideIsCutOrRefused) {
  const ScratchFolder scratch;
  make_images(scratch / "images", 3);
  const auto cut =
      run_cgsr({"track", "--input", scratch / "images", "--learn=-10,80,110,80", "--csv", scratch / "t.csv"});
  ASSERT_EQ(cut.exit_code, 0) << cut.errors;
  EXPECT_THAT(cut.errors, AllOf(HasSubstr("the box -10,80,110,80 reaches beyond the image"), HasSubstr("0,80,100,80")));
  EXPECT_THAT(lines_of(read_text(scratch / "t.csv"))[1], StartsWith("0,1,0.00,80.00,100.00,80.00,"));
  const auto refused = run_cgsr({"track", "--input", scratch / "images", "--learn=-60,80,100,80"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.errors, HasSubstr("more than half of the box -60,80,100,80 lies outside the image"));
}

TEST(CommandLine, TrackLearnsFromALaterImage) {
  const ScratchFolder scratch;
  make_images(scratch / "images", 12);
  const auto tracked = run_cgsr({"track", "--input", scratch / "images", "--learn", "60,80,60,80", "--learn-frame",
                                 "10", "--csv", scratch / "t.csv"});
  ASSERT_EQ(tracked.exit_code, 0) << tracked.errors;
  const auto rows = lines_of(read_text(scratch / "t.csv"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_THAT(rows[1], StartsWith("10,1,60.00,"));
}

TEST(CommandLine, TrackUsesASavedModelAsWellAsAFreshOne) {
  const ScratchFolder scratch;
  const auto region = make_images(scratch / "images", 8);
  ASSERT_EQ(run_cgsr({"learn", "--input", scratch / "images", "--region", region, "--output", scratch / "m"}).exit_code,
            0);
  ASSERT_EQ(run_cgsr({"track", "--input", scratch / "images", "--model", scratch / "m", "--csv", scratch / "t.csv"})
                .exit_code,
            0);
  const auto rows = lines_of(read_text(scratch / "t.csv"));
  ASSERT_EQ(rows.size(), 9u);
  EXPECT_THAT(rows[8], StartsWith("7,1,"));
}

TEST(CommandLine, PlainModeHasAConfigurationOfItsOwn) {
  const ScratchFolder scratch;
  const auto region = make_images(scratch / "images", 3);
  const auto hash_of = [&](const char* mode) {
    EXPECT_EQ(
        run_cgsr({"track", "--input", scratch / "images", "--learn", region, "--mode", mode, "--json", scratch / "j"})
            .exit_code,
        0);
    return nlohmann::json::parse(read_text(scratch / "j"))["config_sha256"].get<std::string>();
  };
  EXPECT_NE(hash_of("plain"), hash_of("full"));
}

TEST(CommandLine, ConfigWritesShowsComparesAndExplains) {
  const ScratchFolder scratch;
  const std::string file = scratch / "robot.toml";
  ASSERT_EQ(run_cgsr({"config", "new", "--recording", "--output", file}).exit_code, 0);
  const auto shown = run_cgsr({"config", "show", file});
  EXPECT_EQ(shown.exit_code, 0) << shown.errors;
  EXPECT_THAT(shown.output,
              AllOf(HasSubstr("\"recording.mp4\""), HasSubstr("# " + file + ":4"), HasSubstr("# default")));
  const auto differences = run_cgsr({"config", "diff", file});
  EXPECT_EQ(differences.exit_code, 0) << differences.errors;
  EXPECT_THAT(differences.output, AllOf(HasSubstr("run.learn.width_px = 80 ("), HasSubstr(", 0 (default)")));
  EXPECT_THAT(run_cgsr({"config", "diff", file, file}).output, StartsWith("0 of "));
  EXPECT_THAT(run_cgsr({"config", "keys", "goal_timeout"}).output, StartsWith("motion.goal_timeout_s = 0.15 s"));

  EXPECT_NE(run_cgsr({"config", "new"}).exit_code, 0) << "neither a webcam nor a recording";
  EXPECT_THAT(run_cgsr({"config", "keys", "colour"}).errors, HasSubstr("no key contains 'colour'"));
  write_text(file, "[motion]\nforward_limit_mps = 1\n");
  EXPECT_THAT(run_cgsr({"config", "show", file}).errors,
              HasSubstr("robot.toml:2: motion.forward_limit_mps is unknown; it is called max_forward_mps now"));
}

TEST(CommandLine, CheckLooksAtEverythingAndMovesNothing) {
  const ScratchFolder scratch;
  const auto region = make_images(scratch / "images", 2);
  ASSERT_EQ(run_cgsr({"learn", "--input", scratch / "images", "--region", region, "--output", scratch / "m"}).exit_code,
            0);
  const auto good = run_cgsr({"check", "--config", CGSR_SOURCE_DIR "/config/robots/video.toml", "--input",
                              scratch / "images", "--model", scratch / "m"});
  EXPECT_EQ(good.exit_code, 0) << good.errors;
  const auto bad = run_cgsr({"check", "--config", CGSR_SOURCE_DIR "/config/robots/video.toml", "--input",
                             scratch / "none", "--model", scratch / "none"});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_EQ(lines_of(bad.errors).size(), 2u) << bad.errors;
}

}  // namespace
}  // namespace cgsr::app::testing
