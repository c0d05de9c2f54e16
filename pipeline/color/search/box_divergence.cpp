#include "pipeline/color/search/box_divergence.h"

#include <algorithm>
#include <cmath>

namespace cgsr::color {
namespace {

SearchParameters plain(Divergence divergence) {
  SearchParameters parameters;
  parameters.divergence = divergence;
  parameters.weights = BinWeights::kPlain;
  return parameters;
}

}  // namespace

BoxDivergence::BoxDivergence(const ColorModel& model, Divergence divergence)
    : divergence_(divergence),
      similarity_(model, plain(divergence), labels_of(model)),
      counts_(static_cast<std::size_t>(similarity_.labels()) + 1) {}

BoxDivergence::Answer BoxDivergence::of(const imaging::ReducedImage& image, const Box& box) {
  const auto bound = [&image](double edge, int length) {
    return std::clamp(static_cast<int>(std::lround(edge / image.factor)), 0, length);
  };
  const int left = bound(box.x, image.width_px);
  const int right = bound(box.x + box.width, image.width_px);
  const int top = bound(box.y, image.height_px);
  const int bottom = bound(box.y + box.height, image.height_px);
  if (left >= right || top >= bottom) return {max_divergence(divergence_), 0};

  constexpr int kEnough_px = 4096;
  const int step = (right - left) * (bottom - top) > kEnough_px ? 2 : 1;
  std::fill(counts_.begin(), counts_.end(), 0);
  int pixels = 0;
  for (int y = top; y < bottom; y += step) {
    const std::uint16_t* row = image.labels.data() + static_cast<std::ptrdiff_t>(y) * image.width_px;
    for (int x = left; x < right; x += step) ++counts_[row[x]];
    pixels += (right - left + step - 1) / step;
  }

  std::array<int, kMaxLights> units{};
  const int lights = similarity_.lights();
  for (int label = 1; label <= similarity_.labels(); ++label) {
    const int count = counts_[static_cast<std::size_t>(label)];
    if (count == 0) continue;
    const int level = level_of(count, pixels);
    for (int light = 0; light < lights; ++light) {
      units[static_cast<std::size_t>(light)] += similarity_.units(label, level, light);
    }
  }
  const auto best = std::max_element(units.begin(), units.begin() + lights);
  return {divergence_of_units(divergence_, std::min(*best, kMaxUnits)), static_cast<int>(best - units.begin())};
}

}  // namespace cgsr::color
