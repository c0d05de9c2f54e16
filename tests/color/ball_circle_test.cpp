#include "pipeline/color/ball/ball_circle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "pipeline/imaging/color_code.h"
#include "tests/color/ball_scene.h"

namespace cgsr::color {
namespace {

constexpr SizeRange kSizes{12.0, 90.0};
constexpr std::array kFactors{0.25, 0.4, 0.55};

const BallModel& model() {
  static const BallModel kModel = make_ball_model(test::ball_model(), kFactors).value();
  return kModel;
}

/// Under the light that was assumed at learning, nearest to it in the grid.
const std::uint8_t* colors() {
  const auto& lights = model().bright.lights;
  std::size_t best = 0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto off = [](const Light& light) {
      return std::abs(light.r - 0.9) + std::abs(light.g - 0.8) + std::abs(light.b - 0.8);
    };
    if (off(lights[i]) < off(lights[best])) best = i;
  }
  return model().of_code[best].data();
}

double unit(std::mt19937& random) {
  return static_cast<double>(random() >> 8) / (1 << 24);
}

TEST(BallCircleProperty, FindsTheCircleFromAnyPlaceOnTheBall) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 60; ++trial) {
    const Circle ball{60.0 + 200.0 * unit(random), 50.0 + 140.0 * unit(random), 8.0 + 30.0 * unit(random)};
    auto painting = test::ball_room();
    test::paint_ball(painting, ball, 1.0);
    const BallPixels pixels{painting.photograph(1.5, random()), colors(), {}};
    const double turn = 6.283 * unit(random);
    const double out = 0.6 * ball.radius_px * std::sqrt(unit(random));
    const CircleFit fit =
        fit_circle(pixels, ball.x_px + out * std::cos(turn), ball.y_px + out * std::sin(turn), kSizes);
    EXPECT_GT(fit.agreement, 0.8) << trial;
    EXPECT_GT(fit.inside, 0.85) << trial;
    EXPECT_LT(fit.around, 0.2) << trial;
    const double near_px = 0.4 + 0.015 * ball.radius_px;
    EXPECT_NEAR(fit.circle.x_px, ball.x_px, near_px) << trial;
    EXPECT_NEAR(fit.circle.y_px, ball.y_px, near_px) << trial;
    EXPECT_NEAR(fit.circle.radius_px, ball.radius_px, near_px) << trial;
  }
}

/// What is learned from a ball of which something grey hides a little.
BallModel model_of_a_partly_hidden_ball(const imaging::Rgb& ball_color, const imaging::Rgb& hides) {
  constexpr Circle kBall{100.0, 60.0, 16.0};
  auto painting = test::ball_room();
  test::paint_ball(painting, kBall, 1.0, ball_color);
  for (int y = 68; y < 80; ++y) {
    for (int x = 80; x < 120; ++x) painting.at(x, y) = hides;
  }
  color::LearnParameters parameters;
  parameters.widen = false;
  parameters.min_distinctiveness = 0.0;
  const color::Sample sample{painting.photograph(1.0, 7), test::around(kBall)};
  return make_ball_model(color::learn({&sample, 1}, parameters).value().model, kFactors).value();
}

/// Of the lights, under how many a colour may be the ball's, in the light or in shade.
int lights_of(const BallModel& ball, const imaging::Rgb& color) {
  const auto yuv = imaging::yuv_of_rgb(color);
  const auto code =
      imaging::color_code(4 * static_cast<int>(yuv.y), 2 * static_cast<int>(yuv.u), 2 * static_cast<int>(yuv.v));
  return static_cast<int>(std::count_if(ball.of_code.begin(), ball.of_code.end(),
                                        [code](const auto& of_code) { return of_code[code] != 0; }));
}

// A dark floor is grey to a camera: with what hides a little of the ball all of it would count as the ball in shade.
TEST(BallModel, WhatHidesSomeOfTheBallIsNotOneOfItsColours) {
  constexpr imaging::Rgb kDarkFloor{0.05, 0.05, 0.05};
  const BallModel ball = model_of_a_partly_hidden_ball(test::kOrange, {0.16, 0.16, 0.16});
  EXPECT_EQ(lights_of(ball, kDarkFloor), 0);
  EXPECT_GT(lights_of(ball, {0.5, 0.25, 0.05}), 0) << "the ball itself";
  EXPECT_GT(lights_of(ball, {0.2, 0.1, 0.02}), 0) << "in shade";
}

TEST(BallModel, HowDarkAColourIsSaysWhichDepthOfShadeItIsOf) {
  const ColorModel learned = test::ball_model();
  const BallModel ball = make_ball_model(learned, std::vector{0.40, 0.15, 0.65}).value();
  const std::uint8_t deep = BallModel::kDeepest, middle = deep << 1, soft = deep << 2;
  EXPECT_EQ(ball.dark_kinds, (std::vector<std::uint8_t>{middle, deep, soft})) << "in the order of the factors";
  const std::size_t lights = ball.bright.lights.size();
  EXPECT_EQ(ball.kind_of_dark(lights), deep);
  int of_deep = 0, of_soft = 0, of_both = 0;
  for (const auto& of_code : ball.of_code) {
    for (const std::uint8_t kinds : of_code) {
      EXPECT_EQ(kinds & ~BallModel::kAny, 0);
      of_deep += (kinds & deep) != 0 ? 1 : 0;
      of_soft += (kinds & soft) != 0 ? 1 : 0;
      of_both += (kinds & deep) != 0 && (kinds & soft) != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(of_deep, 0);
  EXPECT_GT(of_soft, 0);
  EXPECT_LT(of_both, of_deep / 2) << "or depths tell nothing";
}

TEST(BallModel, OfMoreFactorsThanDepthsNeighboursShareOne) {
  const BallModel ball = make_ball_model(test::ball_model(), std::vector{0.2, 0.3, 0.4, 0.5}).value();
  EXPECT_TRUE(std::ranges::is_sorted(ball.dark_kinds));
  EXPECT_EQ(ball.dark_kinds.front(), BallModel::kDeepest);
  EXPECT_EQ(ball.dark_kinds.back(), BallModel::kDeepest << (BallModel::kDepths - 1));
}

TEST(BallModel, OfAGreyBallGreyIsTheColour) {
  constexpr imaging::Rgb kGrey{0.6, 0.6, 0.6};
  const BallModel ball = model_of_a_partly_hidden_ball(kGrey, {0.1, 0.1, 0.6});
  EXPECT_GT(lights_of(ball, {0.4, 0.4, 0.4}), 0);
  EXPECT_GT(lights_of(ball, {0.15, 0.15, 0.15}), 0) << "in shade";
}

TEST(BallCircle, ASquareOfTheSameColourIsNone) {
  auto painting = test::ball_room();
  painting.fill({100, 60, 40, 40}, test::kOrange);
  const BallPixels pixels{painting.photograph(1.5, 3), colors(), {}};
  EXPECT_LT(fit_circle(pixels, 118, 82, kSizes).agreement, 0.6);
}

TEST(BallCircle, AStripeOrAWideSurfaceIsNone) {
  auto painting = test::ball_room();
  painting.fill({0, 60, 320, 24}, test::kOrange);
  const ImageView stripe = painting.photograph(1.5, 3);
  const CircleFit in_stripe = fit_circle({stripe, colors(), {}}, 150, 72, kSizes);
  EXPECT_TRUE(in_stripe.agreement < 0.6 || in_stripe.around > 0.3) << in_stripe.agreement << ' ' << in_stripe.around;
  painting.fill({0, 0, 320, 240}, test::kOrange);
  EXPECT_LT(fit_circle({painting.photograph(1.5, 3), colors(), {}}, 150, 100, kSizes).agreement, 0.3);
}

TEST(BallCircle, SizesThatCannotBeAreNoBall) {
  const Circle ball{150.0, 100.0, 20.0};
  auto painting = test::ball_room();
  test::paint_ball(painting, ball, 1.0);
  const BallPixels pixels{painting.photograph(1.5, 3), colors(), {}};
  EXPECT_GT(fit_circle(pixels, 150, 100, {30.0, 50.0}).agreement, 0.8);
  EXPECT_LT(fit_circle(pixels, 150, 100, {60.0, 90.0}).agreement, 0.3);
  EXPECT_LT(fit_circle(pixels, 150, 100, {10.0, 25.0}).agreement, 0.3);
}

TEST(BallCircle, HalfOutsideTheImageOrHalfHidden) {
  const Circle ball{4.0, 100.0, 20.0};
  auto painting = test::ball_room();
  test::paint_ball(painting, ball, 1.0);
  const CircleFit cut = fit_circle({painting.photograph(1.5, 3), colors(), {}}, 8, 100, kSizes);
  EXPECT_GT(cut.agreement, 0.5);
  EXPECT_NEAR(cut.circle.radius_px, 20.0, 2.0);

  const Circle other{150.0, 100.0, 20.0};
  auto second = test::ball_room();
  test::paint_ball(second, other, 1.0);
  second.fill({158, 40, 20, 120}, {0.2, 0.2, 0.3});
  const CircleFit hidden = fit_circle({second.photograph(1.5, 3), colors(), {}}, 145, 100, kSizes);
  EXPECT_GT(hidden.agreement, 0.5);
  EXPECT_NEAR(hidden.circle.radius_px, 20.0, 2.0);
}

// Dark colours count inside the mask alone.
TEST(BallCircle, TheMaskSaysWhereDarkColoursCount) {
  const Circle in_shade{240.0, 180.0, 18.0};
  const Circle outside{80.0, 60.0, 18.0};
  auto painting = test::ball_room(0.45);
  test::paint_ball(painting, in_shade, 0.45);
  test::paint_ball(painting, outside, 0.3);
  const ImageView image = painting.photograph(1.5, 3);
  const test::QuarterMask mask;
  const BallPixels with{image, colors(), mask.view()};
  const BallPixels without{image, colors(), {}};
  EXPECT_GT(fit_circle(with, 240, 180, kSizes).agreement, 0.7);
  EXPECT_LT(fit_circle(with, 80, 60, kSizes).inside, 0.6);
  EXPECT_GT(fit_circle(without, 80, 60, kSizes).inside, 0.9);
  EXPECT_GT(fit_circle(without, 80, 60, kSizes).agreement, 0.7);
  EXPECT_GT(shade_share(with, in_shade), 0.99);
  EXPECT_EQ(shade_share(with, outside), 0.0);
  EXPECT_NEAR(shade_share(with, {160.0, 180.0, 18.0}), 0.5, 0.1);
}

TEST(BallModelFault, SaysWhatCannotBe) {
  ColorModel model = test::ball_model();
  EXPECT_FALSE(make_ball_model(model, {}).has_value());
  EXPECT_FALSE(make_ball_model(model, std::array{0.0}).has_value());
  EXPECT_FALSE(make_ball_model(model, std::array{1.5}).has_value());
  EXPECT_FALSE(make_ball_model(model, std::array{0.1, 0.2, 0.3, 0.4, 0.5}).has_value()) << "135 lights";
  model.samples.clear();
  EXPECT_FALSE(make_ball_model(model, kFactors).has_value());
}

}  // namespace
}  // namespace cgsr::color
