#include "pipeline/person/colors/color_histogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cgsr::person {
namespace {

constexpr int kSide = ColorHistogram::kPerChannel;
constexpr std::size_t kBins = std::size_t{kSide} * kSide * kSide;
constexpr std::uint32_t kMaxTotal = 20000;  // then everything is halved

int level_of(double channel) {
  return std::clamp(static_cast<int>(channel * kSide), 0, kSide - 1);
}

std::size_t bin_of(int r, int g, int b) {
  return (static_cast<std::size_t>(r) * kSide + static_cast<std::size_t>(g)) * kSide + static_cast<std::size_t>(b);
}

}  // namespace

void ColorHistogram::add(std::span<const imaging::Rgb> samples) {
  if (samples.empty()) return;
  counts_.resize(kBins);
  for (const imaging::Rgb& color : samples) {
    std::uint16_t& count = counts_[bin_of(level_of(color.r), level_of(color.g), level_of(color.b))];
    if (count == std::numeric_limits<std::uint16_t>::max()) continue;
    ++count;
    ++total_;
  }
  while (total_ > kMaxTotal) fade();
}

void ColorHistogram::clear() {
  std::fill(counts_.begin(), counts_.end(), std::uint16_t{0});
  total_ = 0;
}

void ColorHistogram::fade() {
  total_ = 0;
  for (std::uint16_t& count : counts_) {
    count = static_cast<std::uint16_t>(count / 2);
    total_ += count;
  }
}

double ColorHistogram::share(const imaging::Rgb& color) const {
  if (total_ == 0) return 0.0;
  const int r = level_of(color.r), g = level_of(color.g), b = level_of(color.b);
  std::uint32_t sum = 0;
  for (int i = std::max(0, r - 1); i <= std::min(kSide - 1, r + 1); ++i) {
    for (int j = std::max(0, g - 1); j <= std::min(kSide - 1, g + 1); ++j) {
      for (int k = std::max(0, b - 1); k <= std::min(kSide - 1, b + 1); ++k) sum += counts_[bin_of(i, j, k)];
    }
  }
  return static_cast<double>(sum) / total_;
}

imaging::Rgb ColorHistogram::bright_level() const {
  std::array<std::array<std::uint32_t, kSide>, 3> levels{};
  for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
    if (counts_[bin] == 0) continue;
    levels[0][bin / (kSide * kSide)] += counts_[bin];
    levels[1][bin / kSide % kSide] += counts_[bin];
    levels[2][bin % kSide] += counts_[bin];
  }
  std::array<double, 3> bright{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::uint32_t above = 0;
    int level = kSide - 1;
    while (level > 0 && (above += levels[channel][static_cast<std::size_t>(level)]) * 50 < total_) --level;
    bright[channel] = (level + 1.0) / kSide;
  }
  return {bright[0], bright[1], bright[2]};
}

std::vector<imaging::Rgb> region_colors(const ImageView& image, const Box& region) {
  std::vector<imaging::Rgb> colors;
  if (image.empty() || image.format != PixelFormat::kYuyv || region.empty()) return colors;
  const int x0 = std::max(0, static_cast<int>(region.x) & ~1);
  const int y0 = std::max(0, static_cast<int>(region.y));
  const int x1 = std::min<int>(image.width_px, static_cast<int>(std::ceil(region.x + region.width)));
  const int y1 = std::min<int>(image.height_px, static_cast<int>(std::ceil(region.y + region.height)));
  for (int y = y0; y + 1 < y1; y += 2) {
    for (int x = x0; x + 1 < x1; x += 2) {
      const std::uint8_t* a = image.row(y) + std::ptrdiff_t{2} * x;
      const std::uint8_t* b = image.row(y + 1) + std::ptrdiff_t{2} * x;
      colors.push_back(imaging::rgb_of_code(imaging::color_code(a[0] + a[2] + b[0] + b[2], a[1] + b[1], a[3] + b[3])));
    }
  }
  return colors;
}

}  // namespace cgsr::person
