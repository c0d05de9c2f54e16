#include "pipeline/color/track/correlation_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::color {
namespace {

using imaging::kGrid;
using imaging::kGridArea;
using imaging::RealGrid;

float hann(int i) {
  return static_cast<float>(0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (i + 0.5) / kGrid));
}

/// exp(-2 pi i k d / 32) for every frequency k, those above the middle being negative ones.
struct Phases {
  std::array<float, kGrid> re;
  std::array<float, kGrid> im;
  explicit Phases(double displacement) {
    for (int k = 0; k < kGrid; ++k) {
      const int frequency = k < kGrid / 2 ? k : k - kGrid;
      const double angle = -2.0 * std::numbers::pi * frequency * displacement / kGrid;
      re[static_cast<std::size_t>(k)] = static_cast<float>(std::cos(angle));
      im[static_cast<std::size_t>(k)] = static_cast<float>(std::sin(angle));
    }
  }
};

/// The spectrum of the same grid moved by (dx, dy) cells.
imaging::Spectrum displaced(const imaging::Spectrum& spectrum, double dx, double dy) {
  const Phases columns(dx);
  const Phases rows(dy);
  imaging::Spectrum moved;
  for (std::size_t y = 0; y < kGrid; ++y) {
    for (std::size_t x = 0; x < kGrid; ++x) {
      const std::size_t i = y * kGrid + x;
      const float re = columns.re[x] * rows.re[y] - columns.im[x] * rows.im[y];
      const float im = columns.re[x] * rows.im[y] + columns.im[x] * rows.re[y];
      moved.re[i] = spectrum.re[i] * re - spectrum.im[i] * im;
      moved.im[i] = spectrum.re[i] * im + spectrum.im[i] * re;
    }
  }
  return moved;
}

/// Where a parabola through three neighbours peaks, relative to the middle one.
double vertex(double before, double at, double after) {
  const double curvature = before - 2.0 * at + after;
  if (curvature >= -1e-9) return 0.0;
  return std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
}

}  // namespace

CorrelationFilter::CorrelationFilter(const CorrelationParameters& parameters) : parameters_(parameters) {
  for (int y = 0; y < kGrid; ++y) {
    for (int x = 0; x < kGrid; ++x) window_[static_cast<std::size_t>(y * kGrid + x)] = hann(x) * hann(y);
  }
}

void CorrelationFilter::begin(const FilterFeatures& features, double object_cells) {
  RealGrid peak;
  const double sigma = object_cells * parameters_.target_width;
  for (int y = 0; y < kGrid; ++y) {
    for (int x = 0; x < kGrid; ++x) {
      const int dx = (x + kGrid / 2) % kGrid - kGrid / 2;
      const int dy = (y + kGrid / 2) % kGrid - kGrid / 2;
      peak[static_cast<std::size_t>(y * kGrid + x)] =
          static_cast<float>(std::exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma)));
    }
  }
  imaging::Spectrum unused;
  imaging::transform(peak, peak, target_, unused);
  for (auto& channel : numerator_) channel = {};
  denominator_.fill(0.0F);
  transform(features);
  absorb(target_, 1.0F);
  first_numerator_ = numerator_;
  first_denominator_ = denominator_;
}

void CorrelationFilter::learn(const FilterFeatures& features) {
  transform(features);
  absorb(target_, static_cast<float>(parameters_.learning_rate));
}

void CorrelationFilter::learn_last(double dx, double dy) {
  absorb(displaced(target_, dx, dy), static_cast<float>(parameters_.learning_rate));
}

void CorrelationFilter::forget() {
  numerator_ = first_numerator_;
  denominator_ = first_denominator_;
}

void CorrelationFilter::transform(const FilterFeatures& features) {
  RealGrid a;
  RealGrid b;
  for (std::size_t k = 0; k + 1 < features.size(); k += 2) {
    for (std::size_t i = 0; i < kGridArea; ++i) {
      a[i] = features[k][i] * window_[i];
      b[i] = features[k + 1][i] * window_[i];
    }
    imaging::transform(a, b, features_[k], features_[k + 1]);
  }
}

void CorrelationFilter::absorb(const imaging::Spectrum& target, float rate) {
  const float keep = 1.0F - rate;
  RealGrid power{};
  for (std::size_t k = 0; k < features_.size(); ++k) {
    const auto& f = features_[k];
    auto& a = numerator_[k];
    for (std::size_t i = 0; i < kGridArea; ++i) {
      a.re[i] = keep * a.re[i] + rate * (target.re[i] * f.re[i] + target.im[i] * f.im[i]);
      a.im[i] = keep * a.im[i] + rate * (target.re[i] * f.im[i] - target.im[i] * f.re[i]);
      power[i] += f.re[i] * f.re[i] + f.im[i] * f.im[i];
    }
  }
  for (std::size_t i = 0; i < kGridArea; ++i) denominator_[i] = keep * denominator_[i] + rate * power[i];
}

void CorrelationFilter::respond(const FilterFeatures& features, RealGrid& response) {
  transform(features);
  const auto anchor = static_cast<float>(parameters_.anchor);
  const float free = 1.0F - anchor;
  imaging::Spectrum answer{};
  for (std::size_t k = 0; k < features_.size(); ++k) {
    const auto& f = features_[k];
    const auto& a = numerator_[k];
    const auto& first = first_numerator_[k];
    for (std::size_t i = 0; i < kGridArea; ++i) {
      const float re = free * a.re[i] + anchor * first.re[i];
      const float im = free * a.im[i] + anchor * first.im[i];
      answer.re[i] += re * f.re[i] + im * f.im[i];
      answer.im[i] += re * f.im[i] - im * f.re[i];
    }
  }
  const auto regularisation = static_cast<float>(parameters_.regularisation);
  for (std::size_t i = 0; i < kGridArea; ++i) {
    const float scale = 1.0F / (free * denominator_[i] + anchor * first_denominator_[i] + regularisation);
    answer.re[i] *= scale;
    answer.im[i] *= scale;
  }
  RealGrid shifted;
  imaging::inverse_transform(answer, shifted);
  for (int y = 0; y < kGrid; ++y) {  // no displacement goes to the middle
    for (int x = 0; x < kGrid; ++x) {
      const int to = (y + kGrid / 2) % kGrid * kGrid + (x + kGrid / 2) % kGrid;
      response[static_cast<std::size_t>(to)] = shifted[static_cast<std::size_t>(y * kGrid + x)];
    }
  }
}

Peak peak_of(const RealGrid& response) {
  const auto highest = std::max_element(response.begin(), response.end());
  const int at = static_cast<int>(highest - response.begin());
  const int x = at % kGrid;
  const int y = at / kGrid;
  const auto value = [&response](int i) { return static_cast<double>(response[static_cast<std::size_t>(i)]); };
  Peak peak{static_cast<double>(x), static_cast<double>(y), value(at), 0.0};
  if (x > 0 && x < kGrid - 1) peak.x += vertex(value(at - 1), value(at), value(at + 1));
  if (y > 0 && y < kGrid - 1) peak.y += vertex(value(at - kGrid), value(at), value(at + kGrid));

  constexpr int kMainLobe = 3;
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  for (int j = 0; j < kGrid; ++j) {
    for (int i = 0; i < kGrid; ++i) {
      if (std::abs(i - x) <= kMainLobe && std::abs(j - y) <= kMainLobe) continue;
      const double v = value(j * kGrid + i);
      sum += v;
      squares += v * v;
      ++count;
    }
  }
  const double mean = sum / count;
  const double deviation = std::sqrt(std::max(1e-12, squares / count - mean * mean));
  peak.sharpness = (peak.value - mean) / deviation;
  return peak;
}

}  // namespace cgsr::color
