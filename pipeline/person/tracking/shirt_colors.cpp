#include "pipeline/person/tracking/shirt_colors.h"

#include <cstddef>
#include <span>

#include "pipeline/person/colors/color_histogram.h"
#include "pipeline/person/tracking/shirt_regions.h"

namespace cgsr::person {
namespace {

// Of a shirt nearby no more is learned at a time than of one far away, or a single image would outweigh what its face taught.
std::vector<imaging::Rgb> thinned(std::vector<imaging::Rgb> samples) {
  constexpr std::size_t kMost = 800;
  const std::size_t stride = (samples.size() + kMost - 1) / kMost;
  if (stride <= 1) return samples;
  std::vector<imaging::Rgb> some;
  for (std::size_t i = 0; i < samples.size(); i += stride) some.push_back(samples[i]);
  return some;
}

// A person who turns sideways leaves room at his place for the wall behind him: what is rarer in it than beside it is not learned. Another side of the shirt
// that comes into view is in it alone.
void leave_out_background(std::vector<imaging::Rgb>& samples, std::span<const imaging::Rgb> beside) {
  ColorHistogram inside, outside;
  inside.add(samples);
  outside.add(beside);
  std::erase_if(samples, [&](const imaging::Rgb& color) { return inside.share(color) < outside.share(color); });
}

}  // namespace

// The middle of a shirt, and what is to its left and right. All pixels count: those that have the shirt's colours in a light that changes have changed least.
std::optional<PartColors> part_colors(const ImageView& image, const Box& shirt) {
  const auto strip = [&](double x) { return mean_color(image, {x, shirt.y, shirt.width / 2, shirt.height}); };
  const auto middle =
      mean_color(image, {shirt.x + shirt.width / 4, shirt.y + shirt.height / 4, shirt.width / 2, shirt.height / 2});
  const auto left = strip(shirt.x - 0.75 * shirt.width), right = strip(shirt.x + 1.25 * shirt.width);
  if (!middle || (!left && !right)) return std::nullopt;
  if (!left || !right) return PartColors{*middle, left ? *left : *right};
  return PartColors{*middle, {(left->r + right->r) / 2, (left->g + right->g) / 2, (left->b + right->b) / 2}};
}

std::vector<imaging::Rgb> colors_of_both(const ImageView& image, const std::array<Box, 2>& regions) {
  auto colors = region_colors(image, regions[0]);
  const auto right = region_colors(image, regions[1]);
  colors.insert(colors.end(), right.begin(), right.end());
  return colors;
}

std::vector<imaging::Rgb> trunk_colors(const ImageView& image, const Box& trunk) {
  constexpr double kMargin = 0.15;  // of its sides, where sleeves or background may be
  const Box middle{trunk.x + kMargin * trunk.width, trunk.y + kMargin * trunk.height,
                   (1.0 - 2.0 * kMargin) * trunk.width, (1.0 - 2.0 * kMargin) * trunk.height};
  std::vector<imaging::Rgb> samples = thinned(region_colors(image, middle));
  leave_out_background(samples, colors_of_both(image, beside_trunk(trunk)));
  return samples;
}

}  // namespace cgsr::person
