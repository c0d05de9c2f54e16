#include "pipeline/color/track/color_likelihood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "tests/support/allocation_guard.h"

namespace cgsr::color {
namespace {

/// Few colours, so that bins meet.
ColorPatch random_patch(std::mt19937& random, unsigned colors) {
  ColorPatch patch({8 + static_cast<int>(random() % 57), 8 + static_cast<int>(random() % 57)});
  for (std::size_t i = 0; i < patch.y.size(); ++i) {
    const unsigned color = static_cast<unsigned>(random() % colors);
    patch.y[i] = static_cast<std::uint8_t>(color * 57 + random() % 3);
    patch.u[i] = static_cast<std::uint8_t>(color * 101 + 7);
    patch.v[i] = static_cast<std::uint8_t>(color * 23 + random() % 9);
  }
  return patch;
}

bool holds(const Box& box, int x, int y) {
  return x + 0.5 >= box.x && x + 0.5 < box.x + box.width && y + 0.5 >= box.y && y + 0.5 < box.y + box.height;
}

/// Shares of each colour among the object's and the surroundings' pixels, kept over images as the header says.
class NaiveLikelihood {
 public:
  void learn(const ColorPatch& patch, const Box& inside, const Box& outside, double rate) {
    std::map<int, double> in, out;
    double count_in = 0, count_out = 0;
    for (int y = 0; y < patch.size.height_px; ++y) {
      for (int x = 0; x < patch.size.width_px; ++x) {
        const auto i = static_cast<std::size_t>(y * patch.size.width_px + x);
        const int bin = bin_of(patch.y[i], patch.u[i], patch.v[i]);
        if (holds(inside, x, y)) {
          in[bin] += 1;
          count_in += 1;
        } else if (!holds(outside, x, y)) {
          out[bin] += 1;
          count_out += 1;
        }
      }
    }
    for (int bin = 0; bin < 8 * 32 * 32; ++bin) {
      blend(object_, bin, in.contains(bin) ? in[bin] / count_in : 0.0, rate);
      blend(around_, bin, out.contains(bin) ? out[bin] / count_out : 0.0, rate);
    }
  }
  [[nodiscard]] double of(int y, int u, int v) {
    const int bin = bin_of(y, u, v);
    return (object_[bin] + 0.5e-4) / (object_[bin] + around_[bin] + 1e-4);
  }

 private:
  static int bin_of(int y, int u, int v) { return (y / 32 * 32 + u / 8) * 32 + v / 8; }
  static void blend(std::map<int, double>& shares, int bin, double share, double rate) {
    if (share > 0.0 || shares.contains(bin)) shares[bin] += rate * (share - shares[bin]);
  }
  std::map<int, double> object_, around_;
};

TEST(ColorLikelihoodProperty, IsTheShareOfTheObject) {
  std::mt19937 random(71);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  ColorLikelihood likelihood;
  for (int trial = 0; trial < 60; ++trial) {
    NaiveLikelihood naive;
    for (int image = 0; image < 4; ++image) {
      const ColorPatch patch = random_patch(random, 1 + static_cast<unsigned>(random() % 40));
      const double width = patch.size.width_px, height = patch.size.height_px;
      const Box outside{0.3 * width * unit(random), 0.3 * height * unit(random), (0.4 + 0.3 * unit(random)) * width,
                        (0.4 + 0.3 * unit(random)) * height};
      const Box inside{outside.x + 1.1, outside.y + 0.6, 0.7 * outside.width, 0.7 * outside.height};
      const double rate = image == 0 ? 1.0 : unit(random);

      likelihood.learn(patch, inside, outside, rate);
      naive.learn(patch, inside, outside, rate);

      for (std::size_t i = 0; i < patch.y.size(); ++i) {
        ASSERT_NEAR(likelihood.of(patch.y[i], patch.u[i], patch.v[i]), naive.of(patch.y[i], patch.u[i], patch.v[i]),
                    1e-4)
            << trial;
      }
    }
  }
}

TEST(ColorLikelihood, OfWhatWasNeverSeenIsOneHalf) {
  const ColorLikelihood fresh;
  EXPECT_EQ(fresh.of(3, 200, 9), 0.5F);
  ColorLikelihood learned;
  ColorPatch patch({8, 8});
  std::fill(patch.y.begin(), patch.y.end(), std::uint8_t{100});
  learned.learn(patch, {0, 0, 8, 4}, {0, 0, 8, 4}, 1.0);
  EXPECT_NEAR(learned.of(200, 0, 0), 0.5, 1e-6);
  EXPECT_NEAR(learned.of(100, 0, 0), 0.5, 1e-6);  // as often inside as outside
}

TEST(ColorLikelihood, OfTheObjectsOwnColourIsNearOne) {
  ColorPatch patch({16, 16});
  for (std::size_t i = 0; i < patch.y.size(); ++i) patch.y[i] = i % 16 < 8 ? 200 : 50;
  ColorLikelihood likelihood;
  likelihood.learn(patch, {0, 0, 8, 16}, {0, 0, 8, 16}, 1.0);
  EXPECT_GT(likelihood.of(200, 0, 0), 0.999F);
  EXPECT_LT(likelihood.of(50, 0, 0), 0.001F);
}

TEST(RelightProperty, IsTheDiagonalModel) {
  std::mt19937 random(72);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const imaging::Rgb color{unit(random), unit(random), unit(random)};
    const auto yuv = imaging::yuv_of_rgb(color);
    ColorPatch patch({4, 2});
    std::fill(patch.y.begin(), patch.y.end(), static_cast<std::uint8_t>(std::lround(yuv.y)));
    std::fill(patch.u.begin(), patch.u.end(), static_cast<std::uint8_t>(std::lround(yuv.u)));
    std::fill(patch.v.begin(), patch.v.end(), static_cast<std::uint8_t>(std::lround(yuv.v)));
    const auto recorded = imaging::rgb_of_yuv(patch.y[0], patch.u[0], patch.v[0]);
    const Light gain{0.4 + unit(random), 0.4 + unit(random), 0.4 + unit(random)};

    relight(patch, gain);

    const auto expected = imaging::yuv_of_rgb(
        {std::min(1.0, recorded.r * gain.r), std::min(1.0, recorded.g * gain.g), std::min(1.0, recorded.b * gain.b)});
    for (std::size_t i = 0; i < patch.y.size(); ++i) {
      ASSERT_NEAR(patch.y[i], expected.y, 0.51) << trial;
      ASSERT_NEAR(patch.u[i], expected.u, 0.51) << trial;
      ASSERT_NEAR(patch.v[i], expected.v, 0.51) << trial;
    }
  }
}

TEST(ColorLikelihoodAlloc, NothingAfterConstruction) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  std::mt19937 random(73);
  ColorPatch patch = random_patch(random, 9);
  ColorLikelihood likelihood;
  const test::AllocationGuard guard;
  likelihood.learn(patch, {2, 2, 4, 4}, {1, 1, 6, 6}, 1.0);
  relight(patch, {0.8, 0.9, 1.1});
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::color
