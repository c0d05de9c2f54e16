#include "pipeline/world/triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

namespace cgsr::world {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// An outline laid flat, as a ring that loses its ears.
class Ring {
 public:
  Ring(std::span<const std::uint32_t> outline, std::span<const Eigen::Vector3f> points) {
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    const Eigen::Vector3d origin = points[outline[0]].cast<double>();
    for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
      area += (points[outline[i]].cast<double>() - origin).cross(points[outline[i + 1]].cast<double>() - origin);
    }
    const double size = area.norm();
    if (!(size > 0.0)) return;
    const Eigen::Vector3d normal = area / size;
    const Eigen::Vector3d x = normal.unitOrthogonal();
    const Eigen::Vector3d y = normal.cross(x);
    flat_.reserve(outline.size());
    for (const std::uint32_t corner : outline) {
      const Eigen::Vector3d p = points[corner].cast<double>() - origin;
      flat_.emplace_back(x.dot(p), y.dot(p));
    }
    corners_.assign(outline.begin(), outline.end());
    tolerance_ = 1e-9 * size;
  }

  [[nodiscard]] std::size_t size() const { return corners_.size(); }

  // Takes off the ear at i, if it is one. `thin`: one without area counts too, and is thrown away.
  bool cut(std::size_t i, bool thin, std::vector<Triangle>& triangles) {
    const std::size_t before = (i + size() - 1) % size();
    const std::size_t after = (i + 1) % size();
    const double area = twice_area(before, i, after);
    if (thin ? std::abs(area) > tolerance_ : area <= tolerance_) return false;
    if (!thin) {
      for (std::size_t j = 0; j < size(); ++j) {
        if (j != before && j != i && j != after && blocks(j, before, i, after)) return false;
      }
      triangles.push_back({corners_[before], corners_[i], corners_[after]});
    }
    const auto at = static_cast<std::ptrdiff_t>(i);
    corners_.erase(corners_.begin() + at);
    flat_.erase(flat_.begin() + at);
    return true;
  }

  [[nodiscard]] bool convex() const {
    for (std::size_t i = 0; i < size(); ++i) {
      if (twice_area(i, (i + 1) % size(), (i + 2) % size()) <= tolerance_) return false;
    }
    // All turns to the left may still go round twice.
    for (std::size_t i = 1; i + 1 < size(); ++i) {
      if (twice_area(0, i, i + 1) <= tolerance_) return false;
    }
    return true;
  }

  void fan(std::vector<Triangle>& triangles) const {
    for (std::size_t i = 1; i + 1 < size(); ++i) triangles.push_back({corners_[0], corners_[i], corners_[i + 1]});
  }

 private:
  [[nodiscard]] double twice_area(std::size_t a, std::size_t b, std::size_t c) const {
    return cross(flat_[b] - flat_[a], flat_[c] - flat_[b]);
  }

  // A corner in the ear or on its rim, other than the ear's own points (an outline may come by twice: a bridge to a hole).
  [[nodiscard]] bool blocks(std::size_t j, std::size_t a, std::size_t b, std::size_t c) const {
    const Eigen::Vector2d& p = flat_[j];
    if (p == flat_[a] || p == flat_[b] || p == flat_[c]) return false;
    return cross(flat_[b] - flat_[a], p - flat_[a]) >= -tolerance_ &&
           cross(flat_[c] - flat_[b], p - flat_[b]) >= -tolerance_ &&
           cross(flat_[a] - flat_[c], p - flat_[c]) >= -tolerance_;
  }

  std::vector<std::uint32_t> corners_;
  std::vector<Eigen::Vector2d> flat_;
  double tolerance_ = 0.0;
};

}  // namespace

void triangulate(std::span<const std::uint32_t> outline, std::span<const Eigen::Vector3f> points,
                 std::vector<Triangle>& triangles) {
  if (outline.size() < 3) return;
  if (outline.size() == 3) {
    triangles.push_back({outline[0], outline[1], outline[2]});
    return;
  }
  Ring ring(outline, points);
  if (ring.size() < 3) return;
  if (ring.convex()) {
    ring.fan(triangles);
    return;
  }
  std::size_t at = 0;
  while (ring.size() >= 3) {
    bool cut = false;
    for (const bool thin : {false, true}) {
      for (std::size_t tried = 0; tried < ring.size() && !cut; ++tried) {
        const std::size_t i = (at + tried) % ring.size();
        cut = ring.cut(i, thin, triangles);
        // Two on, so that ears come from all around and triangles stay stout.
        if (cut && ring.size() > 0) at = (i + 1) % ring.size();
      }
      if (cut) break;
    }
    if (!cut) return;
  }
}

}  // namespace cgsr::world
