#include "pipeline/person/colors/color_histogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
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

/// Calls visit(bin) for each one that is not 0: few are, so four are looked at at once.
template <class Visit>
void for_each_met(const std::vector<std::uint16_t>& counts, const Visit& visit) {
  constexpr std::size_t kAtOnce = 4;
  for (std::size_t first = 0; first + kAtOnce <= counts.size(); first += kAtOnce) {
    std::uint64_t together = 0;
    std::memcpy(&together, counts.data() + first, sizeof together);
    if (together == 0) continue;
    for (std::size_t bin = first; bin < first + kAtOnce; ++bin) {
      if (counts[bin] != 0) visit(bin);
    }
  }
}

/// Calls visit(bin) for a colour and those at most `reach` bins away in each channel.
template <class Visit>
void for_each_near(int r, int g, int b, int reach, const Visit& visit) {
  for (int i = std::max(0, r - reach); i <= std::min(kSide - 1, r + reach); ++i) {
    for (int j = std::max(0, g - reach); j <= std::min(kSide - 1, g + reach); ++j) {
      for (int k = std::max(0, b - reach); k <= std::min(kSide - 1, b + reach); ++k) visit(bin_of(i, j, k));
    }
  }
}

}  // namespace

std::size_t ColorHistogram::bin(const imaging::Rgb& color) {
  return bin_of(level_of(color.r), level_of(color.g), level_of(color.b));
}

std::vector<std::uint8_t> ColorHistogram::met_nearby(int reach) const {
  if (total_ == 0) return {};
  std::vector<std::uint8_t> near(kBins, 0);
  for_each_met(counts_, [&near, reach](std::size_t bin) {
    const auto channel = [bin](std::size_t below) { return static_cast<int>(bin / below % kSide); };
    for_each_near(channel(std::size_t{kSide} * kSide), channel(kSide), channel(1), reach,
                  [&near](std::size_t one) { near[one] = 1; });
  });
  return near;
}

void ColorHistogram::add(std::span<const imaging::Rgb> samples) {
  if (samples.empty()) return;
  counts_.resize(kBins);
  for (const imaging::Rgb& color : samples) {
    std::uint16_t& count = counts_[bin(color)];
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

double ColorHistogram::share(const imaging::Rgb& color, int reach) const {
  if (total_ == 0) return 0.0;
  std::uint32_t sum = 0;
  for_each_near(level_of(color.r), level_of(color.g), level_of(color.b), reach,
                [&](std::size_t one) { sum += counts_[one]; });
  return static_cast<double>(sum) / total_;
}

imaging::Rgb ColorHistogram::bright_level() const {
  std::array<std::array<std::uint32_t, kSide>, 3> levels{};
  for_each_met(counts_, [&](std::size_t bin) {
    levels[0][bin / (kSide * kSide)] += counts_[bin];
    levels[1][bin / kSide % kSide] += counts_[bin];
    levels[2][bin % kSide] += counts_[bin];
  });
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
