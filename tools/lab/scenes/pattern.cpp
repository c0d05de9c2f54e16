#include "tools/lab/scenes/pattern.h"

#include "tools/lab/scenes/texture.h"

namespace cgsr::lab {
namespace {

constexpr double kLeastHueGap = 50.0 / 360.0;

bool is_new_hue(double hue, const std::vector<Rgb>& palette) {
  for (const Rgb& color : palette) {
    if (hue_distance(hue, hue_of(color)) < kLeastHueGap) return false;
  }
  return true;
}

}  // namespace

Pattern::Pattern(Random random) {
  const int colors = 3 + random.below(3);
  while (static_cast<int>(palette_.size()) < colors) {
    const double hue = random.uniform();
    if (is_new_hue(hue, palette_))
      palette_.push_back(of_hsv(hue, random.uniform(0.5, 0.95), random.uniform(0.45, 0.95)));
  }
  // One patch in each cell of a grid, the first ones in each colour once, so that every colour is seen.
  const int columns = 3 + random.below(2);
  const int rows = 3 + random.below(3);
  for (int i = 0; i < columns * rows; ++i) {
    const double u = (i % columns + random.uniform(0.1, 0.9)) / columns;
    const int row = i / columns;
    const double v = (row + random.uniform(0.1, 0.9)) / rows;
    patches_.push_back({u, v, i < colors ? i : random.below(colors), random.uniform(0.02, 0.12), random.next()});
  }
}

Rgb Pattern::at(double u, double v) const {
  const Patch* nearest = nullptr;
  double least = 1e9;
  for (const Patch& patch : patches_) {
    const double distance = (u - patch.u) * (u - patch.u) + (v - patch.v) * (v - patch.v);
    if (distance < least) {
      least = distance;
      nearest = &patch;
    }
  }
  const double grain = value_noise(u, v, 0.04, nearest->seed) + 0.5 * value_noise(u, v, 0.015, nearest->seed + 1);
  const Rgb color = palette_[static_cast<std::size_t>(nearest->color)] * (1.0 + nearest->grain * grain);
  return {std::min(color.r, 1.0), std::min(color.g, 1.0), std::min(color.b, 1.0)};
}

}  // namespace cgsr::lab
