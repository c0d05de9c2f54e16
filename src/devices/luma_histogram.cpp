#include "src/devices/luma_histogram.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace cgsr::devices {
namespace {

constexpr double kBrightShare = 0.98;
constexpr int kTarget = 200, kMinGood = 180, kMaxGood = 220;

double share(const LumaHistogram& histogram, int from, int to) {
  if (histogram.pixels == 0) return 0.0;
  const auto sum = std::accumulate(histogram.counts.begin() + from, histogram.counts.begin() + to + 1, 0.0);
  return sum / histogram.pixels;
}

}  // namespace

double LumaHistogram::black_share() const {
  return share(*this, 0, kBlack);
}

double LumaHistogram::saturated_share() const {
  return share(*this, kSaturated, 255);
}

int LumaHistogram::quantile(double wanted_share) const {
  double sum = 0.0;
  for (int luma = 0; luma < 255; ++luma) {
    sum += counts[static_cast<std::size_t>(luma)];
    if (sum >= wanted_share * pixels) return luma;
  }
  return 255;
}

LumaHistogram luma_histogram(const ImageView& image) {
  LumaHistogram histogram;
  for (int y = 0; y < image.height_px; ++y) {
    const std::uint8_t* row = image.row(y);
    for (int x = 0; x < image.width_px; ++x) ++histogram.counts[row[2 * static_cast<std::ptrdiff_t>(x)]];
  }
  histogram.pixels = static_cast<std::uint32_t>(image.width_px) * static_cast<std::uint32_t>(image.height_px);
  return histogram;
}

double next_exposure_s(double exposure_s, const LumaHistogram& histogram) {
  const int bright = histogram.quantile(kBrightShare);
  if (bright >= kMinGood && bright <= kMaxGood) return exposure_s;
  if (bright >= LumaHistogram::kSaturated) return exposure_s / 4.0;  // how much is cut off cannot be seen
  const double ratio = static_cast<double>(kTarget - 16) / std::max(1, bright - 16);
  return exposure_s * std::clamp(std::pow(ratio, 2.2), 0.25, 4.0);
}

}  // namespace cgsr::devices
