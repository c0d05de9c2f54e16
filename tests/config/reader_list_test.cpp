// Lists of numbers and of sections, as world files have them.

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "platform/config/reader.h"

namespace cgsr::config {
namespace {

struct Lamp {
  int line = 0;
  std::array<double, 3> position_m{};
  double lumens = 800.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.line(self.line);
    visit.numbers("position_m", self.position_m, Range{-10.0, 10.0}, "m", "centre");
    visit.number("lumens", self.lumens, {0.0, 10000.0}, "lm", "how bright");
  }
  [[nodiscard]] std::string inconsistency() const { return position_m[2] > 0.0 ? "" : "the lamp lies in the floor"; }
};

struct World {
  std::vector<Lamp> lamp;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.list("lamp", self.lamp, "Lamps");
  }
};

Result<World> read_world(std::string_view toml) {
  const auto document = Document::parse(toml, "world.toml");
  if (!document) return tl::unexpected(document.error());
  return read<World>(*document);
}

std::string problems(std::string_view toml) {
  const auto world = read_world(toml);
  return world ? "" : world.error().message;
}

TEST(ReaderList, ReadsEverySectionInOrder) {
  const auto world = read_world("[[lamp]]\nposition_m = [1, 2.5, 2]\n\n[[lamp]]\nposition_m = [0, 0, 1]\nlumens = 5\n");
  ASSERT_TRUE(world) << world.error().message;
  ASSERT_EQ(world->lamp.size(), 2u);
  EXPECT_EQ(world->lamp[0].position_m, (std::array{1.0, 2.5, 2.0}));
  EXPECT_EQ(world->lamp[0].lumens, 800.0);
  EXPECT_EQ(world->lamp[1].lumens, 5.0);
  EXPECT_EQ(world->lamp[1].line, 4);
}

TEST(ReaderList, TakesInlineSectionsAndNoneAtAll) {
  const auto world = read_world("lamp = [{position_m = [1, 2, 3]}]\n");
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_EQ(world->lamp.size(), 1u);
  EXPECT_EQ(problems(""), "");
  EXPECT_EQ(problems("lamp = []\n"), "");
}

TEST(ReaderList, NamesTheItemThatIsWrong) {
  EXPECT_EQ(problems("[[lamp]]\nposition_m = [0, 0, 1]\n[[lamp]]\nposition_m = [0, 11, 1]\nlumen = 3\n"),
            "world.toml:4: lamp[1].position_m[1] = 11 is not in -10..10 m\n"
            "world.toml:5: lamp[1].lumen is unknown; did you mean lumens?");
  EXPECT_EQ(problems("[[lamp]]\nposition_m = [0, 1]\n"),
            "world.toml:2: lamp[0].position_m is a list; expected a list of 3 numbers");
  EXPECT_EQ(problems("[[lamp]]\nposition_m = [0, nan, 1]\n"),
            "world.toml:2: lamp[0].position_m[1] = nan is not in -10..10 m");
  EXPECT_EQ(problems("[[lamp]]\nposition_m = [0, true, 1]\n"),
            "world.toml:2: lamp[0].position_m[1] is true, true or false; expected a number");
  EXPECT_EQ(problems("lamp = [1]\n"), "world.toml:1: lamp[0] is 1, a whole number; expected a section");
  EXPECT_EQ(problems("[[lamp]]\n"), "world.toml:1: [lamp[0]] the lamp lies in the floor");
}

TEST(ReaderList, RefusesASectionWhereAListIsWanted) {
  EXPECT_NE(problems("lamp = 3\n"), "");
  EXPECT_NE(problems("[lamp]\nlumens = 3\n"), "");
}

}  // namespace
}  // namespace cgsr::config
