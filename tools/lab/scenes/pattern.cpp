#include "tools/lab/scenes/pattern.h"

#include "tools/lab/scenes/texture.h"

namespace cgsr::lab {
namespace {

constexpr double kLeastHueGap = 50.0 / 360.0;

/// Colours around the circle of hues, kLeastHueGap or more between neighbours.
std::vector<Rgb> random_palette(int colors, Random& random) {
  const double first = random.uniform();
  const double play = 1.0 / colors - kLeastHueGap;
  std::vector<Rgb> palette;
  for (int i = 0; i < colors; ++i) {
    const double hue = first + static_cast<double>(i) / colors + random.uniform(0.0, play);
    palette.push_back(to_rgb({hue, random.uniform(0.5, 0.95), random.uniform(0.45, 0.95)}));
  }
  return palette;
}

}  // namespace

Pattern::Pattern(Random random) {
  const int colors = 3 + random.below(3);
  palette_ = random_palette(colors, random);
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
  const Patch* nearest = &patches_.front();  // there are always some
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
