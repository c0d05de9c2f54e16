#include "tools/lab/scenes/canvas.h"

#include <algorithm>
#include <cmath>

namespace cgsr::lab {
namespace {

/// How much of the pixel [i, i + 1) lies in [from, to).
double coverage(int i, double from, double to) {
  return std::clamp(std::min(to, i + 1.0) - std::max(from, static_cast<double>(i)), 0.0, 1.0);
}

/// One binomial pass over `count` values that lie `step` apart; the border repeats.
void blur_line(Rgb* first, int count, std::ptrdiff_t step) {
  Rgb before = *first;
  for (int i = 0; i < count; ++i) {
    Rgb& here = first[i * step];
    const Rgb& after = i + 1 < count ? first[(i + 1) * step] : here;
    const Rgb blurred = before * 0.25 + here * 0.5 + after * 0.25;
    before = here;
    here = blurred;
  }
}

void blur(Canvas& canvas) {
  for (int y = 0; y < canvas.height_px; ++y) blur_line(&canvas.at(0, y), canvas.width_px, 1);
  for (int x = 0; x < canvas.width_px; ++x) blur_line(&canvas.at(x, 0), canvas.height_px, canvas.width_px);
}

std::uint8_t to_byte(double base, double value, double low, double high) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(base + value, low, high)));
}

std::uint8_t luma(const Rgb& c) {
  return to_byte(16.0, 65.481 * c.r + 128.553 * c.g + 24.966 * c.b, 16.0, 235.0);
}

}  // namespace

void paint(Canvas& canvas, const Pattern& pattern, const Box& box) {
  const int left = std::max(0, static_cast<int>(std::floor(box.x)));
  const int top = std::max(0, static_cast<int>(std::floor(box.y)));
  const int right = std::min(canvas.width_px, static_cast<int>(std::ceil(box.x + box.width)));
  const int bottom = std::min(canvas.height_px, static_cast<int>(std::ceil(box.y + box.height)));
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const double share = coverage(x, box.x, box.x + box.width) * coverage(y, box.y, box.y + box.height);
      const double u = std::clamp((x + 0.5 - box.x) / box.width, 0.0, 0.999);
      const double v = std::clamp((y + 0.5 - box.y) / box.height, 0.0, 0.999);
      canvas.at(x, y) = canvas.at(x, y) * (1.0 - share) + pattern.at(u, v) * share;
    }
  }
}

std::vector<std::uint8_t> expose(const Canvas& canvas, const Exposure& exposure, Random random) {
  const Light& light = exposure.light;
  Canvas seen = canvas;
  for (Rgb& pixel : seen.pixels) pixel = pixel * Rgb{light.r, light.g, light.b};
  for (int pass = 0; pass < exposure.blur_passes; ++pass) blur(seen);

  const auto recorded = [&](double value) {
    return std::clamp(value + exposure.noise / 255.0 * random.normal(), 0.0, 1.0);
  };
  std::vector<std::uint8_t> yuyv;
  yuyv.reserve(2 * seen.pixels.size());
  for (std::size_t i = 0; i + 1 < seen.pixels.size(); i += 2) {
    Rgb pair[2] = {seen.pixels[i], seen.pixels[i + 1]};
    for (Rgb& pixel : pair) {
      pixel.r = recorded(pixel.r);
      pixel.g = recorded(pixel.g);
      pixel.b = recorded(pixel.b);
    }
    const Rgb both = (pair[0] + pair[1]) * 0.5;
    yuyv.push_back(luma(pair[0]));
    yuyv.push_back(to_byte(128.0, -37.797 * both.r - 74.203 * both.g + 112.0 * both.b, 16.0, 240.0));
    yuyv.push_back(luma(pair[1]));
    yuyv.push_back(to_byte(128.0, 112.0 * both.r - 93.786 * both.g - 18.214 * both.b, 16.0, 240.0));
  }
  return yuyv;
}

}  // namespace cgsr::lab
