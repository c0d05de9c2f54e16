#include "pipeline/localization/direction_field.h"

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
    edge.half_length = 50.0F;
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

TEST_F(Field, OfNothingIsNothing) {
  EXPECT_EQ(field_.score({}), 0.0F);
}

}  // namespace
}  // namespace cgsr::localization
