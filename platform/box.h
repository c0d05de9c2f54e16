#pragma once

#include <algorithm>

namespace cgsr {

/// An upright rectangle in an image: left, top, width, height in pixels. The pixel (x, y) covers [x, x + 1) of a box's span, so a
/// box of the whole image is {0, 0, width, height}.
struct Box {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;

  [[nodiscard]] double area() const { return width * height; }
  [[nodiscard]] bool empty() const { return !(width > 0.0 && height > 0.0); }
  friend bool operator==(const Box&, const Box&) = default;
};

/// \return what both boxes cover; empty when they do not meet.
inline Box intersection(const Box& a, const Box& b) {
  const double left = std::max(a.x, b.x);
  const double top = std::max(a.y, b.y);
  const double right = std::min(a.x + a.width, b.x + b.width);
  const double bottom = std::min(a.y + a.height, b.y + b.height);
  return {left, top, std::max(0.0, right - left), std::max(0.0, bottom - top)};
}

/// \return what both boxes cover, as a share of what either covers, 0..1; 0 when they do not meet or cover nothing.
inline double intersection_over_union(const Box& a, const Box& b) {
  const double both = intersection(a, b).area();
  return both > 0.0 ? both / (a.area() + b.area() - both) : 0.0;
}

}  // namespace cgsr
