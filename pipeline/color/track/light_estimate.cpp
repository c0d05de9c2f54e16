#include "pipeline/color/track/light_estimate.h"

#include <algorithm>
#include <cmath>

namespace cgsr::color {
namespace {

constexpr int kRounds = 4;
constexpr double kSaturated = 250.0 / 255.0;
constexpr double kBlack = 4.0 / 255.0;
constexpr double kNoise = 3.0 / 255.0;  // differences below this all weigh the same

using Histogram = std::array<int, 256>;

/// Neither cut off nor black.
bool is_measurable(double learned, double seen) {
  return seen <= kSaturated && seen >= kBlack && learned >= kBlack;
}

/// The quantiles (i + 0.5) / 32 of a histogram, interpolated within a bin.
std::array<double, ChannelQuantiles::kCount> quantiles_of(const Histogram& histogram, int count) {
  std::array<double, ChannelQuantiles::kCount> quantiles{};
  std::size_t value = 0;
  int below = histogram[0];
  for (std::size_t i = 0; i < quantiles.size(); ++i) {
    const double wanted = count * (static_cast<double>(i) + 0.5) / static_cast<double>(quantiles.size());
    while (below < wanted && value < 255) below += histogram[++value];
    const int here = histogram[value];
    const double within = here > 0 ? (wanted - (below - here)) / here : 0.5;
    quantiles[i] = (static_cast<double>(value) - 0.5 + within) / 255.0;
  }
  return quantiles;
}

double gain_of(const std::array<double, ChannelQuantiles::kCount>& learned,
               const std::array<double, ChannelQuantiles::kCount>& seen) {
  std::array<double, ChannelQuantiles::kCount> weights;
  weights.fill(1.0);
  double gain = 1.0;
  for (int round = 0; round < kRounds; ++round) {
    double product = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (!is_measurable(learned[i], seen[i])) continue;
      product += weights[i] * learned[i] * seen[i];
      square += weights[i] * learned[i] * learned[i];
    }
    gain = square > 0.0 ? product / square : 1.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      weights[i] = 1.0 / std::max(kNoise, std::abs(seen[i] - gain * learned[i]));
    }
  }
  return gain;
}

double residual_of(const std::array<double, ChannelQuantiles::kCount>& learned,
                   const std::array<double, ChannelQuantiles::kCount>& seen, double gain) {
  double difference = 0.0;
  double brightness = 0.0;
  for (std::size_t i = 0; i < learned.size(); ++i) {
    if (!is_measurable(learned[i], seen[i])) continue;
    difference += std::abs(seen[i] - gain * learned[i]);
    brightness += seen[i];
  }
  return brightness > 0.0 ? difference / brightness : 1.0;
}

}  // namespace

ChannelQuantiles channel_quantiles(const ObjectView& view) {
  std::array<Histogram, 3> histograms{};
  for (std::size_t i = 0; i < view.y.size(); ++i) {
    const auto rgb = imaging::rgb_of_yuv(view.y[i], view.u[i], view.v[i]);
    ++histograms[0][static_cast<std::size_t>(rgb.r * 255.0)];
    ++histograms[1][static_cast<std::size_t>(rgb.g * 255.0)];
    ++histograms[2][static_cast<std::size_t>(rgb.b * 255.0)];
  }
  ChannelQuantiles quantiles;
  for (std::size_t k = 0; k < 3; ++k)
    quantiles.values[k] = quantiles_of(histograms[k], static_cast<int>(view.y.size()));
  return quantiles;
}

Light light_gain(const ChannelQuantiles& learned, const ChannelQuantiles& seen) {
  return {gain_of(learned.values[0], seen.values[0]), gain_of(learned.values[1], seen.values[1]),
          gain_of(learned.values[2], seen.values[2])};
}

MeasuredGain measured_gain(const ChannelQuantiles& learned, const ChannelQuantiles& seen) {
  const Light gain = light_gain(learned, seen);
  return {
      gain,
      {residual_of(learned.values[0], seen.values[0], gain.r), residual_of(learned.values[1], seen.values[1], gain.g),
       residual_of(learned.values[2], seen.values[2], gain.b)}};
}

Light nearest_of(const ColorModel& model, const Light& light) {
  const auto distance = [&light](const Light& other) {
    return std::abs(other.r - light.r) + std::abs(other.g - light.g) + std::abs(other.b - light.b);
  };
  return *std::min_element(model.lights.begin(), model.lights.end(),
                           [&](const Light& a, const Light& b) { return distance(a) < distance(b); });
}

}  // namespace cgsr::color
