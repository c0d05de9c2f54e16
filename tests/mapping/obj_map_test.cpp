#include "pipeline/mapping/obj_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cgsr::mapping {
namespace {

using ::testing::HasSubstr;

constexpr const char* kText =
    "# by hand\nmtllib home.mtl\no table/top\nusemtl wood\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\nf 1//1 2//1 3//1 4//1\n"
    "o leg\nv 0 0 0\nf -1 1 2\n";

TEST(ObjMap, ReadsPointsFacesAndParts) {
  const auto map = parse_obj(kText, "table.obj");
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->points.size(), 5U);
  EXPECT_EQ(map->points[2], Eigen::Vector3d(2, 1, 1));
  ASSERT_EQ(map->faces.size(), 2U);
  EXPECT_THAT(map->faces[0].corners, ::testing::ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(map->faces[1].corners, ::testing::ElementsAre(4, 0, 1));
  EXPECT_EQ(map->parts[map->faces[1].part], "leg");
}

TEST(ObjMap, WritesEveryOtherLineAsItWas) {
  const auto map = parse_obj(kText, "table.obj");
  ASSERT_TRUE(map);
  EXPECT_EQ(obj_text(*map, map->points, {}), kText);
  auto points = map->points;
  points[1].x() = 2.0123456;
  std::string expected = kText;
  expected.replace(expected.find("v 2 0 1"), 7, "v 2.01235 0.00000 1.00000");
  EXPECT_EQ(obj_text(*map, points, {}), expected);
  EXPECT_THAT(obj_text(*map, points, "../maps"), HasSubstr("mtllib ../maps/home.mtl\n"));
}

struct Wrong {
  const char* text;
  const char* message;
};

class WrongObj : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongObj, IsRefusedWithLineValueAndWhatWasExpected) {
  const auto map = parse_obj(GetParam().text, "m.obj");
  ASSERT_FALSE(map);
  EXPECT_THAT(map.error().message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongObj,
    ::testing::Values(Wrong{"", "m.obj: holds no face"}, Wrong{"v 0 0\n", "m.obj:1: has 2 coordinates: expected three"},
                      Wrong{"# a\nv 0 x 0\n", "m.obj:2: a coordinate is 'x': expected a finite"},
                      Wrong{"v 0 nan 0\n", "m.obj:1: a coordinate is 'nan'"},
                      Wrong{"v 0 0 0\nf 1 1\n", "m.obj:2: has 2 corners"},
                      Wrong{"v 0 0 0\nf 1 1 2\n", "m.obj:2: a corner is '2': expected one of the 1"},
                      Wrong{"v 0 0 0\nf 1 0 1\n", "m.obj:2: a corner is '0'"}));

}  // namespace
}  // namespace cgsr::mapping
