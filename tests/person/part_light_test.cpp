// The light on a shirt, by its mean colour.

#include <array>

#include <gtest/gtest.h>

#include "pipeline/person/colors/color_labels.h"
#include "pipeline/person/colors/part_light.h"
#include "tests/person/drawn_people.h"

namespace cgsr::person {
namespace {

constexpr color::Light kAssumed{0.8, 0.8, 0.8};
constexpr Rgb kShirt{0.6, 0.3, 0.2}, kBeside{0.5, 0.5, 0.5};

PartColors in_light(double r, double g, double b) {
  return {{kShirt.r * r, kShirt.g * g, kShirt.b * b}, {kBeside.r * r, kBeside.g * g, kBeside.b * b}};
}

PartLight learned() {
  PartLight light;
  light.learn(1, kAssumed);
  light.found(1, in_light(1.0, 1.0, 1.0));
  return light;
}

TEST(PartLight, IsThatInWhichThePlaceAndWhatIsBesideItHaveChangedAlike) {
  PartLight light = learned();
  ASSERT_TRUE(light.suppose(1, in_light(0.6, 0.7, 0.6)));
  EXPECT_NEAR(light.of(1)->r, 0.48, 1e-9);
  EXPECT_NEAR(light.of(1)->g, 0.56, 1e-9);
  light.take_back(1);
  EXPECT_NEAR(light.of(1)->r, 0.8, 1e-9);
}

TEST(PartLight, KeepsWhomItIsToldTo) {
  PartLight light;
  for (const Label person : {1, 2, 3}) light.learn(person, kAssumed);
  light.keep(std::array<Label, 2>{3, 1});
  EXPECT_TRUE(light.of(1));
  EXPECT_FALSE(light.of(2));
  EXPECT_TRUE(light.of(3));
  light.keep({});
  EXPECT_FALSE(light.of(1));
}

TEST(PartLight, StaysWhereNoLightExplainsTheChange) {
  PartLight light = learned();
  EXPECT_FALSE(light.suppose(1, in_light(1.0, 1.0, 1.0))) << "nothing has changed: it is covered";
  EXPECT_FALSE(light.suppose(1, in_light(0.35, 1.0, 1.0))) << "no lamp is as red as this";
  EXPECT_FALSE(light.suppose(1, in_light(0.2, 0.2, 0.2))) << "too dark to be told";
  EXPECT_FALSE(light.suppose(1, {in_light(0.6, 0.6, 0.6).part, kBeside})) << "only the shirt has changed: it is gone";
  EXPECT_FALSE(light.suppose(2, in_light(0.6, 0.6, 0.6))) << "nobody";
  EXPECT_NEAR(light.of(1)->r, 0.8, 1e-9);
}

// A change in steps, each of which is found, adds up; what the shirt stands before may change meanwhile, and a print turned away is no light.
TEST(PartLight, GoesOnFromWhereTheShirtWasFoundLast) {
  PartLight light = learned();
  ASSERT_TRUE(light.suppose(1, in_light(0.8, 0.8, 0.8)));
  light.found(1, in_light(0.8, 0.8, 0.8));
  light.take_back(1);
  EXPECT_NEAR(light.of(1)->r, 0.64, 1e-9) << "it was found: nothing to be taken back";
  EXPECT_FALSE(light.found(1, {in_light(0.8, 0.8, 0.8).part, {0.2, 0.2, 0.2}}));
  EXPECT_FALSE(light.suppose(1, in_light(0.6, 0.6, 0.6))) << "it stands before something dark now";
  ASSERT_TRUE(light.suppose(1, {in_light(0.6, 0.6, 0.6).part, {0.15, 0.15, 0.15}}));
  EXPECT_NEAR(light.of(1)->r, 0.48, 1e-9);
  light.forget(1);
  EXPECT_EQ(light.of(1), std::nullopt);
}

TEST(PartLight, FollowsASlowChangeWhileTheShirtIsFound) {
  PartLight light = learned();
  int anew = 0;
  for (int image = 0; image < 300; ++image) {
    const double gain = 1.0 - 0.4 * image / 300.0;
    anew += light.found(1, in_light(gain, gain, 1.0)) ? 1 : 0;
  }
  EXPECT_NEAR(light.of(1)->r, 0.48, 0.05);
  EXPECT_NEAR(light.of(1)->b, 0.8, 1e-9);
  EXPECT_GE(anew, 3);
  EXPECT_LE(anew, 8) << "each costs millions of instructions";
  EXPECT_FALSE(light.found(1, {in_light(0.4, 0.4, 1.0).part, in_light(0.6, 0.6, 1.0).beside})) << "a print";
}

// A channel that the shirt hardly reflects is told coarsely, and changes with what leaks into it.
TEST(PartLight, IsToldByTheChannelsThatTheShirtReflects) {
  constexpr Rgb kCyan{0.06, 0.44, 0.56};
  PartLight light;
  light.learn(1, kAssumed);
  light.found(1, {kCyan, kBeside});
  const Rgb beside = in_light(0.7, 0.7, 0.75).beside;
  ASSERT_TRUE(light.suppose(1, {{0.08, 0.7 * kCyan.g, 0.75 * kCyan.b}, beside}));
  EXPECT_NEAR(light.of(1)->r, 0.56, 1e-9) << "as beside";
  EXPECT_NEAR(light.of(1)->b, 0.6, 1e-9);
  PartLight other;
  other.learn(1, kAssumed);
  other.found(1, {kCyan, kBeside});
  EXPECT_FALSE(other.suppose(1, {{0.06, 0.7 * kCyan.g, 0.5 * kCyan.b}, beside}))
      << "one that it reflects has changed alone";
}

// Another wall is no light, however little of the shirt tells of it.
TEST(PartLight, IsNotToldByWhatIsBesideAlone) {
  for (const Rgb& shirt : {Rgb{0.55, 0.10, 0.10}, Rgb{0.08, 0.09, 0.13}}) {
    PartLight light;
    light.learn(1, kAssumed);
    light.found(1, {shirt, {0.6, 0.6, 0.6}});
    EXPECT_FALSE(light.found(1, {shirt, {0.6, 0.5, 0.4}}));
    EXPECT_FALSE(light.suppose(1, {shirt, {0.6, 0.45, 0.35}}));
    EXPECT_FALSE(light.suppose(1, {shirt, {0.4, 0.4, 0.4}}));
    EXPECT_NEAR(light.of(1)->g, 0.8, 1e-9);
  }
}

// A change of a percent in an image: what is beside the shirt keeps changing with it until it is enough for another light.
TEST(PartLight, AddsUpAChangeThatIsSmallInEachImage) {
  PartLight light = learned();
  double gain = 1.0;
  int changes = 0;
  for (int i = 0; i < 30; ++i) {
    gain *= 0.99;
    changes += light.found(1, in_light(gain, gain, gain)) ? 1 : 0;
  }
  EXPECT_GE(changes, 3);
  EXPECT_NEAR(light.of(1)->r, 0.8 * gain, 0.08 * 0.8);
}

// A lamp that is switched is half bright in the image in between; a light that goes on changing is another one in each.
TEST(PartLight, IsSupposedAgainWhereTheLastOneDidNotExplainIt) {
  PartLight light = learned();
  ASSERT_TRUE(light.suppose(1, in_light(0.9, 0.9, 0.9)));
  light.take_back(1);
  EXPECT_FALSE(light.suppose(1, in_light(0.9, 0.9, 0.9))) << "it was looked for under that one";
  ASSERT_TRUE(light.suppose(1, in_light(0.6, 0.6, 0.6)));
  EXPECT_NEAR(light.of(1)->r, 0.48, 1e-9);
  light.found(1, in_light(0.6, 0.6, 0.6));
  EXPECT_TRUE(light.suppose(1, in_light(0.54, 0.54, 0.54))) << "found in between";
}

TEST(PartLight, IsTheOneBeforeWhereLessIsSeenUnderTheNew) {
  PartLight light = learned();
  ASSERT_TRUE(light.found(1, in_light(0.7, 0.7, 0.7)));
  light.undo(1);
  EXPECT_NEAR(light.of(1)->r, 0.8, 1e-9);
  EXPECT_FALSE(light.found(1, in_light(0.7, 0.7, 0.7))) << "that is how it looks in the old light";
  light.undo(1);
  EXPECT_NEAR(light.of(1)->r, 0.8, 1e-9) << "once for each change";
  light.undo(2);
}

// A shirt that was followed into a lamp's light, and is gone for long.
TEST(PartLight, IsThatOfLearningInTurnsAfterALongLoss) {
  PartLight light = learned();
  EXPECT_FALSE(light.turn(1)) << "it has not changed";
  ASSERT_TRUE(light.found(1, in_light(0.6, 0.6, 0.6)));
  for (const double expected : {0.8, 0.48, 0.8}) {
    ASSERT_TRUE(light.turn(1));
    EXPECT_NEAR(light.of(1)->r, expected, 1e-9);
  }
  EXPECT_FALSE(light.found(1, in_light(1.0, 1.0, 1.0))) << "where it was found it is that one";
  EXPECT_FALSE(light.turn(1)) << "of learning";
  ASSERT_TRUE(light.suppose(1, in_light(0.6, 0.6, 0.6)));
  EXPECT_NEAR(light.of(1)->r, 0.48, 1e-9) << "a change from there";
  EXPECT_FALSE(light.turn(2)) << "nobody";
}

TEST(MeanColor, IsOfThePixelsThatAreNeitherDarkNorWhite) {
  Picture picture;
  picture.fill(kShirtBox, kRed);
  picture.fill({120, 80, 20, 100}, {0.0, 0.0, 0.0});
  picture.fill({140, 80, 20, 100}, {1.0, 1.0, 1.0});
  const auto mean = mean_color(picture.view(), kShirtBox);
  ASSERT_TRUE(mean);
  EXPECT_NEAR(mean->r, kRed.r, 0.02);
  EXPECT_NEAR(mean->b, kRed.b, 0.02);
  EXPECT_FALSE(mean_color(picture.view(), {120, 80, 40, 100})) << "neither dark nor white is none";
  EXPECT_FALSE(mean_color(picture.view(), {400, 300, 50, 50})) << "outside";
  EXPECT_TRUE(mean_color(picture.view(), {300, 220, 500, 500})) << "what of it is inside";
  EXPECT_FALSE(mean_color({}, kShirtBox));
}

TEST(ColorLabels, KeepBothPartsApart) {
  Picture picture;
  picture.fill(kShirtBox, kRed);
  picture.fill(kFaceBox, kBlue);
  const auto code = [&](int x, int y) {
    const std::uint8_t* pixel = picture.yuyv.data() + std::ptrdiff_t{2} * (y * kWidth + x);
    return imaging::color_code(4 * pixel[0], 2 * pixel[1], 2 * pixel[3]);
  };
  imaging::LabelTable shirts(imaging::kColorCodes, 0), heads(imaging::kColorCodes, 0);
  shirts[code(130, 90)] = 255;
  heads[code(150, 40)] = 7;
  ColorLabels labels(kWidth, kHeight);
  labels.set(ColorPart::kShirt, shirts);
  labels.set(ColorPart::kHead, heads);
  ASSERT_TRUE(labels.look(picture.view()));
  EXPECT_EQ(labels.of(ColorPart::kShirt).at(65, 45), 255);
  EXPECT_EQ(labels.of(ColorPart::kHead).at(65, 45), 0);
  EXPECT_EQ(labels.of(ColorPart::kHead).at(75, 20), 7);
  EXPECT_EQ(labels.of(ColorPart::kShirt).at(75, 20), 0);
  const LabelImage part = labels.of(ColorPart::kShirt).within({60, 40, 500, 500});
  EXPECT_EQ(part.width_px, 100);
  EXPECT_EQ(part.height_px, 80);
  EXPECT_EQ(part.at(5, 5), 255);
  EXPECT_FALSE(labels.look({}));
  EXPECT_TRUE(labels.of(ColorPart::kShirt).empty());
}

}  // namespace
}  // namespace cgsr::person
