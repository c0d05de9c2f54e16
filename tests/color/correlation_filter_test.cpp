#include "pipeline/color/track/correlation_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
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

/// The filter as its header writes it, in double and with the definition of the transform: what the fast one is held against.
class PlainFilter {
 public:
  PlainFilter(const CorrelationParameters& parameters, double width, double height)
      : parameters_(parameters),
        width_(width),
        height_(height),
        filter_(kFilterChannels, Complexes(kGridArea)),
        target_(transformed(peak(std::sqrt(width * height) * parameters.target_width), -1.0)) {}

  void train(const FilterFeatures& features, int rounds, double temporal_weight) {
    const auto f = spectra_of(features);
    double power = 0.0;
    for (const auto& channel : f) {
      for (const auto& value : channel) power += std::norm(value) / kGridArea;
    }
    const double gamma = parameters_.support_weight * power;
    const double mu = temporal_weight * power;
    const auto previous = filter_;
    auto cut = filter_;
    std::vector<Complexes> multiplier(f.size(), Complexes(kGridArea));
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t i = 0; i < kGridArea; ++i) {
        Eigen::VectorXcd x(kFilterChannels), right(kFilterChannels);
        for (Eigen::Index k = 0; k < kFilterChannels; ++k) {
          const auto c = static_cast<std::size_t>(k);
          x(k) = f[c][i];
          right(k) = f[c][i] * std::conj(target_[i]) + gamma * (cut[c][i] - multiplier[c][i]) + mu * previous[c][i];
        }
        Eigen::MatrixXcd matrix = x * x.adjoint();
        matrix.diagonal().array() += gamma + mu;
        const Eigen::VectorXcd h = matrix.llt().solve(right);
        for (Eigen::Index k = 0; k < kFilterChannels; ++k) filter_[static_cast<std::size_t>(k)][i] = h(k);
      }
      for (std::size_t k = 0; k < f.size(); ++k) {
        for (std::size_t i = 0; i < kGridArea; ++i) multiplier[k][i] += filter_[k][i];
        auto space = transformed(multiplier[k], 1.0);
        for (int y = 0; y < kGrid; ++y) {
          for (int x = 0; x < kGrid; ++x) space[at(x, y)] *= covered(x, width_) * covered(y, height_) / kGridArea;
        }
        cut[k] = transformed(space, -1.0);
        for (std::size_t i = 0; i < kGridArea; ++i) multiplier[k][i] -= cut[k][i];
      }
    }
    filter_ = cut;
  }

  /// The response of every displacement, none being in the middle.
  [[nodiscard]] std::vector<double> respond(const FilterFeatures& features) const {
    const auto f = spectra_of(features);
    Complexes answer(kGridArea);
    for (std::size_t k = 0; k < f.size(); ++k) {
      for (std::size_t i = 0; i < kGridArea; ++i) answer[i] += std::conj(filter_[k][i]) * f[k][i];
    }
    const auto space = transformed(answer, 1.0);
    std::vector<double> response(kGridArea);
    for (int y = 0; y < kGrid; ++y) {
      for (int x = 0; x < kGrid; ++x) {
        response[at(x, y)] = space[at((x + kGrid / 2) % kGrid, (y + kGrid / 2) % kGrid)].real() / kGridArea;
      }
    }
    return response;
  }

 private:
  static Complexes peak(double sigma) {
    Complexes grid(kGridArea);
    for (int y = 0; y < kGrid; ++y) {
      for (int x = 0; x < kGrid; ++x) {
        const double dx = std::min(x, kGrid - x), dy = std::min(y, kGrid - y);
        grid[at(x, y)] = std::exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma));
      }
    }
    return grid;
  }
  /// Share of the cell [i, i + 1] that lies within a length about the middle.
  static double covered(int i, double length) {
    return std::clamp(0.5 * length + 0.5 - std::abs(i + 0.5 - kGrid / 2), 0.0, 1.0);
  }

  CorrelationParameters parameters_;
  double width_, height_;
  std::vector<Complexes> filter_;
  Complexes target_;
};

TEST(CorrelationFilterProperty, IsTheFormula) {
  std::mt19937 random(51);
  for (int trial = 0; trial < 3; ++trial) {
    CorrelationParameters parameters;
    parameters.support_weight = trial == 1 ? 0.2 : 1.0;
    parameters.temporal_weight = trial == 2 ? 0.5 : 4.0;
    const double width = 8.0 + 1.5 * trial, height = 11.0;
    const World world(random), other(random);
    const FilterFeatures first = world.moved(0, 0), second = other.moved(0, 0), asked = world.moved(2, -1);
    const auto filter = std::make_unique<CorrelationFilter>(parameters);
    RealGrid response;

    filter->begin(first, width, height);
    filter->learn(second);
    filter->respond(asked, response);

    PlainFilter plain(parameters, width, height);
    plain.train(first, parameters.first_rounds, 0.0);
    plain.train(second, parameters.rounds, parameters.temporal_weight);
    const auto expected = plain.respond(asked);
    for (std::size_t i = 0; i < kGridArea; ++i) ASSERT_NEAR(response[i], expected[i], 1e-4) << trial << " at " << i;
  }
}

// What moves with the camera around the object is not the object: the filter follows what was in the box.
TEST(CorrelationFilterProperty, LearnsNothingBesideTheObject) {
  std::mt19937 random(57);
  const auto filter = std::make_unique<CorrelationFilter>(CorrelationParameters{});
  for (int trial = 0; trial < 30; ++trial) {
    const World object(random), before(random), after(random);
    const auto scene = [&](const World& background, int dx, int dy) {
      FilterFeatures features = background.moved(0, 0);
      const FilterFeatures moved = object.moved(dx, dy);
      for (std::size_t k = 0; k < features.size(); ++k) {
        for (int y = 11 + dy; y < 21 + dy; ++y) {
          for (int x = 11 + dx; x < 21 + dx; ++x) features[k][at(x, y)] = moved[k][at(x, y)];
        }
      }
      return features;
    };
    const int dx = static_cast<int>(random() % 11) - 5, dy = static_cast<int>(random() % 11) - 5;
    RealGrid response;
    filter->begin(scene(before, 0, 0), 10.0, 10.0);

    filter->respond(scene(after, dx, dy), response);

    const Peak peak = peak_of(response);
    ASSERT_NEAR(peak.x, 16.0 + dx, 0.6) << trial;
    ASSERT_NEAR(peak.y, 16.0 + dy, 0.6) << trial;
  }
}

TEST(CorrelationFilterProperty, PeaksWhereTheObjectMoved) {
  std::mt19937 random(52);
  const auto filter = std::make_unique<CorrelationFilter>(CorrelationParameters{});
  for (int trial = 0; trial < 150; ++trial) {
    const World world(random), other(random);
    const int dx = static_cast<int>(random() % 17) - 8, dy = static_cast<int>(random() % 17) - 8;
    RealGrid response;
    filter->begin(world.moved(0, 0), 11.0, 11.0);

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
    parameters.temporal_weight = 0.5;
    const auto filter = std::make_unique<CorrelationFilter>(parameters);
    filter->begin(world.moved(0, 0), 10.0, 10.0);
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
  filter->begin(world.moved(0, 0), 16.0, 16.0);  // peak one cell wide
  filter->respond(world.moved(0, 0), response);
  const float peak = response[at(16, 16)];  // below 1: what would make it so lies beside the object as well
  EXPECT_GT(peak, 0.8F);
  EXPECT_LT(peak, 1.05F);
  EXPECT_NEAR(response[at(17, 16)] / peak, std::exp(-0.5), 0.05);
  EXPECT_NEAR(response[at(16, 14)] / peak, std::exp(-2.0), 0.05);
  EXPECT_NEAR(response[at(4, 25)], 0.0, 0.05);
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
  filter->begin(*features, 11.0, 11.0);
  filter->learn(*features);
  filter->respond(*features, response);
  filter->learn_last(1.0, 0.5);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::color
