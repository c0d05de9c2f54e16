#include "pipeline/localization/direction_field.h"

#include <array>

#include <gtest/gtest.h>

namespace cgsr::localization {
namespace {

ProjectedPiece piece(float x, float y, const Eigen::Vector2f& direction, int bright_side) {
  ProjectedPiece result;
  result.middle = {x, y};
  result.direction = direction;
  result.half_length = 30.0F;
  result.bright_side = static_cast<std::int8_t>(bright_side);
  return result;
}

class Field : public ::testing::Test {
 protected:
  Field() : field_(320, 240) {
    SegmentTable table(4);
    PerceivedEdge edge;
    edge.middle = {160, 120};
    edge.direction = {1, 0};
    edge.half_length = 30.0F;
    edge.contrast = 60.0F;
    table.add(edge);
    table.finish();
    field_.build(table);
  }
  float score(float x, float y, const Eigen::Vector2f& direction = {1, 0}, int bright_side = 1) const {
    const ProjectedPiece one = piece(x, y, direction, bright_side);
    return field_.score({&one, 1});
  }
  DirectionField field_;
};

TEST_F(Field, FallsWithTheDistance) {
  EXPECT_GT(score(160, 120), 0.95F);
  float last = 1.1F;
  for (float y = 120; y < 170; y += 8) {
    EXPECT_LT(score(160, y), last);
    last = score(160, y);
  }
  EXPECT_LT(last, 0.01F);
}

TEST_F(Field, CountsOnlyEdgesOfTheDirection) {
  EXPECT_LT(score(160, 120, {0, 1}), 0.05F);
  EXPECT_LT(score(160, 120, Eigen::Vector2f(1, 1).normalized()), 0.05F);
  EXPECT_GT(score(160, 120, Eigen::Vector2f(1, 0.1F).normalized()), 0.8F);
  EXPECT_LT(score(160, 120, {1, 0}, -1), 0.05F) << "the brighter side is the other one";
  EXPECT_GT(score(160, 120, {-1, 0}, -1), 0.95F);
  EXPECT_GT(score(160, 120, {-1, 0}, 0), 0.95F) << "not known";
}

// A pose that expects one edge and finds it is not as good as one that foresees all there is.
TEST_F(Field, CountsWhatIsSeenAndNotExpected) {
  SegmentTable table(4);
  for (const float y : {120.0F, 180.0F}) {
    PerceivedEdge edge;
    edge.middle = {160, y};
    edge.half_length = 30.0F;
    edge.contrast = 60.0F;
    table.add(edge);
  }
  table.finish();
  field_.build(table);
  const std::array both{piece(160, 120, {1, 0}, 1), piece(160, 180, {1, 0}, 1)};
  EXPECT_NEAR(field_.score({both.data(), 1}), 2.0F / 3.0F, 0.03F);
  EXPECT_GT(field_.score(both), 0.95F);
}

TEST_F(Field, OfNothingIsNothing) {
  EXPECT_EQ(field_.score({}), 0.0F);
}

}  // namespace
}  // namespace cgsr::localization
