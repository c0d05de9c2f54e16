#include "pipeline/localization/segment_table.h"

#include <gtest/gtest.h>

namespace cgsr::localization {
namespace {

PerceivedEdge upright(float x_px, bool bright_right = true) {
  PerceivedEdge edge;
  edge.middle = {x_px, 100.0F};
  edge.direction = {0.0F, bright_right ? -1.0F : 1.0F};
  edge.half_length = 50.0F;
  edge.contrast = 60.0F;
  return edge;
}

TEST(SegmentTable, AThingsOwnBordersSayAllThatTheyCan) {
  SegmentTable table(10);
  table.add(upright(100.0F));
  table.add(upright(110.0F, false));
  table.finish();
  for (const PerceivedEdge& edge : table.edges()) EXPECT_FLOAT_EQ(edge.information_weight, 1.0F);
  EXPECT_FLOAT_EQ(table.weighted_length(), 200.0F);
}

// Slats: what stands side by side and close together is in no map.
TEST(SegmentTable, APatternSaysHardlyMoreThanSomeOfItsEdges) {
  SegmentTable slats(100);
  for (int i = 0; i < 30; ++i) slats.add(upright(20.0F + 6.0F * static_cast<float>(i), i % 2 == 0));
  slats.finish();
  EXPECT_LT(slats.weighted_length(), 0.35F * slats.whole_length());
  SegmentTable apart(100);
  for (int i = 0; i < 8; ++i) apart.add(upright(20.0F + 30.0F * static_cast<float>(i), i % 2 == 0));
  apart.finish();
  EXPECT_FLOAT_EQ(apart.weighted_length(), apart.whole_length()) << "thirty pixels apart they are things";
}

TEST(SegmentTable, CountsTheSameInAnyOrder) {
  SegmentTable one(100);
  SegmentTable other(100);
  for (int i = 0; i < 12; ++i) one.add(upright(20.0F + 8.0F * static_cast<float>(i)));
  for (int i = 11; i >= 0; --i) other.add(upright(20.0F + 8.0F * static_cast<float>(i)));
  one.finish();
  other.finish();
  EXPECT_FLOAT_EQ(one.weighted_length(), other.weighted_length());
}

}  // namespace
}  // namespace cgsr::localization
