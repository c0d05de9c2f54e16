#include "pipeline/color/track/orientation_histograms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/allocation_guard.h"

namespace cgsr::color {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Values = std::vector<double>;

/// The same in double and without a table: every pixel asks atan2 and shares its vote out over all cells that are near enough.
Values naive_histograms(const Bytes& luma, imaging::PatchSize size, int cell_px) {
  const int width = size.width_px / cell_px, height = size.height_px / cell_px;
  const auto pixel = [&](int x, int y) {
    x = std::clamp(x, 0, size.width_px - 1);
    y = std::clamp(y, 0, size.height_px - 1);
    return static_cast<int>(luma[static_cast<std::size_t>(y * size.width_px + x)]);
  };
  Values cells(static_cast<std::size_t>(width * height * kOrientations));
  const auto cell = [&](int x, int y, int b) -> double& {
    return cells[static_cast<std::size_t>((b * height + y) * width + x)];
  };
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) {
      const double gx = std::clamp(pixel(x + 1, y) - pixel(x - 1, y), -128, 128);
      const double gy = std::clamp(pixel(x, y + 1) - pixel(x, y - 1), -128, 128);
      const double angle = std::fmod(std::atan2(gy, gx) + std::numbers::pi, std::numbers::pi);
      for (int b = 0; b < kOrientations; ++b) {
        const double apart = std::abs(angle * kOrientations / std::numbers::pi - b);
        const double vote = std::max(0.0, 1.0 - std::min(apart, kOrientations - apart)) * std::hypot(gx, gy);
        for (int j = std::max(0, y / cell_px - 1); j <= std::min(height - 1, y / cell_px + 1); ++j) {
          for (int i = std::max(0, x / cell_px - 1); i <= std::min(width - 1, x / cell_px + 1); ++i) {
            const double dx = std::abs((x + 0.5) / cell_px - (i + 0.5)), dy = std::abs((y + 0.5) / cell_px - (j + 0.5));
            cell(i, j, b) += vote * std::max(0.0, 1.0 - dx) * std::max(0.0, 1.0 - dy);
          }
        }
      }
    }
  }
  const auto inverse_norm = [&](int x, int y) {
    x = std::max(0, x);
    y = std::max(0, y);
    double sum = 1.25 * cell_px * cell_px;
    for (const int j : {y, std::min(y + 1, height - 1)}) {
      for (const int i : {x, std::min(x + 1, width - 1)}) {
        for (int b = 0; b < kOrientations; ++b) sum += cell(i, j, b) * cell(i, j, b);
      }
    }
    return 1.0 / std::sqrt(sum);
  };
  Values out(cells.size());
  for (int b = 0; b < kOrientations; ++b) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double sum = 0.0;
        for (const int j : {y - 1, y}) {
          for (const int i : {x - 1, x}) sum += std::min(0.2, cell(x, y, b) * inverse_norm(i, j));
        }
        out[static_cast<std::size_t>((b * height + y) * width + x)] = 0.5 * sum;
      }
    }
  }
  return out;
}

std::vector<float> histograms(const Bytes& luma, imaging::PatchSize size, int cell_px) {
  std::vector<float> out(size.area() / static_cast<std::size_t>(cell_px * cell_px) * kOrientations, -1.0F);
  orientation_histograms(luma, size, cell_px, out);
  return out;
}

struct Question {
  explicit Question(std::mt19937& random)
      : cell_px(random() % 2 == 0 ? 2 : 4),
        size{cell_px * (3 + static_cast<int>(random() % static_cast<unsigned>(64 / cell_px - 2))),
             cell_px * (3 + static_cast<int>(random() % static_cast<unsigned>(64 / cell_px - 2)))},
        luma(size.area()) {}
  int cell_px;
  imaging::PatchSize size;
  Bytes luma;
};

/// Waves of random direction and strength: gradients of every size and orientation, as pictures have them.
void paint_waves(Question& question, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<double> values(question.size.area(), 120.0);
  for (int wave = 0; wave < 5; ++wave) {
    const double angle = 2 * std::numbers::pi * unit(random), length = 5.0 + 30.0 * unit(random);
    const double phase = 6.0 * unit(random), strength = 25.0 * unit(random);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double x = static_cast<double>(i % static_cast<std::size_t>(question.size.width_px));
      const double y = static_cast<double>(i / static_cast<std::size_t>(question.size.width_px));
      values[i] += strength * std::sin((x * std::cos(angle) + y * std::sin(angle)) * 6.283 / length + phase);
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    question.luma[i] = static_cast<std::uint8_t>(std::clamp(std::lround(values[i]), 0L, 255L));
}

// The table knows every second grey level. Where all levels are even it must be exact: noise of any strength, up to what is cut off.
TEST(OrientationHistogramsProperty, AreTheDefinitionOnEvenGreyLevels) {
  std::mt19937 random(41);
  for (int trial = 0; trial < 150; ++trial) {
    Question question(random);
    const unsigned contrast = 1 + static_cast<unsigned>(random() % 128);
    for (auto& value : question.luma) value = static_cast<std::uint8_t>(2 * (random() % contrast));

    const auto out = histograms(question.luma, question.size, question.cell_px);

    const auto expected = naive_histograms(question.luma, question.size, question.cell_px);
    ASSERT_EQ(out.size(), expected.size());
    for (std::size_t i = 0; i < out.size(); ++i) ASSERT_NEAR(out[i], expected[i], 1e-4) << trial << ' ' << i;
  }
}

TEST(OrientationHistogramsProperty, AreNearTheDefinitionOnAnyGreyLevel) {
  std::mt19937 random(42);
  double sum = 0.0;
  std::size_t count = 0, far = 0;
  for (int trial = 0; trial < 150; ++trial) {
    Question question(random);
    paint_waves(question, random);
    const auto out = histograms(question.luma, question.size, question.cell_px);
    const auto expected = naive_histograms(question.luma, question.size, question.cell_px);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double error = std::abs(static_cast<double>(out[i]) - expected[i]);
      ASSERT_GE(out[i], 0.0F);
      ASSERT_LE(out[i], 0.4F + 1e-6F);
      sum += error;
      far += error > 0.1 ? 1 : 0;
    }
    count += out.size();
  }
  // Half a step of the table turns the weakest gradients, and a patch without stronger ones is normalised to full strength.
  EXPECT_LT(sum / static_cast<double>(count), 0.02);
  EXPECT_LT(static_cast<double>(far) / static_cast<double>(count), 0.05);
}

TEST(OrientationHistograms, ARampVotesForItsOwnDirection) {
  for (int bin = 0; bin < kOrientations; ++bin) {
    const double angle = std::numbers::pi * bin / kOrientations;
    const imaging::PatchSize size{16, 16};
    Bytes luma(size.area());
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) {
        const double along = (x - 7.5) * std::cos(angle) + (y - 7.5) * std::sin(angle);
        luma[static_cast<std::size_t>(y * 16 + x)] = static_cast<std::uint8_t>(std::lround(128 + 10 * along));
      }
    }
    const auto out = histograms(luma, size, 4);
    constexpr std::size_t kMiddle = 1 * 4 + 1, kCells = 16;
    for (std::size_t other = 0; other < kOrientations; ++other) {
      if (static_cast<int>(other) == bin) continue;
      EXPECT_GT(out[static_cast<std::size_t>(bin) * kCells + kMiddle], 1.5 * out[other * kCells + kMiddle]) << bin;
    }
  }
}

TEST(OrientationHistograms, AFlatPatchHasNone) {
  for (const float value : histograms(Bytes(64 * 64, 200), {64, 64}, 2)) ASSERT_EQ(value, 0.0F);
}

TEST(OrientationHistogramsProperty, ForgetTheLight) {
  std::mt19937 random(43);
  for (int trial = 0; trial < 50; ++trial) {
    Question question(random);
    for (auto& value : question.luma) value = static_cast<std::uint8_t>(4 * (random() % 30));
    auto darker = question.luma;
    for (auto& value : darker) value = static_cast<std::uint8_t>(value / 2 + 60);

    const auto bright = histograms(question.luma, question.size, question.cell_px);
    const auto dark = histograms(darker, question.size, question.cell_px);

    for (std::size_t i = 0; i < bright.size(); ++i) ASSERT_NEAR(bright[i], dark[i], 0.01) << trial;
  }
}

// The orientations are unsigned: a bright edge on dark is the same as a dark one on bright.
TEST(OrientationHistogramsProperty, AreThoseOfTheNegative) {
  std::mt19937 random(44);
  double sum = 0.0;
  std::size_t count = 0;
  for (int trial = 0; trial < 100; ++trial) {
    Question question(random);
    paint_waves(question, random);
    auto negative = question.luma;
    for (auto& value : negative) value = static_cast<std::uint8_t>(255 - value);

    const auto out = histograms(question.luma, question.size, question.cell_px);
    const auto of_negative = histograms(negative, question.size, question.cell_px);

    for (std::size_t i = 0; i < out.size(); ++i) {
      sum += static_cast<double>(std::abs(out[i] - of_negative[i]));
    }
    count += out.size();
  }
  EXPECT_LT(sum / static_cast<double>(count), 1e-3);
}

TEST(OrientationHistogramsAlloc, NothingAfterTheFirst) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const Bytes luma(64 * 64, 7);
  std::vector<float> out(kMaxHistogramCells * kOrientations);
  orientation_histograms(luma, {64, 64}, 2, out);
  const test::AllocationGuard guard;
  orientation_histograms(luma, {64, 64}, 2, out);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::color
