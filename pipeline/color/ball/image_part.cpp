#include "pipeline/color/ball/image_part.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cgsr::color {
namespace {

constexpr int kLeastSide_px = 32;

/// The first pixel of a mask's column or row.
int first_pixel(int cell, int cells, int pixels) {
  return (cell * pixels + cells - 1) / cells;
}

/// \return the even first of what covers [from, to), and the length, at least kLeastSide_px where there is so much.
std::pair<int, int> span_of(int from, int to, int limit) {
  const int first = from / 2 * 2;
  const int length = std::min(limit, std::max(kLeastSide_px, std::min(limit, (to + 1) / 2 * 2) - first));
  return {std::clamp(first, 0, (limit - length) / 2 * 2), length};
}

ImagePart part_of(int left, int right, int top, int bottom, const ImageView& image) {
  const auto [x, width] = span_of(left, right, image.width_px);
  const auto [y, height] = span_of(top, bottom, image.height_px);
  return {x, y, width, height};
}

}  // namespace

bool can_be_used(const ShadeMaskView& mask, const ImageView& image) {
  return !mask.empty() && mask.stride >= mask.width && mask.width <= image.width_px && mask.height <= image.height_px;
}

ImagePart part_around(const Box& box, const ImageView& image) {
  const auto pixel = [](double edge, int limit) {
    return static_cast<int>(std::clamp(edge, 0.0, static_cast<double>(limit)));
  };
  return part_of(pixel(std::floor(box.x), image.width_px), pixel(std::ceil(box.x + box.width), image.width_px),
                 pixel(std::floor(box.y), image.height_px), pixel(std::ceil(box.y + box.height), image.height_px),
                 image);
}

ImagePart shaded_part(const ShadeMaskView& mask, const ImageView& image) {
  int left = mask.width;
  int right = 0;
  int top = mask.height;
  int bottom = 0;
  for (int y = 0; y < mask.height; ++y) {
    const std::uint8_t* row = mask.cells + y * mask.stride;
    const std::uint8_t* end = row + mask.width;
    const auto* first = std::find_if(row, end, [](std::uint8_t cell) { return cell != 0; });
    if (first == end) continue;
    top = std::min(top, y);
    bottom = y + 1;
    left = std::min(left, static_cast<int>(first - row));
    const std::uint8_t* last = end - 1;
    while (*last == 0) --last;
    right = std::max(right, static_cast<int>(last - row) + 1);
  }
  if (top >= bottom) return {};
  return part_of(first_pixel(left, mask.width, image.width_px), first_pixel(right, mask.width, image.width_px),
                 first_pixel(top, mask.height, image.height_px), first_pixel(bottom, mask.height, image.height_px),
                 image);
}

ImageView cut(const ImageView& image, const ImagePart& part) {
  return {image.row(part.top) + std::ptrdiff_t{2} * part.left, part.width, part.height, image.stride_bytes,
          image.format};
}

void keep_only(Kept kept, const ShadeMaskView& mask, const ImageView& image, const ImagePart& part,
               imaging::ReducedImage& labels) {
  const int factor = labels.factor;
  const auto reduced = [factor](int pixel, int start, int limit) {
    return std::clamp((pixel - start + factor - 1) / factor, 0, limit);
  };
  for (int y = 0; y < labels.height_px; ++y) {
    const int cell_y = std::min((part.top + y * factor) * mask.height / image.height_px, mask.height - 1);
    const std::uint8_t* cells = mask.cells + cell_y * mask.stride;
    std::uint16_t* row = labels.labels.data() + static_cast<std::ptrdiff_t>(y) * labels.width_px;
    int cell = part.left * mask.width / image.width_px;
    int from = 0;
    while (from < labels.width_px && cell < mask.width) {
      const bool shaded = cells[cell] != 0;
      do ++cell;
      while (cell < mask.width && (cells[cell] != 0) == shaded);
      const int to = cell == mask.width
                         ? labels.width_px
                         : reduced(first_pixel(cell, mask.width, image.width_px), part.left, labels.width_px);
      if (shaded != (kept == Kept::kShaded) && to > from) std::fill(row + from, row + to, std::uint16_t{0});
      from = std::max(from, to);
    }
  }
}

}  // namespace cgsr::color
