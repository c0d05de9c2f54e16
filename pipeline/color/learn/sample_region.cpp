#include "pipeline/color/learn/sample_region.h"

#include <algorithm>
#include <cmath>

namespace cgsr::color {
namespace {

int whole(double value, int limit) {
  return static_cast<int>(std::lround(std::clamp(value, 0.0, static_cast<double>(limit))));
}

// A span of at least 16 pixels around [from, to), inside [0, limit); limit >= 16.
void stretch_to_16(int& from, int& to, int limit) {
  from = std::max(0, std::min(from, to - 16));
  to = std::min(limit, std::max(to, from + 16));
  from = std::min(from, to - 16);
}

// Mean of every `step`-th byte in a rectangle of bytes: one channel of a piece of a YUYV image.
std::uint8_t mean_of(const ImageView& image, int byte_from, int byte_to, int step, int y_from, int y_to) {
  long sum = 0;
  long count = 0;
  for (int y = y_from; y < y_to; ++y) {
    for (int byte = byte_from; byte < byte_to; byte += step) {
      sum += image.row(y)[byte];
      ++count;
    }
  }
  return static_cast<std::uint8_t>((sum + count / 2) / count);
}

}  // namespace

PixelRect grown(const Box& box, double share, const imaging::ReducedImage& image) {
  const double f = image.factor;
  return {whole((box.x - share * box.width) / f, image.width_px),
          whole((box.y - share * box.height) / f, image.height_px),
          whole((box.x + (1.0 + share) * box.width) / f, image.width_px),
          whole((box.y + (1.0 + share) * box.height) / f, image.height_px)};
}

std::vector<imaging::Rgb> colors_in(const imaging::ReducedImage& coded, const PixelRect& rect) {
  return colors_around(coded, rect, {});
}

std::vector<imaging::Rgb> colors_around(const imaging::ReducedImage& coded, const PixelRect& rect,
                                        const PixelRect& hole) {
  std::vector<imaging::Rgb> colors;
  for (int y = rect.top; y < rect.bottom; ++y) {
    for (int x = rect.left; x < rect.right; ++x) {
      if (hole.contains(x, y)) continue;
      colors.push_back(imaging::rgb_of_code(coded.labels[static_cast<std::size_t>(y * coded.width_px + x)]));
    }
  }
  return colors;
}

SamplePatch cut_patch(const ImageView& image, const Box& window, const Light& light) {
  const Box wide{window.x - window.width / 2, window.y - window.height / 2, window.width * 2, window.height * 2};
  int left = whole(wide.x, image.width_px) & ~1;
  int right = (whole(wide.x + wide.width, image.width_px) + 1) & ~1;
  int top = whole(wide.y, image.height_px);
  int bottom = whole(wide.y + wide.height, image.height_px);
  stretch_to_16(left, right, image.width_px);
  stretch_to_16(top, bottom, image.height_px);

  const double shrink = std::min(1.0, static_cast<double>(kMaxPatchSide) / std::max(right - left, bottom - top));
  SamplePatch patch;
  patch.light = light;
  patch.width_px = std::max(16, static_cast<int>((right - left) * shrink) & ~1);
  patch.height_px = std::max(16, static_cast<int>((bottom - top) * shrink));
  patch.scale_x = static_cast<double>(patch.width_px) / (right - left);
  patch.scale_y = static_cast<double>(patch.height_px) / (bottom - top);
  patch.window = {(window.x - left) * patch.scale_x, (window.y - top) * patch.scale_y, window.width * patch.scale_x,
                  window.height * patch.scale_y};
  patch.yuyv.resize(static_cast<std::size_t>(patch.width_px) * static_cast<std::size_t>(patch.height_px) * 2);

  const auto source_x = [&](int x) { return left + x * (right - left) / patch.width_px; };
  const auto source_y = [&](int y) { return top + y * (bottom - top) / patch.height_px; };
  auto out = patch.yuyv.begin();
  for (int y = 0; y < patch.height_px; ++y) {
    const int y0 = source_y(y), y1 = source_y(y + 1);
    for (int x = 0; x < patch.width_px; x += 2) {
      const int x0 = source_x(x), x1 = source_x(x + 1), x2 = source_x(x + 2);
      const int pair0 = x0 / 2 * 4, pair1 = (x2 + 1) / 2 * 4;  // bytes of the pixel pairs that both share
      *out++ = mean_of(image, x0 * 2, x1 * 2, 2, y0, y1);
      *out++ = mean_of(image, pair0 + 1, pair1, 4, y0, y1);
      *out++ = mean_of(image, x1 * 2, x2 * 2, 2, y0, y1);
      *out++ = mean_of(image, pair0 + 3, pair1, 4, y0, y1);
    }
  }
  return patch;
}

}  // namespace cgsr::color
