#include "pipeline/render/edge_line.h"

#include <algorithm>

#include "pipeline/render/clip.h"

namespace cgsr::render {

bool EdgeLine::set(const ViewedCorner& a, const ViewedCorner& b, const View& view, float near_m, float min_w) {
  if (a.w == 0.0F && b.w == 0.0F) return false;

  // The near plane, in three dimensions.
  float near0 = 0.0F;
  float near1 = 1.0F;
  Eigen::Vector2f begin = a.at;
  Eigen::Vector2f end = b.at;
  float w_begin = a.w;
  float w_end = b.w;
  if (a.w == 0.0F || b.w == 0.0F) {
    const float t = (near_m - a.p.z()) / (b.p.z() - a.p.z());
    const Eigen::Vector2f at = (a.p + t * (b.p - a.p)).head<2>() / near_m;
    if (a.w == 0.0F) {
      near0 = t;
      begin = at;
      w_begin = 1.0F / near_m;
    } else {
      near1 = t;
      end = at;
      w_end = 1.0F / near_m;
    }
  }

  // The borders of the view, in the image, and how far it reaches.
  float s0 = 0.0F;
  float s1 = 1.0F;
  const Eigen::Vector2f span = end - begin;
  if (!clip(begin.x() + 0.5F, span.x(), s0, s1) ||
      !clip(static_cast<float>(view.width) - 0.5F - begin.x(), -span.x(), s0, s1) ||
      !clip(begin.y() + 0.5F, span.y(), s0, s1) ||
      !clip(static_cast<float>(view.height) - 0.5F - begin.y(), -span.y(), s0, s1) ||
      !clip(w_begin - min_w, w_end - w_begin, s0, s1)) {
    return false;
  }
  // Places in the image go back to places on the edge by t / Z = s / Z1: both sides are linear in s.
  const float w_from = w_begin + s0 * (w_end - w_begin);
  const float w_to = w_begin + s1 * (w_end - w_begin);
  t0 = near0 + (near1 - near0) * (s0 * w_end / w_from);
  t1 = near0 + (near1 - near0) * (s1 * w_end / w_to);
  from = begin + s0 * span;
  along = (s1 - s0) * span;
  w0 = w_from;
  dw = w_to - w_from;
  return true;
}

VisiblePiece EdgeLine::piece(std::uint32_t edge, float begin, float end, const View& view) const {
  const float w1 = w0 + dw;
  const auto to_t = [&](float s) { return std::clamp(t0 + (t1 - t0) * (s * w1 / (w0 + s * dw)), 0.0F, 1.0F); };
  const auto px_per_cell_x = static_cast<float>(1.0 / view.cells_per_px_x());
  const auto px_per_cell_y = static_cast<float>(1.0 / view.cells_per_px_y());
  const auto to_px = [&](float s) {
    return Eigen::Vector2f(static_cast<float>(view.left_px) + (from.x() + s * along.x() + 0.5F) * px_per_cell_x,
                           static_cast<float>(view.top_px) + (from.y() + s * along.y() + 0.5F) * px_per_cell_y);
  };
  return {edge, to_t(begin), to_t(end), to_px(begin), to_px(end)};
}

}  // namespace cgsr::render
