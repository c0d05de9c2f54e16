#include "pipeline/color/track/illuminant_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "pipeline/color/track/relight.h"
#include "tests/color/surface.h"

namespace cgsr::color {
namespace {

constexpr Light kSame{1.0, 1.0, 1.0};

ChannelQuantiles under(const ObjectView& view, const Light& light) {
  return channel_quantiles(relit(view, light));
}

const ObjectView kRoom = surface(1);
const ObjectView kElsewhere = surface(5);
const ObjectView kFront = surface(2);
const ObjectView kBack = surface(9);
const Light kLamp{0.7, 0.85, 0.6};

/// Begun under the learned light, then one image: of a room and of a side of the object under the lamp.
Light estimate(const ObjectView& room, const ObjectView& side, const Light& light = kLamp) {
  IlluminantFilter filter{IlluminantParameters{}};
  filter.begin(kSame, under(kRoom, kSame));
  filter.add(under(room, light), kSame, measured_gain(under(kFront, kSame), under(side, light)));
  return filter.gain();
}

TEST(IlluminantFilter, FindsTheGainOfRoomAndObjectAtOnce) {
  EXPECT_LT(error(estimate(kRoom, kFront), kLamp), 0.03);
}

TEST(IlluminantFilter, AnotherSideOfTheObjectIsNoOtherLight) {
  const Light by_object = light_gain(under(kFront, kSame), under(kBack, kLamp));
  ASSERT_GT(error(by_object, kLamp), 0.1);  // that side alone would mislead
  EXPECT_LT(error(estimate(kRoom, kBack), kLamp), 0.05);
}

TEST(IlluminantFilter, AnotherViewOfTheRoomIsNoOtherLight) {
  const Light by_image = light_gain(under(kRoom, kSame), under(kElsewhere, kLamp));
  ASSERT_GT(error(by_image, kLamp), 0.1);
  EXPECT_LT(error(estimate(kElsewhere, kFront), kLamp), 0.08);
}

// Neither is what it was: closer to the light of the first sight than either of them says.
TEST(IlluminantFilter, WhereNothingFitsItStaysNearTheLightOfTheFirstSight) {
  const Light by_image = light_gain(under(kRoom, kSame), under(kElsewhere, kSame));
  const Light by_object = light_gain(under(kFront, kSame), under(kBack, kSame));
  const double worst = std::max(error(by_image, kSame), error(by_object, kSame));
  ASSERT_GT(worst, 0.15);
  EXPECT_LT(error(estimate(kElsewhere, kBack, kSame), kSame), 0.5 * worst);
}

TEST(IlluminantFilter, FollowsTheRoomWhileTheObjectIsLost) {
  IlluminantFilter filter{IlluminantParameters{}};
  filter.begin(kSame, under(kRoom, kSame));
  filter.add(under(kRoom, kLamp), kLamp, std::nullopt);
  EXPECT_LT(error(filter.gain(), kLamp), 0.03);
}

TEST(IlluminantFilter, BeginsWithTheLightOfTheFirstSight) {
  IlluminantFilter filter{IlluminantParameters{}};
  filter.add(under(kRoom, kLamp), kLamp, measured_gain(under(kFront, kSame), under(kFront, kLamp)));
  EXPECT_EQ(error(filter.gain(), kSame), 0.0);  // before it nothing is said
  filter.begin(kLamp, under(kRoom, kLamp));
  EXPECT_EQ(error(filter.gain(), kLamp), 0.0);
  filter.add(under(kRoom, kSame), without_light(kSame, kLamp), std::nullopt);
  EXPECT_LT(error(filter.gain(), kSame), 0.04);
}

TEST(MeasuredGain, LeavesNothingOfTheSameSurfaceAndMuchOfAnother) {
  const auto same = measured_gain(under(kFront, kSame), under(kFront, kLamp));
  const auto other = measured_gain(under(kFront, kSame), under(kBack, kLamp));
  EXPECT_LT(std::max({same.residual.r, same.residual.g, same.residual.b}), 0.03);
  EXPECT_GT(std::max({other.residual.r, other.residual.g, other.residual.b}), 0.08);
}

TEST(MeasuredGain, AChannelWithoutBrightnessSaysNothing) {
  const auto black = measured_gain(under(kFront, kSame), under(kFront, {1.0, 1.0, 0.001}));
  EXPECT_EQ(black.residual.b, 1.0);
  EXPECT_EQ(black.gain.b, 1.0);
}

}  // namespace
}  // namespace cgsr::color
