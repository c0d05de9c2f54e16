#include "pipeline/color/track/color_scan.h"

#include <algorithm>
#include <cmath>

namespace cgsr::color {
namespace {

constexpr int kMaxSamples = 160;        // of the image's larger side
constexpr double kSamplesOfSide = 8.0;  // of the object's smaller side
constexpr float kMinSeparation = 0.01F;
constexpr int kStride = 2;  // samples from one window to the next
constexpr std::array kSizes{0.7, 1.0, 1.4};
constexpr double kMaxOverlap = 0.3;  // of two places, as intersection over union
constexpr int kBlock = 4 * kStride;  // samples: of the windows that begin in one block the best one counts
constexpr std::size_t kMaxBlocks = kMaxSamples / kBlock;

}  // namespace

ColorScan::ColorScan()
    : patch_({kMaxSamples, kMaxSamples}), integral_(static_cast<std::size_t>(kMaxSamples + 1) * (kMaxSamples + 1)) {
  windows_.reserve(kSizes.size() * kMaxBlocks * kMaxBlocks);
}

std::span<const Box> ColorScan::places(const imaging::Pyramid& image, const ColorLikelihood& colors, const Light& light,
                                       const Box& object) {
  const double larger = std::max(image.width_px(), image.height_px());
  const double step = std::max({1.0, std::min(object.width, object.height) / kSamplesOfSide, larger / kMaxSamples});
  patch_.resize({std::max(1, static_cast<int>(image.width_px() / step)),
                 std::max(1, static_cast<int>(image.height_px() / step))});
  step_x_px_ = static_cast<double>(image.width_px()) / patch_.size.width_px;
  step_y_px_ = static_cast<double>(image.height_px()) / patch_.size.height_px;
  sum_likelihoods(image, colors, light);
  windows_.clear();
  for (const double size : kSizes) weigh_windows(object.width * size, object.height * size);

  std::size_t count = 0;
  while (count < places_.size() && !windows_.empty()) {
    const Window& best = *std::max_element(
        windows_.begin(), windows_.end(), [](const Window& a, const Window& b) { return a.separation < b.separation; });
    if (best.separation < kMinSeparation) break;
    const Box place = best.box;
    places_[count++] = place;
    std::erase_if(windows_,
                  [&](const Window& other) { return intersection_over_union(place, other.box) > kMaxOverlap; });
  }
  return {places_.data(), count};
}

/// The integral image of the samples' likelihoods.
void ColorScan::sum_likelihoods(const imaging::Pyramid& image, const ColorLikelihood& colors, const Light& light) {
  const Box whole{0.0, 0.0, static_cast<double>(image.width_px()), static_cast<double>(image.height_px())};
  image.sample_luma(whole, patch_.size, patch_.y);
  image.sample_chroma(whole, patch_.size, patch_.u, patch_.v);
  relight(patch_, inverse(light));
  const auto columns = static_cast<std::size_t>(patch_.size.width_px);
  std::fill_n(integral_.begin(), columns + 1, 0.0F);
  std::size_t at = 0;
  for (int y = 0; y < patch_.size.height_px; ++y) {
    const float* above = integral_.data() + static_cast<std::size_t>(y) * (columns + 1);
    float* sums = integral_.data() + static_cast<std::size_t>(y + 1) * (columns + 1);
    sums[0] = 0.0F;
    float row = 0.0F;
    for (std::size_t x = 0; x < columns; ++x, ++at) {
      row += colors.of(patch_.y[at], patch_.u[at], patch_.v[at]);
      sums[x + 1] = above[x + 1] + row;
    }
  }
}

float ColorScan::sum(int left, int top, int right, int bottom) const {
  const int row = patch_.size.width_px + 1;
  const float* high = integral_.data() + static_cast<std::ptrdiff_t>(top) * row;
  const float* low = integral_.data() + static_cast<std::ptrdiff_t>(bottom) * row;
  return low[right] - low[left] - high[right] + high[left];
}

/// The windows of one size, with how far it stands out from a frame as wide as a quarter of both its sides.
void ColorScan::weigh_windows(double width_px, double height_px) {
  const int width = std::max(2, static_cast<int>(std::lround(width_px / step_x_px_)));
  const int height = std::max(2, static_cast<int>(std::lround(height_px / step_y_px_)));
  const int margin = (width + height) / 4;
  const int columns = patch_.size.width_px, rows = patch_.size.height_px;
  const std::size_t first = windows_.size();
  const int blocks = std::max(0, columns - width) / kBlock + 1;
  for (int y = 0; y + height <= rows; y += kStride) {
    if (y % kBlock == 0 && width <= columns) windows_.resize(windows_.size() + static_cast<std::size_t>(blocks), kNone);
    for (int x = 0; x + width <= columns; x += kStride) {
      const float inside = sum(x, y, x + width, y + height);
      const int left = std::max(0, x - margin), right = std::min(columns, x + width + margin);
      const int top = std::max(0, y - margin), bottom = std::min(rows, y + height + margin);
      const float around = sum(left, top, right, bottom) - inside;
      const int area = width * height, area_around = (right - left) * (bottom - top) - area;
      if (area_around == 0) continue;
      const float separation = inside / static_cast<float>(area) - around / static_cast<float>(area_around);
      Window& best = windows_[first + static_cast<std::size_t>(y / kBlock * blocks + x / kBlock)];
      if (separation <= best.separation) continue;
      best = {separation, {x * step_x_px_, y * step_y_px_, width * step_x_px_, height * step_y_px_}};
    }
  }
}

}  // namespace cgsr::color
