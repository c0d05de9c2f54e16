#include "pipeline/localization/agreement_by_part.h"

#include <gtest/gtest.h>

namespace cgsr::localization {
namespace {

using Eigen::Vector2f;

TEST(AgreementByPart, IsOfThePartsThatHoldTheShareAskedFor) {
  AgreementByPart parts(320, 240);
  EXPECT_EQ(parts.in_the_worst(0.5F), 0.0F) << "nothing was added";
  // Four edges of 20 px in four parts of 40 x 40 px.
  for (int i = 0; i < 4; ++i) {
    const Vector2f from(static_cast<float>(40 * i + 10), 15.0F);
    const Vector2f to = from + Vector2f(20.0F, 0.0F);
    parts.add(from, to, 1.0F);
    parts.agree(from, to, 0.25F * static_cast<float>(i));
  }
  EXPECT_NEAR(parts.in_the_worst(0.2F), 0.0F, 1e-5F);
  EXPECT_NEAR(parts.in_the_worst(0.4F), 0.25F, 1e-5F);
  EXPECT_NEAR(parts.in_the_worst(1.0F), 0.75F, 1e-5F);
  parts.clear();
  EXPECT_EQ(parts.in_the_worst(1.0F), 0.0F);
}

TEST(AgreementByPart, AnEdgeCountsWhereItRunsAndByItsWeight) {
  AgreementByPart parts(320, 240);
  parts.add({0.0F, 100.0F}, {160.0F, 100.0F}, 1.0F);
  parts.agree({0.0F, 100.0F}, {80.0F, 100.0F}, 1.0F);
  EXPECT_NEAR(parts.in_the_worst(0.45F), 0.0F, 1e-5F) << "its right half";
  EXPECT_NEAR(parts.in_the_worst(0.55F), 1.0F, 1e-5F) << "its left half";
  parts.add({200.0F, 20.0F}, {230.0F, 20.0F}, 10.0F);
  EXPECT_NEAR(parts.in_the_worst(0.7F), 0.0F, 1e-5F) << "a short one that counts much outweighs both";
  parts.agree({200.0F, 20.0F}, {230.0F, 20.0F}, 20.0F);
  EXPECT_LE(parts.in_the_worst(1.0F), 1.0F) << "never more than whole";
}

TEST(AgreementByPart, WhatSticksOutCountsAtTheBorder) {
  AgreementByPart parts(320, 240);
  parts.add({300.0F, 230.0F}, {400.0F, 300.0F}, 1.0F);
  parts.agree({300.0F, 230.0F}, {400.0F, 300.0F}, 0.5F);
  EXPECT_NEAR(parts.in_the_worst(0.5F), 0.5F, 1e-4F);
}

}  // namespace
}  // namespace cgsr::localization
