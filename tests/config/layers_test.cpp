// Files that extend others.

#include "platform/config/layers.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/config/canonical.h"
#include "platform/config/reader.h"
#include "tests/config/sample.h"
#include "tests/support/scratch_folder.h"

namespace cgsr::config {
namespace {

using testing::HasSubstr;

struct Files {
  std::string picture = "none.png";
  Sample sample;
  Provenance provenance;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.path("picture", self.picture, "The picture.");
    visit.section("sample", self.sample, "One of everything");
  }
};

class LayersTest : public testing::Test {
 protected:
  LayersTest() { std::filesystem::create_directories(folder_ / "base"); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  static Result<Files> load(const std::string& file) {
    auto layers = Layers::load(file);
    if (!layers) return tl::unexpected(layers.error());
    Reader reader(*layers);
    Files files;
    if (auto outcome = reader.read(files); !outcome) return tl::unexpected(outcome.error());
    files.provenance = reader.provenance();
    return files;
  }
  static std::string problems(const std::string& file) {
    const auto files = load(file);
    return files ? "" : files.error().message;
  }

  test::ScratchFolder folder_;
};

TEST_F(LayersTest, TheFirstFileThatNamesAKeyCounts) {
  write("base/base.toml", "[sample]\nname = \"base\"\n[sample.area]\nfrom_m = -5\nto_m = 5\n");
  write("robot.toml", "extends = \"base/base.toml\"\n[sample.area]\nto_m = 3\n");
  const auto files = load(file("robot.toml"));
  ASSERT_TRUE(files) << files.error().message;
  EXPECT_EQ(files->sample.name, "base");
  EXPECT_EQ(files->sample.area.from_m, -5.0);
  EXPECT_EQ(files->sample.area.to_m, 3.0);
  EXPECT_FALSE(files->sample.armed);
  const auto& origins = files->provenance.origins;
  EXPECT_EQ(origins.at("sample.area.to_m").file, file("robot.toml"));
  EXPECT_EQ(origins.at("sample.area.to_m").line, 3);
  EXPECT_EQ(origins.at("sample.area.from_m").file, file("base/base.toml"));
  EXPECT_EQ(origins.at("sample.area.from_m").line, 4);
  EXPECT_EQ(origins.count("sample.armed"), 0u);
}

TEST_F(LayersTest, EveryProblemOfEveryFileAtOnceEachWithItsFile) {
  write("base/base.toml", "[sample]\narmed = 1\n[sample.stage.track]\nbudget_us = 90000\n");
  write("robot.toml", "extends = \"base/base.toml\"\n[sample]\nnmae = \"a\"\n[sample.stage.track]\nbudget_us = 500\n");
  EXPECT_EQ(problems(file("robot.toml")),
            file("robot.toml") + ":3: sample.nmae is unknown; did you mean name?\n" + file("base/base.toml") +
                ":2: sample.armed is 1, a whole number; expected true or false\n" + file("base/base.toml") +
                ":4: sample.stage.track.budget_us = 90000 is not in 100..33000 µs")
      << "a value that another file replaces must be good too";
}

TEST_F(LayersTest, SectionsAreJudgedByWhatTheFilesSayTogether) {
  write("base/base.toml", "[sample.area]\nfrom_m = 2\nto_m = 4\n");
  write("robot.toml", "extends = \"base/base.toml\"\n\n[sample.area]\nto_m = 1\n");
  EXPECT_EQ(problems(file("robot.toml")), file("robot.toml") + ":3: [sample.area] from_m must be below to_m");
}

TEST_F(LayersTest, APathIsRelativeToTheFileThatNamesIt) {
  write("base/base.toml", "picture = \"a.png\"\n");
  write("robot.toml", "extends = \"base/base.toml\"\n");
  const auto files = load(file("robot.toml"));
  ASSERT_TRUE(files) << files.error().message;
  EXPECT_EQ(files->picture, file("base/a.png"));
  EXPECT_THAT(canonical(*files), HasSubstr("picture = \"base/a.png\"\n"));
}

// The same files elsewhere are the same configuration; a path that means another file is another one.
TEST_F(LayersTest, TheHashDoesNotDependOnThePlaceOfTheFiles) {
  for (const char* const place : {"here", "there/and/deeper"}) {
    std::filesystem::create_directories(folder_ / place / "base");
    write(std::string(place) + "/base/base.toml", "picture = \"../a.png\"\n");
    write(std::string(place) + "/robot.toml", "extends = \"base/base.toml\"\n");
  }
  write("here/other.toml", "picture = \"b.png\"\n");
  write("here/same.toml", "picture = \"./a.png\"\n");
  const std::string here = hash(*load(file("here/robot.toml")));
  EXPECT_EQ(hash(*load(file("there/and/deeper/robot.toml"))), here);
  EXPECT_EQ(hash(*load(file("here/same.toml"))), here);
  EXPECT_NE(hash(*load(file("here/other.toml"))), here);
}

TEST_F(LayersTest, RefusesCyclesWithTheWayRound) {
  write("a.toml", "# first\nextends = \"base/b.toml\"\n");
  write("base/b.toml", "extends = \"../c.toml\"\n");
  write("c.toml", "extends = \"base/../base/b.toml\"\n");
  EXPECT_EQ(problems(file("a.toml")),
            file("c.toml") + ":1: extends = \"base/../base/b.toml\": the files extend each other in a cycle: " +
                file("base/b.toml") + " -> " + file("c.toml") + " -> " + file("base/b.toml"));
  write("self.toml", "extends = \"self.toml\"\n");
  EXPECT_THAT(problems(file("self.toml")),
              HasSubstr("self.toml:1: extends = \"self.toml\": the files extend each other"));
}

TEST_F(LayersTest, SaysWhatCannotBeExtendedAndWhoAsks) {
  write("robot.toml", "\nextends = \"none.toml\"\n");
  EXPECT_EQ(problems(file("robot.toml")), file("none.toml") + ": cannot be opened: No such file or directory\n" +
                                              file("robot.toml") + ":2: extends = \"none.toml\"");
  write("none.toml", "a = = 1\n");
  EXPECT_THAT(problems(file("robot.toml")), HasSubstr("none.toml:1: is not TOML: "));
  write("robot.toml", "extends = 3\n");
  EXPECT_EQ(problems(file("robot.toml")),
            file("robot.toml") + ":1: extends = 3: expected the name of a file, as a text");
  write("robot.toml", "extends = \"\"\n");
  EXPECT_NE(problems(file("robot.toml")), "");
}

TEST_F(LayersTest, RefusesChainsWithoutEnd) {
  for (int i = 0; i < 40; ++i) write(std::to_string(i) + ".toml", "extends = \"" + std::to_string(i + 1) + ".toml\"\n");
  EXPECT_THAT(problems(file("0.toml")), HasSubstr("more than 16 files extend each other"));
}

TEST_F(LayersTest, AFileThatStandsAloneExtendsNothing) {
  write("world.toml", "extends = \"base/base.toml\"\n");
  const auto files = read_file<Files>(file("world.toml"));
  ASSERT_FALSE(files);
  EXPECT_THAT(files.error().message, HasSubstr("world.toml:1: extends is unknown"));
}

}  // namespace
}  // namespace cgsr::config
