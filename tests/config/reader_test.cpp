#include "platform/config/reader.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/config/sample.h"
#include "tests/support/scratch_folder.h"

namespace cgsr::config {
namespace {

using testing::HasSubstr;

Result<Sample> read_sample(std::string_view toml) {
  const auto document = Document::parse(toml, "robot.toml");
  if (!document) return tl::unexpected(document.error());
  return read<Sample>(*document);
}

std::string problems(std::string_view toml) {
  const auto sample = read_sample(toml);
  return sample ? "" : sample.error().message;
}

TEST(Reader, ReadsEveryKind) {
  const auto sample = read_sample(kWholeSample);
  ASSERT_TRUE(sample) << sample.error().message;
  EXPECT_EQ(sample->name, "lab");
  EXPECT_TRUE(sample->armed);
  EXPECT_EQ(sample->area.from_m, -2.0) << "a whole number is a number too";
  EXPECT_EQ(sample->area.to_m, 2.5);
  EXPECT_EQ(sample->stage.decode.on_overrun, Overrun::kStopMotion);
  EXPECT_EQ(sample->stage.track.every_frames, 2);
  EXPECT_EQ(sample->stage.track.budget_us, 7000);
}

TEST(Reader, LeavesDefaultsWhereAFileIsSilent) {
  const auto sample = read_sample("[stage.track]\nbudget_us = 500\n");
  ASSERT_TRUE(sample) << sample.error().message;
  EXPECT_EQ(sample->stage.track.budget_us, 500);
  EXPECT_EQ(sample->stage.track.every_frames, 1);
  EXPECT_EQ(sample->stage.decode.budget_us, 7000);
  EXPECT_EQ(sample->name, "home");
}

TEST(Reader, RefusesAValueOutOfRange) {
  EXPECT_EQ(problems("\n[stage.track]\nbudget_us = 90000\n"),
            "robot.toml:3: stage.track.budget_us = 90000 is not in 100..33000 µs");
  EXPECT_EQ(problems("[stage.track]\nbudget_us = 99\n"),
            "robot.toml:2: stage.track.budget_us = 99 is not in 100..33000 µs");
  EXPECT_EQ(problems("[stage.track]\nbudget_us = 100\n"), "") << "the range is closed";
  EXPECT_EQ(problems("[stage.track]\nbudget_us = 33000\n"), "");
  EXPECT_EQ(problems("[stage.track]\nevery_frames = 4294967297\n"),
            "robot.toml:2: stage.track.every_frames = 4294967297 is not in 1..30")
      << "must not wrap to 1";
  EXPECT_EQ(problems("[area]\nto_m = 10.25\n"), "robot.toml:2: area.to_m = 10.25 is not in -10..10 m");
}

TEST(Reader, RefusesWhatIsNotFinite) {
  EXPECT_EQ(problems("[area]\nto_m = nan\n"), "robot.toml:2: area.to_m = nan is not in -10..10 m");
  EXPECT_EQ(problems("[area]\nto_m = inf\n"), "robot.toml:2: area.to_m = inf is not in -10..10 m");
  EXPECT_EQ(problems("[area]\nfrom_m = -inf\n"), "robot.toml:2: area.from_m = -inf is not in -10..10 m");
}

TEST(Reader, RefusesTheWrongType) {
  EXPECT_EQ(problems("[stage.track]\nbudget_us = \"fast\"\n"),
            "robot.toml:2: stage.track.budget_us is \"fast\", a text; expected a whole number");
  EXPECT_EQ(problems("[stage.track]\nbudget_us = 700.5\n"),
            "robot.toml:2: stage.track.budget_us is 700.5, a number with a point; expected a whole number");
  EXPECT_NE(problems("[stage.track]\nbudget_us = 700.0\n"), "") << "whole, but not written so";
  EXPECT_NE(problems("[stage.track]\nevery_frames = true\n"), "");
  EXPECT_EQ(problems("[area]\nto_m = true\n"), "robot.toml:2: area.to_m is true, true or false; expected a number");
  EXPECT_EQ(problems("armed = 1\n"), "robot.toml:1: armed is 1, a whole number; expected true or false");
  EXPECT_EQ(problems("name = [1, 2]\n"), "robot.toml:1: name is a list; expected a text");
  EXPECT_EQ(problems("name = 2026-11-21\n"), "robot.toml:1: name is 2026-11-21, a date or time; expected a text");
  EXPECT_EQ(problems("[name]\n"), "robot.toml:1: name is a section; expected a text");
  EXPECT_EQ(problems("stage = 3\n"), "robot.toml:1: stage is 3, a whole number; expected a section [stage]");
  EXPECT_EQ(problems("[[stage]]\n"), "robot.toml:1: stage is a list; expected a section [stage]");
}

TEST(Reader, ListsTheWordsOfAChoice) {
  EXPECT_EQ(
      problems("[stage.track]\non_overrun = \"stop_motoin\"\n"),
      "robot.toml:2: stage.track.on_overrun = \"stop_motoin\" is not one of \"skip\", \"stop_motion\"; did you mean "
      "\"stop_motion\"?");
  EXPECT_EQ(problems("[stage.track]\non_overrun = \"explode\"\n"),
            "robot.toml:2: stage.track.on_overrun = \"explode\" is not one of \"skip\", \"stop_motion\"");
  EXPECT_EQ(problems("[stage.track]\non_overrun = 1\n"),
            "robot.toml:2: stage.track.on_overrun is 1, a whole number; expected one of \"skip\", \"stop_motion\"");
}

TEST(Reader, NamesTheNearestKnownKey) {
  EXPECT_EQ(problems("[stage.track]\nbudgt_us = 1\n"),
            "robot.toml:2: stage.track.budgt_us is unknown; did you mean budget_us?");
  EXPECT_EQ(problems("[stage.trakc]\n"), "robot.toml:1: stage.trakc is unknown; did you mean track?");
  EXPECT_EQ(problems("colour = 1\n"), "robot.toml:1: colour is unknown; known: name, armed, area, stage");
}

struct Limits {
  double max_forward_mps = 1.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("max_forward_mps", self.max_forward_mps, {0.0, 1.5}, "m/s", "The largest forward speed.");
  }
};

// Follow, route and lamp had limits of their own.
TEST(Reader, NamesTheSectionThatAKeyHasMovedTo) {
  const auto document = Document::parse("max_turn_radps = 0.3\n", "robot.toml");
  ASSERT_TRUE(document);
  const auto limits = read<Limits>(*document);
  ASSERT_FALSE(limits);
  EXPECT_THAT(limits.error().message,
              testing::HasSubstr("robot.toml:1: max_turn_radps is unknown; it is called motion.max_turn_radps now"));
}

TEST(Reader, NamesTheWeightThatTookAThresholdsPlace) {
  const auto document = Document::parse("min_stay_sharpness = 8.0\n", "robot.toml");
  ASSERT_TRUE(document);
  const auto limits = read<Limits>(*document);
  ASSERT_FALSE(limits);
  EXPECT_THAT(limits.error().message,
              testing::HasSubstr("robot.toml:1: min_stay_sharpness is unknown; it is called "
                                 "color.track.presence.sharpness_weight now; the evidence is weighed as a whole"));
}

// The section decides which of two new names an old one has now.
TEST(Reader, NamesThePresentNameOfAKeyThatWasRenamed) {
  const auto document = Document::parse("forward_limit_mps = 0.3\nlowest = 1\n", "robot.toml");
  ASSERT_TRUE(document);
  const auto limits = read<Limits>(*document);
  ASSERT_FALSE(limits);
  EXPECT_EQ(limits.error().message,
            "robot.toml:1: forward_limit_mps is unknown; it is called max_forward_mps now\n"
            "robot.toml:2: lowest is unknown; known: max_forward_mps");
}

TEST(Reader, EscapesWhatATerminalMustNotGet) {
  EXPECT_EQ(problems("\"\\u001b[31m\" = 1\n"),
            "robot.toml:1: \"\\u001B[31m\" is unknown; known: name, armed, area, stage");
  EXPECT_THAT(problems("armed = \"\\u001b[31m\"\n"), HasSubstr("armed is \"\\u001B[31m\", a text"));
  EXPECT_LT(problems("armed = \"" + std::string(5000, 'x') + "\"\n").size(), 200u);
}

TEST(Reader, AsksWhetherTheKeysOfASectionAgree) {
  EXPECT_EQ(problems("\n[area]\nfrom_m = 3\nto_m = 2\n"), "robot.toml:2: [area] from_m must be below to_m");
  EXPECT_EQ(problems("\n[area]\nfrom_m = 30\nto_m = 2\n"), "robot.toml:3: area.from_m = 30 is not in -10..10 m")
      << "only keys that are good by themselves are compared";
}

TEST(Reader, ReportsEverythingAtOnceInTheOrderOfTheFile) {
  EXPECT_EQ(
      problems(R"(armed = "yes"
nam = "x"

[stage.track]
on_overrun = "skp"
budget_us = 90000
[stage.decode]
every_frames = 0
[area]
from_m = inf
)"),
      "robot.toml:1: armed is \"yes\", a text; expected true or false\n"
      "robot.toml:2: nam is unknown; did you mean name?\n"
      "robot.toml:5: stage.track.on_overrun = \"skp\" is not one of \"skip\", \"stop_motion\"; did you mean \"skip\"?\n"
      "robot.toml:6: stage.track.budget_us = 90000 is not in 100..33000 µs\n"
      "robot.toml:8: stage.decode.every_frames = 0 is not in 1..30\n"
      "robot.toml:10: area.from_m = inf is not in -10..10 m");
}

TEST(WordIn, IsTheTablesWordOrEmptyWhereItHasNone) {
  EXPECT_EQ(word_in(kOverrunWords, Overrun::kSkip), "skip");
  EXPECT_EQ(word_in(kOverrunWords, Overrun::kStopMotion), "stop_motion");
  EXPECT_EQ(word_in(std::array{kOverrunWords[0]}, Overrun::kStopMotion), "");
}

TEST(Reader, ReadsAFile) {
  const test::ScratchFolder scratch;
  const auto file = scratch / "reader_test.toml";
  std::ofstream(file) << kWholeSample;
  const auto sample = read_file<Sample>(file);
  ASSERT_TRUE(sample) << sample.error().message;
  EXPECT_EQ(sample->name, "lab");
  std::filesystem::remove(file);

  const auto gone = read_file<Sample>(file);
  ASSERT_FALSE(gone);
  EXPECT_THAT(gone.error().message, HasSubstr("No such file"));
}

}  // namespace
}  // namespace cgsr::config
