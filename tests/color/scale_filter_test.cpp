#include "pipeline/color/track/scale_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/allocation_guard.h"

namespace cgsr::color {
namespace {

constexpr int kWidth_px = 320;
constexpr int kHeight_px = 240;

/// A surface that is known at every point, so that it can be painted at any size: waves of random length and direction.
class Surface {
 public:
  explicit Surface(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < 12; ++i) {
      const double angle = 2 * std::numbers::pi * unit(random), length = 12.0 + 40.0 * unit(random);
      waves_.push_back({std::cos(angle) * 6.2832 / length, std::sin(angle) * 6.2832 / length, 6.3 * unit(random)});
    }
  }

  /// Painted `factor` times as large about `centre`.
  [[nodiscard]] std::vector<std::uint8_t> yuyv(double factor, double centre_x, double centre_y) const {
    std::vector<std::uint8_t> bytes;
    for (int y = 0; y < kHeight_px; ++y) {
      for (int x = 0; x < kWidth_px; ++x) {
        double value = 125.0;
        for (const auto& wave : waves_) {
          value += 15.0 * std::sin(wave.kx * (x + 0.5 - centre_x) / factor + wave.ky * (y + 0.5 - centre_y) / factor +
                                   wave.phase);
        }
        bytes.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(value, 16.0, 235.0))));
        bytes.push_back(128);
      }
    }
    return bytes;
  }

 private:
  struct Wave {
    double kx, ky, phase;
  };
  std::vector<Wave> waves_;
};

ImageView view_of(const std::vector<std::uint8_t>& bytes) {
  return {bytes.data(), kWidth_px, kHeight_px, kWidth_px * 2, PixelFormat::kYuyv};
}

struct Question {
  explicit Question(std::mt19937& random) : surface(random) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    box = {60 + 40 * unit(random), 40 + 40 * unit(random), 40 + 70 * unit(random), 40 + 70 * unit(random)};
  }
  [[nodiscard]] std::vector<std::uint8_t> grown(double factor) const {
    return surface.yuyv(factor, box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  }
  Surface surface;
  Box box;
};

TEST(ScaleFilterProperty, SaysByHowMuchItGrewWithinTwoPercent) {
  std::mt19937 random(61);
  std::uniform_real_distribution<double> growth(0.9, 1.11);
  ScaleFilter filter{ScaleParameters{}};
  imaging::Pyramid image(kWidth_px, kHeight_px);
  for (int trial = 0; trial < 60; ++trial) {
    const Question question(random);
    const auto first = question.grown(1.0);
    image.build(view_of(first));
    filter.begin(image, question.box);
    const double factor = growth(random);
    const auto second = question.grown(factor);
    image.build(view_of(second));

    const double estimate = filter.estimate(image, question.box);

    EXPECT_NEAR(estimate / factor, 1.0, 0.02)
        << trial << ": " << factor << " box " << question.box.width << 'x' << question.box.height;
  }
}

TEST(ScaleFilterProperty, WhatDidNotGrowStaysExactly) {
  std::mt19937 random(62);
  ScaleFilter filter{ScaleParameters{}};
  imaging::Pyramid image(kWidth_px, kHeight_px);
  for (int trial = 0; trial < 20; ++trial) {
    const Question question(random);
    const auto bytes = question.grown(1.0);
    image.build(view_of(bytes));
    filter.begin(image, question.box);
    EXPECT_EQ(filter.estimate(image, question.box), 1.0) << trial;
    filter.learn(image, question.box);
    EXPECT_EQ(filter.estimate(image, question.box), 1.0) << trial;
  }
}

// The box follows image after image, and the filter learns on the way: errors must not add up.
TEST(ScaleFilterProperty, FollowsAnObjectThatComesNearer) {
  std::mt19937 random(63);
  ScaleFilter filter{ScaleParameters{}};
  imaging::Pyramid image(kWidth_px, kHeight_px);
  for (int trial = 0; trial < 4; ++trial) {
    const Question question(random);
    const auto first = question.grown(1.0);
    image.build(view_of(first));
    filter.begin(image, question.box);
    Box box = question.box;
    double factor = 1.0;
    for (int i = 0; i < 20; ++i) {
      factor *= 1.015;
      const auto bytes = question.grown(factor);
      image.build(view_of(bytes));
      const double grown = filter.estimate(image, box);
      box = {box.x - 0.5 * box.width * (grown - 1), box.y - 0.5 * box.height * (grown - 1), box.width * grown,
             box.height * grown};
      filter.learn(image, box);
    }
    EXPECT_NEAR(box.width / question.box.width / factor, 1.0, 0.04) << trial;
  }
}

// The spectra of the box asked about last are kept: another image at the same place must not be answered from them.
TEST(ScaleFilter, KnowsOneImageFromTheNext) {
  std::mt19937 random(64);
  const Question question(random);
  const auto first = question.grown(1.0), second = question.grown(1.08);
  imaging::Pyramid image(kWidth_px, kHeight_px);
  ScaleFilter filter{ScaleParameters{}};
  image.build(view_of(first));
  filter.begin(image, question.box);
  ASSERT_EQ(filter.estimate(image, question.box), 1.0);
  image.build(view_of(second));
  EXPECT_GT(filter.estimate(image, question.box), 1.04);
}

TEST(ScaleFilterProperty, ForgettingIsAsIfOnlyTheFirstHadBeenSeen) {
  std::mt19937 random(65);
  imaging::Pyramid image(kWidth_px, kHeight_px);
  ScaleFilter filter{ScaleParameters{}};
  for (int trial = 0; trial < 5; ++trial) {
    const Question question(random), other(random);
    const auto first = question.grown(1.0), later = question.grown(1.06), foreign = other.grown(1.0);
    image.build(view_of(first));
    filter.begin(image, question.box);
    image.build(view_of(later));
    const double before = filter.estimate(image, question.box);
    image.build(view_of(foreign));
    for (int i = 0; i < 30; ++i) filter.learn(image, question.box);
    filter.forget();
    image.build(view_of(later));
    EXPECT_EQ(filter.estimate(image, question.box), before);
  }
}

TEST(ScaleFilterAlloc, NothingAfterConstruction) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  std::mt19937 random(66);
  const Question question(random);
  const auto bytes = question.grown(1.0);
  imaging::Pyramid image(kWidth_px, kHeight_px);
  ScaleFilter filter{ScaleParameters{}};
  image.build(view_of(bytes));
  filter.begin(image, question.box);
  const test::AllocationGuard guard;
  for (const Box& box : {Box{20, 20, 10, 90}, Box{20, 20, 90, 10}, Box{50, 50, 60, 60}}) {
    filter.begin(image, box);
    filter.estimate(image, box);
    filter.learn(image, box);
    filter.forget();
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::color
