#include "platform/box.h"

#include <gtest/gtest.h>

namespace cgsr {
namespace {

TEST(Box, ItsIntersectionOverUnionIsTheShareOfBoth) {
  constexpr Box kFirst{10.0, 20.0, 4.0, 6.0};
  EXPECT_DOUBLE_EQ(intersection_over_union(kFirst, kFirst), 1.0);
  EXPECT_DOUBLE_EQ(intersection_over_union(kFirst, {12.0, 20.0, 4.0, 6.0}), 12.0 / 36.0);
  EXPECT_DOUBLE_EQ(intersection_over_union(kFirst, {11.0, 21.0, 2.0, 3.0}), 6.0 / 24.0);
}

TEST(Box, ItsIntersectionOverUnionIsZeroWithoutACommonPart) {
  constexpr Box kFirst{10.0, 20.0, 4.0, 6.0};
  EXPECT_EQ(intersection_over_union(kFirst, {14.0, 20.0, 4.0, 6.0}), 0.0);
  EXPECT_EQ(intersection_over_union(kFirst, {100.0, 100.0, 4.0, 6.0}), 0.0);
  EXPECT_EQ(intersection_over_union(kFirst, {}), 0.0);
  EXPECT_EQ(intersection_over_union({}, {}), 0.0);
}

}  // namespace
}  // namespace cgsr
