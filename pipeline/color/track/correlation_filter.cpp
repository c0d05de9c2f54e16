#include "pipeline/color/track/correlation_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::color {
namespace {

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
Spectrum displaced(const Spectrum& spectrum, double dx, double dy) {
  const Phases columns(dx);
  const Phases rows(dy);
  Spectrum moved;
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

/// A cell counts by its share that lies over the object.
void CorrelationFilter::set_support(double width_cells, double height_cells) {
  const auto share = [](int i, double length) {
    const double centre = i + 0.5 - 0.5 * kGrid;
    return std::clamp(0.5 * length + 0.5 - std::abs(centre), 0.0, 1.0);
  };
  for (int y = 0; y < kGrid; ++y) {
    for (int x = 0; x < kGrid; ++x) {
      support_[static_cast<std::size_t>(y * kGrid + x)] =
          static_cast<float>(share(x, width_cells) * share(y, height_cells));
    }
  }
}

void CorrelationFilter::begin(const FilterFeatures& features, double width_cells, double height_cells) {
  set_support(width_cells, height_cells);
  RealGrid peak;
  const double sigma = std::sqrt(width_cells * height_cells) * parameters_.target_width;
  for (int y = 0; y < kGrid; ++y) {
    for (int x = 0; x < kGrid; ++x) {
      const int dx = (x + kGrid / 2) % kGrid - kGrid / 2;
      const int dy = (y + kGrid / 2) % kGrid - kGrid / 2;
      peak[static_cast<std::size_t>(y * kGrid + x)] =
          static_cast<float>(std::exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma)));
    }
  }
  Spectrum unused;
  color::transform(peak, peak, target_, unused);
  for (auto& channel : filter_) channel = {};
  transform(features);
  train(target_, parameters_.first_rounds, 0.0);
}

void CorrelationFilter::learn(const FilterFeatures& features) {
  transform(features);
  train(target_, parameters_.rounds, parameters_.temporal_weight);
}

void CorrelationFilter::learn_last(double dx, double dy) {
  train(displaced(target_, dx, dy), parameters_.rounds, parameters_.temporal_weight);
}

void CorrelationFilter::transform(const FilterFeatures& features) {
  RealGrid a;
  RealGrid b;
  for (std::size_t k = 0; k + 1 < features.size(); k += 2) {
    for (std::size_t i = 0; i < kGridArea; ++i) {
      a[i] = features[k][i] * window_[i];
      b[i] = features[k + 1][i] * window_[i];
    }
    color::transform(a, b, features_[k], features_[k + 1]);
  }
}

/// Both weights are ratios of the mean power, so that contrast and number of channels do not matter.
void CorrelationFilter::train(const Spectrum& target, int rounds, double temporal_weight) {
  power_.fill(0.0F);
  for (const auto& f : features_) {
    for (std::size_t i = 0; i < kGridArea; ++i) power_[i] += f.re[i] * f.re[i] + f.im[i] * f.im[i];
  }
  double mean_power = 1e-6;  // a patch without any contrast teaches nothing
  for (const float power : power_) mean_power += static_cast<double>(power) / kGridArea;

  previous_ = filter_;
  cut_ = filter_;
  for (auto& channel : multiplier_) channel = {};
  const auto support_weight = static_cast<float>(parameters_.support_weight * mean_power);
  for (int round = 0; round < rounds; ++round) {
    fit(target, support_weight, static_cast<float>(temporal_weight * mean_power));
    cut_to_support();
  }
  filter_ = cut_;
}

/// (F F^H + (gamma + mu) I) H = F conj(G) + gamma (C - S) + mu H' at each frequency, with C the cut filter and S the multiplier.
void CorrelationFilter::fit(const Spectrum& target, float support_weight, float temporal_weight) {
  Spectrum product{};  // F^H of the right hand side
  for (std::size_t k = 0; k < features_.size(); ++k) {
    const auto& f = features_[k];
    const auto& c = cut_[k];
    const auto& s = multiplier_[k];
    const auto& before = previous_[k];
    auto& h = filter_[k];
    for (std::size_t i = 0; i < kGridArea; ++i) {
      const float re = f.re[i] * target.re[i] + f.im[i] * target.im[i] + support_weight * (c.re[i] - s.re[i]) +
                       temporal_weight * before.re[i];
      const float im = f.im[i] * target.re[i] - f.re[i] * target.im[i] + support_weight * (c.im[i] - s.im[i]) +
                       temporal_weight * before.im[i];
      h.re[i] = re;
      h.im[i] = im;
      product.re[i] += f.re[i] * re + f.im[i] * im;
      product.im[i] += f.re[i] * im - f.im[i] * re;
    }
  }
  const float diagonal = support_weight + temporal_weight;
  for (std::size_t i = 0; i < kGridArea; ++i) {
    const float scale = 1.0F / (diagonal + power_[i]);
    product.re[i] *= scale;
    product.im[i] *= scale;
  }
  const float inverse_diagonal = 1.0F / diagonal;
  for (std::size_t k = 0; k < features_.size(); ++k) {
    const auto& f = features_[k];
    auto& h = filter_[k];
    for (std::size_t i = 0; i < kGridArea; ++i) {
      h.re[i] = inverse_diagonal * (h.re[i] - (f.re[i] * product.re[i] - f.im[i] * product.im[i]));
      h.im[i] = inverse_diagonal * (h.im[i] - (f.re[i] * product.im[i] + f.im[i] * product.re[i]));
    }
  }
}

/// C = H + S without what lies beside the object, S += H - C.
void CorrelationFilter::cut_to_support() {
  RealGrid a;
  RealGrid b;
  for (std::size_t k = 0; k + 1 < filter_.size(); k += 2) {
    for (std::size_t channel = k; channel < k + 2; ++channel) {
      auto& s = multiplier_[channel];
      const auto& h = filter_[channel];
      for (std::size_t i = 0; i < kGridArea; ++i) {
        s.re[i] += h.re[i];
        s.im[i] += h.im[i];
      }
    }
    color::inverse_transform(multiplier_[k], multiplier_[k + 1], a, b);
    for (std::size_t i = 0; i < kGridArea; ++i) {
      a[i] *= support_[i];
      b[i] *= support_[i];
    }
    color::transform(a, b, cut_[k], cut_[k + 1]);
    for (std::size_t channel = k; channel < k + 2; ++channel) {
      auto& s = multiplier_[channel];
      const auto& c = cut_[channel];
      for (std::size_t i = 0; i < kGridArea; ++i) {
        s.re[i] -= c.re[i];
        s.im[i] -= c.im[i];
      }
    }
  }
}

void CorrelationFilter::respond(const FilterFeatures& features, RealGrid& response) {
  transform(features);
  Spectrum answer{};
  for (std::size_t k = 0; k < features_.size(); ++k) {
    const auto& f = features_[k];
    const auto& h = filter_[k];
    for (std::size_t i = 0; i < kGridArea; ++i) {
      answer.re[i] += h.re[i] * f.re[i] + h.im[i] * f.im[i];
      answer.im[i] += h.re[i] * f.im[i] - h.im[i] * f.re[i];
    }
  }
  RealGrid shifted;
  color::inverse_transform(answer, shifted);
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
