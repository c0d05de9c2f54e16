#include "platform/config/canonical.h"

#include <string>

#include <gtest/gtest.h>

#include "platform/config/reader.h"
#include "tests/config/sample.h"

namespace cgsr::config {
namespace {

std::string hash_of(std::string_view toml) {
  const auto document = Document::parse(toml, "robot.toml");
  if (!document) return document.error().message;
  const auto sample = read<Sample>(*document);
  return sample ? hash(*sample) : sample.error().message;
}

TEST(Canonical, WritesEveryValueSortedByItsPath) {
  EXPECT_EQ(canonical(Sample()),
            "area.from_m = -1\n"
            "area.to_m = 1\n"
            "armed = false\n"
            "name = \"home\"\n"
            "stage.decode.budget_us = 7000\n"
            "stage.decode.every_frames = 1\n"
            "stage.decode.on_overrun = \"skip\"\n"
            "stage.track.budget_us = 7000\n"
            "stage.track.every_frames = 1\n"
            "stage.track.on_overrun = \"skip\"\n");
}

TEST(Canonical, HashIsTheSameForFilesThatMeanTheSame) {
  const std::string all_defaults = hash_of("");
  EXPECT_EQ(all_defaults.size(), 64u);
  EXPECT_EQ(hash_of("# a comment\n\n"), all_defaults);
  EXPECT_EQ(hash_of("name = \"home\" # the default, said\n"), all_defaults);
  EXPECT_EQ(hash_of("[area]\nto_m = 1\nfrom_m = -1.0\n"), all_defaults);
  EXPECT_EQ(hash_of("stage.track.budget_us = 7_000\n"), all_defaults);
  EXPECT_EQ(hash_of("stage = {track = {budget_us = 0x1b58}}\n"), all_defaults);
  EXPECT_EQ(hash_of("name = \"a\"\narmed = true\n"), hash_of("armed = true\nname = 'a'\n"));
  EXPECT_EQ(hash_of("area.from_m = -0.0\n"), hash_of("area.from_m = 0\n"));
}

TEST(Canonical, HashChangesWithEveryKind) {
  const std::string all_defaults = hash_of("");
  for (const char* toml : {"name = \"a\"\n", "armed = true\n", "[area]\nto_m = 1.0000000000000002\n",
                           "[stage.track]\nbudget_us = 7001\n", "[stage.track]\non_overrun = \"stop_motion\"\n"}) {
    EXPECT_EQ(hash_of(toml).size(), 64u) << hash_of(toml);
    EXPECT_NE(hash_of(toml), all_defaults) << toml;
  }
}

TEST(Sha256, KnowsTheVectorsOfTheStandard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, AddsPieces) {
  Sha256 sum;
  sum.add("a", 1);
  sum.add("bc", 2);
  EXPECT_EQ(sum.hex(), sha256("abc"));
}

}  // namespace
}  // namespace cgsr::config
