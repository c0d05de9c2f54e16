#include "pipeline/color/track/correlation_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/allocation_guard.h"

namespace cgsr::color {
namespace {

using imaging::kGrid;
using imaging::kGridArea;
using imaging::RealGrid;
using Complexes = std::vector<std::complex<double>>;

std::size_t at(int x, int y) {
  return static_cast<std::size_t>(y * kGrid + x);
}

/// A world of random cells, larger than a patch, so that a patch can be taken from another place.
class World {
 public:
  explicit World(std::mt19937& random) : cells_(kFilterChannels * kSide * kSide) {
    std::uniform_real_distribution<float> value(-0.3F, 0.3F);
    for (float& cell : cells_) cell = value(random);
  }
  /// What is seen when everything moved by (dx, dy) cells.
  [[nodiscard]] FilterFeatures moved(int dx, int dy) const {
    FilterFeatures features;
    for (std::size_t k = 0; k < features.size(); ++k) {
      for (int y = 0; y < kGrid; ++y) {
        for (int x = 0; x < kGrid; ++x) {
          const auto row = static_cast<std::size_t>(y - dy + kMargin),
                     column = static_cast<std::size_t>(x - dx + kMargin);
          features[k][at(x, y)] = cells_[(k * kSide + row) * kSide + column];
        }
      }
    }
    return features;
  }

 private:
  static constexpr int kMargin = 16;
  static constexpr std::size_t kSide = kGrid + 2 * kMargin;
  std::vector<float> cells_;
};

Complexes transformed(const Complexes& grid, double sign) {
  const auto turn = [sign](int k, int n) {
    return std::polar(1.0, sign * 2.0 * std::numbers::pi * (k * n % kGrid) / kGrid);
  };
  Complexes rows(kGridArea), all(kGridArea);
  for (int y = 0; y < kGrid; ++y) {
    for (int k = 0; k < kGrid; ++k) {
      for (int x = 0; x < kGrid; ++x) rows[at(k, y)] += grid[at(x, y)] * turn(k, x);
    }
  }
  for (int x = 0; x < kGrid; ++x) {
    for (int k = 0; k < kGrid; ++k) {
      for (int y = 0; y < kGrid; ++y) all[at(x, k)] += rows[at(x, y)] * turn(k, y);
    }
  }
  return all;
}

std::vector<Complexes> spectra_of(const FilterFeatures& features) {
  std::vector<Complexes> spectra;
  const auto hann = [](int i) { return 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (i + 0.5) / kGrid); };
  for (const auto& channel : features) {
    Complexes windowed(kGridArea);
    for (int y = 0; y < kGrid; ++y) {
      for (int x = 0; x < kGrid; ++x) windowed[at(x, y)] = static_cast<double>(channel[at(x, y)]) * hann(x) * hann(y);
    }
    spectra.push_back(transformed(windowed, -1.0));
  }
  return spectra;
}

// R, A and B as the header writes them, in double; the response with no displacement in the middle.
TEST(CorrelationFilterProperty, IsTheFormula) {
  std::mt19937 random(51);
  for (int trial = 0; trial < 6; ++trial) {
    CorrelationParameters parameters;
    parameters.learning_rate = 0.3;
    parameters.anchor = trial % 3 * 0.4;
    const double object_cells = 8.0 + trial;
    const World world(random), other(random);
    const FilterFeatures first = world.moved(0, 0), second = other.moved(0, 0), asked = world.moved(2, -1);
    const auto filter = std::make_unique<CorrelationFilter>(parameters);
    RealGrid response;

    filter->begin(first, object_cells);
    filter->learn(second);
    filter->respond(asked, response);

    Complexes peak(kGridArea);
    for (int y = 0; y < kGrid; ++y) {
      for (int x = 0; x < kGrid; ++x) {
        const double dx = std::min(x, kGrid - x), dy = std::min(y, kGrid - y), sigma = object_cells * 0.0625;
        peak[at(x, y)] = std::exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma));
      }
    }
    const auto g = transformed(peak, -1.0);
    const auto f1 = spectra_of(first), f2 = spectra_of(second), f = spectra_of(asked);
    const double rate = parameters.learning_rate, anchor = parameters.anchor;
    Complexes answer(kGridArea);
    for (std::size_t i = 0; i < kGridArea; ++i) {
      double b1 = 0.0, b2 = 0.0;
      for (std::size_t k = 0; k < kFilterChannels; ++k) {
        const auto a1 = std::conj(g[i]) * f1[k][i];
        const auto a = (1 - rate) * a1 + rate * std::conj(g[i]) * f2[k][i];
        answer[i] += std::conj((1 - anchor) * a + anchor * a1) * f[k][i];
        b1 += std::norm(f1[k][i]);
        b2 += std::norm(f2[k][i]);
      }
      const double b = (1 - anchor) * ((1 - rate) * b1 + rate * b2) + anchor * b1;
      answer[i] /= b + parameters.regularisation;
    }
    const auto expected = transformed(answer, 1.0);
    for (int y = 0; y < kGrid; ++y) {
      for (int x = 0; x < kGrid; ++x) {
        const double value = expected[at((x + kGrid / 2) % kGrid, (y + kGrid / 2) % kGrid)].real() / kGridArea;
        ASSERT_NEAR(response[at(x, y)], value, 1e-4) << trial << " at " << x << ',' << y;
      }
    }
  }
}

TEST(CorrelationFilterProperty, PeaksWhereTheObjectMoved) {
  std::mt19937 random(52);
  const auto filter = std::make_unique<CorrelationFilter>(CorrelationParameters{});
  for (int trial = 0; trial < 150; ++trial) {
    const World world(random), other(random);
    const int dx = static_cast<int>(random() % 17) - 8, dy = static_cast<int>(random() % 17) - 8;
    RealGrid response;
    filter->begin(world.moved(0, 0), 11.0);

    filter->respond(world.moved(dx, dy), response);
    const Peak there = peak_of(response);
    filter->respond(other.moved(0, 0), response);
    const Peak elsewhere = peak_of(response);

    ASSERT_NEAR(there.x, kGrid / 2 + dx, 0.5) << trial;
    ASSERT_NEAR(there.y, kGrid / 2 + dy, 0.5) << trial;
    ASSERT_GT(there.sharpness, 1.5 * elsewhere.sharpness) << dx << ',' << dy;
    ASSERT_GT(there.value, 1.5 * elsewhere.value) << dx << ',' << dy;
  }
}

// A patch in which the object is beside the middle teaches the same, when the filter is told where the object is.
TEST(CorrelationFilterProperty, LearnsTheLastPatchWhereTheObjectIs) {
  std::mt19937 random(55);
  for (const auto& [dx, dy] : {std::pair{0, 0}, {2, 0}, {0, -2}, {-1, 2}}) {
    const World world(random);
    const World learned(random);
    CorrelationParameters parameters;
    parameters.learning_rate = 0.5;
    parameters.anchor = 0.0;
    const auto filter = std::make_unique<CorrelationFilter>(parameters);
    filter->begin(world.moved(0, 0), 10.0);
    RealGrid response;
    for (int i = 0; i < 12; ++i) {
      filter->respond(learned.moved(dx, dy), response);
      filter->learn_last(dx, dy);
    }
    filter->respond(learned.moved(0, 0), response);
    const Peak peak = peak_of(response);
    EXPECT_NEAR(peak.x, 16.0, 0.25) << dx << ',' << dy;
    EXPECT_NEAR(peak.y, 16.0, 0.25) << dx << ',' << dy;
    EXPECT_GT(peak.value, 0.7) << dx << ',' << dy;
  }
}

TEST(CorrelationFilter, AnswersWhatItLearnedWithThePeakItWasTold) {
  std::mt19937 random(53);
  const World world(random);
  const auto filter = std::make_unique<CorrelationFilter>(CorrelationParameters{});
  RealGrid response;
  filter->begin(world.moved(0, 0), 16.0);  // peak one cell wide
  filter->respond(world.moved(0, 0), response);
  EXPECT_NEAR(response[at(16, 16)], 1.0, 0.05);
  EXPECT_NEAR(response[at(17, 16)], std::exp(-0.5), 0.05);
  EXPECT_NEAR(response[at(16, 14)], std::exp(-2.0), 0.05);
  EXPECT_NEAR(response[at(4, 25)], 0.0, 0.05);
}

TEST(CorrelationFilterProperty, ForgettingIsAsIfOnlyTheFirstHadBeenSeen) {
  std::mt19937 random(54);
  const auto filter = std::make_unique<CorrelationFilter>(CorrelationParameters{});
  for (int trial = 0; trial < 20; ++trial) {
    const World world(random), other(random);
    RealGrid before, learned, after;
    filter->begin(world.moved(0, 0), 11.0);
    filter->respond(world.moved(3, 3), before);
    for (int i = 0; i < 5; ++i) filter->learn(other.moved(0, 0));
    filter->respond(world.moved(3, 3), learned);

    filter->forget();
    filter->respond(world.moved(3, 3), after);

    EXPECT_NE(before, learned);
    EXPECT_EQ(before, after);
  }
}

TEST(PeakProperty, IsFoundToAFractionOfACell) {
  std::mt19937 random(55);
  std::uniform_real_distribution<double> place(1.5, kGrid - 2.5);
  std::uniform_real_distribution<float> noise(-0.01F, 0.01F);
  for (int trial = 0; trial < 500; ++trial) {
    const double x0 = place(random), y0 = place(random), sigma = 1.5;
    RealGrid response;
    for (int y = 0; y < kGrid; ++y) {
      for (int x = 0; x < kGrid; ++x) {
        const double squared = (x - x0) * (x - x0) + (y - y0) * (y - y0);
        response[at(x, y)] = 0.8F * static_cast<float>(std::exp(-0.5 * squared / (sigma * sigma))) + noise(random);
      }
    }
    const Peak peak = peak_of(response);
    ASSERT_NEAR(peak.x, x0, 0.12) << trial;
    ASSERT_NEAR(peak.y, y0, 0.12) << trial;
    ASSERT_NEAR(peak.value, 0.8, 0.12) << trial;
  }
}

TEST(Peak, SharpnessIsPeakToSidelobeRatio) {
  RealGrid response;
  for (int y = 0; y < kGrid; ++y) {
    for (int x = 0; x < kGrid; ++x) response[at(x, y)] = (x + y) % 2 == 0 ? 0.1F : 0.3F;  // mean 0.2, deviation 0.1
  }
  for (int y = 7; y <= 13; ++y) {
    for (int x = 17; x <= 23; ++x) response[at(x, y)] = 0.5F;  // the main lobe does not count
  }
  response[at(20, 10)] = 1.2F;
  const Peak peak = peak_of(response);
  EXPECT_NEAR(peak.sharpness, 10.0, 0.05);
  EXPECT_NEAR(peak.value, 1.2, 1e-6);
}

TEST(Peak, InTheCornerOrOnAPlainStaysInside) {
  RealGrid response{};
  EXPECT_EQ(peak_of(response).value, 0.0);
  response[at(31, 0)] = 1.0F;
  const Peak peak = peak_of(response);
  EXPECT_EQ(peak.x, 31.0);
  EXPECT_EQ(peak.y, 0.0);
}

TEST(CorrelationFilterAlloc, NothingAfterConstruction) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  std::mt19937 random(56);
  const auto features = std::make_unique<FilterFeatures>(World(random).moved(0, 0));
  const auto filter = std::make_unique<CorrelationFilter>(CorrelationParameters{});
  RealGrid response;
  const test::AllocationGuard guard;
  filter->begin(*features, 11.0);
  filter->learn(*features);
  filter->respond(*features, response);
  filter->forget();
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::color
