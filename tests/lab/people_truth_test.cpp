#include "tools/lab/people_truth.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tools/lab/people_script.h"
#include "tools/lab/person_cast.h"

namespace cgsr::lab {
namespace {

// One who turns away after three seconds, and one who comes to stand before him after five.
TEST(PeopleTruth, KnowsWhoIsHiddenAndWhoShowsHisFace) {
  const TableFolder folder("people-truth-test");
  const auto arena = empty_arena();
  ASSERT_TRUE(arena) << arena.error().message;
  Figure behind{.identity = 20, .height_m = 1.6, .shirt = {0.1, 0.2, 0.8}, .x_m = 3.0, .turns_s = 3.0};
  Figure before{.identity = 30, .height_m = 1.85, .shirt = {0.8, 0.2, 0.1}, .x_m = 1.9, .from_s = 5.0};
  const auto file = folder / "world.toml";
  std::ofstream(file) << *arena << text_of(behind, "behind") << text_of(before, "before");
  auto truth = PeopleTruth::of(file);
  ASSERT_TRUE(truth) << truth.error().message;

  const auto first = truth->at(1.0);
  ASSERT_EQ(first.size(), 2U);
  EXPECT_GT(first[0].shirt, 0.9);
  EXPECT_GT(first[0].face, 0.9);
  EXPECT_TRUE(first[0].frontal);
  EXPECT_FALSE(first[1].is_visible()) << "not there yet";

  const auto turned = truth->at(4.9);
  EXPECT_FALSE(turned[0].frontal);
  EXPECT_TRUE(turned[0].is_visible());
  EXPECT_TRUE(turned[0].is_identifiable()) << "by the shirt";

  const auto hidden = truth->at(6.0);
  EXPECT_FALSE(hidden[0].is_visible()) << hidden[0].shirt << ' ' << hidden[0].face;
  EXPECT_TRUE(hidden[1].is_identifiable());
  EXPECT_TRUE(hidden[1].frontal);
}

TEST(PeopleTruth, SaysWhatIsWrongWithAWorld) {
  const TableFolder folder("people-truth-test");
  EXPECT_FALSE(PeopleTruth::of(folder / "none.toml"));
}

}  // namespace
}  // namespace cgsr::lab
