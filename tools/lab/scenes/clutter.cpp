#include "tools/lab/scenes/clutter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <opencv2/core.hpp>

#include "tools/lab/scenes/texture.h"

namespace cgsr::lab {
namespace {

constexpr int kLeaves = 260;
constexpr double kClearlyOtherHue = 24.0 / 360.0;

enum class Outline { kRectangle, kEllipse, kTriangle };

struct Leaf {
  double x = 0.0, y = 0.0;           // centre, px
  double along = 0.0, across = 0.0;  // half sides, px
  double cosine = 1.0, sine = 0.0;
  Outline outline = Outline::kRectangle;
  double stripe = 0.0;  // period, px; 0: plain
  double grain = 0.0, cell = 8.0;
  std::uint64_t seed = 0;
  Rgb color, second;

  /// Position in the leaf's own axes, (-1, 1) inside its rectangle.
  void locate(double px, double py, double& u, double& v) const {
    u = (cosine * (px - x) + sine * (py - y)) / along;
    v = (cosine * (py - y) - sine * (px - x)) / across;
  }

  [[nodiscard]] bool covers(double px, double py) const {
    double u = 0.0, v = 0.0;
    locate(px, py, u, v);
    switch (outline) {
      case Outline::kRectangle:
        return std::abs(u) < 1.0 && std::abs(v) < 1.0;
      case Outline::kEllipse:
        return u * u + v * v < 1.0;
      case Outline::kTriangle:
        return v < 1.0 && v > -1.0 && 2.0 * std::abs(u) < v + 1.0;
    }
    return false;
  }

  [[nodiscard]] Rgb color_at(int px, int py) const {
    double u = 0.0, v = 0.0;
    locate(px, py, u, v);
    const bool is_second = stripe > 0.0 && std::fmod(std::abs(u * along + 1000.0 * stripe), stripe) < 0.5 * stripe;
    const double noise = value_noise(px, py, cell, seed) + 0.6 * value_noise(px, py, 2.5, seed + 1);
    return (is_second ? second : color) * (1.0 + grain * noise);
  }
};

/// A direction without cosines, whose last bit is the library's: a random point of the disc, scaled to length 1 (sqrt is exact).
void turn(Leaf& leaf, Random& random) {
  for (;;) {
    const double c = random.uniform(-1.0, 1.0), s = random.uniform(-1.0, 1.0);
    const double length = std::sqrt(c * c + s * s);
    if (length < 0.1 || length > 1.0) continue;
    leaf.cosine = c / length;
    leaf.sine = s / length;
    return;
  }
}

/// Many small leaves, few large ones.
Leaf random_leaf(int width_px, int height_px, double min_px, double most_px, Random& random) {
  Leaf leaf;
  leaf.x = random.uniform(0.0, width_px);
  leaf.y = random.uniform(0.0, height_px);
  const double draw = random.uniform();
  leaf.along = 0.5 * (min_px + (most_px - min_px) * draw * draw);
  leaf.across = leaf.along * random.uniform(0.3, 1.0);
  leaf.outline = static_cast<Outline>(random.below(3));
  if (random.chance(0.7)) turn(leaf, random);
  if (random.chance(0.25)) leaf.stripe = random.uniform(6.0, 30.0);
  leaf.grain = random.uniform(0.02, 0.15);
  leaf.cell = random.uniform(4.0, 24.0);
  leaf.seed = random.next();
  return leaf;
}

/// Which leaf lies on top at each pixel; the first two lie under everything and fill the image (a wall, a floor).
cv::Mat1i stack_up(const std::vector<Leaf>& leaves, int width_px, int height_px, double horizon_px) {
  cv::Mat1i top(height_px, width_px, 0);
  for (int y = 0; y < height_px; ++y) {
    if (y >= horizon_px) top.row(y) = 1;
  }
  for (int i = 2; i < static_cast<int>(leaves.size()); ++i) {
    const Leaf& leaf = leaves[static_cast<std::size_t>(i)];
    const double reach = std::sqrt(leaf.along * leaf.along + leaf.across * leaf.across);
    const int left = std::max(0, static_cast<int>(leaf.x - reach));
    const int right = std::min(width_px, static_cast<int>(leaf.x + reach) + 1);
    const int first = std::max(0, static_cast<int>(leaf.y - reach));
    const int last = std::min(height_px, static_cast<int>(leaf.y + reach) + 1);
    for (int y = first; y < last; ++y) {
      for (int x = left; x < right; ++x) {
        if (leaf.covers(x, y)) top(y, x) = i;
      }
    }
  }
  return top;
}

Rgb shared_color(const std::vector<Rgb>& palette, Random& random) {
  const Rgb& color = palette[static_cast<std::size_t>(random.below(static_cast<int>(palette.size())))];
  if (random.chance(0.5)) return color;
  return to_rgb(
      {hue_of(color) + random.uniform(-0.4, 0.4) * kSameHue, random.uniform(0.3, 0.95), random.uniform(0.25, 0.95)});
}

Rgb other_color(const std::vector<Rgb>& palette, Random& random) {
  if (random.chance(0.35))
    return to_rgb({random.uniform(), random.uniform(0.0, 0.6 * kGreySaturation), random.uniform(0.1, 0.95)});
  for (;;) {
    const double hue = random.uniform();
    const bool is_other = std::ranges::all_of(
        palette, [&](const Rgb& color) { return hue_distance(hue, hue_of(color)) > kClearlyOtherHue; });
    if (is_other) return to_rgb({hue, random.uniform(0.25, 0.95), random.uniform(0.15, 0.95)});
  }
}

}  // namespace

Canvas random_clutter(int width_px, int height_px, const std::vector<Rgb>& palette, double shared, Random random) {
  std::vector<Leaf> leaves;
  leaves.reserve(kLeaves);
  for (int i = 0; i < kLeaves; ++i) {
    // Large ones first: what lies in front is small.
    leaves.push_back(i < kLeaves / 6 ? random_leaf(width_px, height_px, 80.0, 320.0, random)
                                     : random_leaf(width_px, height_px, 12.0, 150.0, random));
  }
  const cv::Mat1i top = stack_up(leaves, width_px, height_px, random.uniform(0.4, 0.8) * height_px);

  std::vector<int> visible(leaves.size());
  for (int leaf : top) ++visible[static_cast<std::size_t>(leaf)];
  std::vector<std::size_t> order(leaves.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);

  // Leaf after leaf in random order joins the object's hues, as long as its pixels still fit into the share.
  double left_to_share = shared * width_px * height_px;
  for (std::size_t i : order) {
    const bool joins = visible[i] <= left_to_share;
    if (joins) left_to_share -= visible[i];
    leaves[i].color = joins ? shared_color(palette, random) : other_color(palette, random);
    leaves[i].second = joins ? shared_color(palette, random) : other_color(palette, random);
  }

  Canvas canvas{width_px, height_px, std::vector<Rgb>(top.total())};
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const Rgb c = leaves[static_cast<std::size_t>(top(y, x))].color_at(x, y);
      canvas.at(x, y) = {std::min(c.r, 1.0), std::min(c.g, 1.0), std::min(c.b, 1.0)};
    }
  }
  return canvas;
}

double share_of_hues(const Canvas& canvas, const std::vector<Rgb>& palette) {
  const auto count = std::ranges::count_if(canvas.pixels, [&](const Rgb& pixel) {
    return saturation_of(pixel) > kGreySaturation && std::ranges::any_of(palette, [&](const Rgb& color) {
             return hue_distance(hue_of(pixel), hue_of(color)) <= kSameHue;
           });
  });
  return static_cast<double>(count) / static_cast<double>(canvas.pixels.size());
}

}  // namespace cgsr::lab
