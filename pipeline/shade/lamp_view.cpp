#include "pipeline/shade/lamp_view.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace cgsr::shade {
namespace {

constexpr std::size_t kFaces = 6;        // +x, -x, +y, -y, +z, -z
constexpr std::size_t kMoreThanOne = 2;  // entries a cell, in the mean
constexpr float kWider = 1e-3F;          // cells: what rounding may move an outline by

/// Across and along each face, as axes of W.
constexpr std::array<std::array<Eigen::Index, 2>, 3> kAcross{{{1, 2}, {2, 0}, {0, 1}}};

}  // namespace

/// A triangle before the near plane, in the cells of a face.
struct LampView::Outline {
  std::array<Eigen::Vector2f, 4> corners;
  std::size_t count = 0;
  float du = 0.0F;  ///< of 1/depth, which is linear.
  float dv = 0.0F;
  float at_origin = 0.0F;
  float top = 0.0F;
  float bottom = 0.0F;

  /// Leftmost and rightmost place on a line across; false: it does not meet it.
  bool across(float v, float& left, float& right) const {
    left = std::numeric_limits<float>::max();
    right = -left;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector2f& a = corners[i];
      const Eigen::Vector2f& b = corners[(i + 1) % count];
      if ((a.y() < v) == (b.y() < v)) continue;
      const float u = a.x() + (b.x() - a.x()) * ((v - a.y()) / (b.y() - a.y()));
      left = std::min(left, u);
      right = std::max(right, u);
    }
    return left <= right;
  }
};

LampView::LampView(const world::Map& map, const ShadeParameters& parameters)
    : map_(map),
      most_(static_cast<float>(1.0 + parameters.margin)),
      near_m_(static_cast<float>(parameters.near_m)),
      cells_(parameters.lamp_cells),
      seen_(map.triangles.size()) {
  const std::size_t count = kFaces * static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_);
  covered_.resize(count);
  entries_.resize(count * kMoreThanOne);
}

void LampView::place(const Eigen::Vector3f& p_WL) {
  begin(p_WL);
  while (!go_on(std::numeric_limits<std::size_t>::max())) {
  }
}

void LampView::begin(const Eigen::Vector3f& p_WL) {
  p_WL_ = p_WL;
  full_ = false;
  placed_ = false;
  entries_used_ = covered_.size();
  enter_phase(Phase::kClear);
}

bool LampView::go_on(std::size_t work) {
  std::size_t done = 0;
  while (done < work && progress_.phase != Phase::kDone) {
    switch (progress_.phase) {
      case Phase::kClear:
        done += clear(work - done);
        break;
      case Phase::kSee:
        done += see_surface();
        break;
      case Phase::kCover:
      case Phase::kEnter:
        done += lay_triangle(work - done);
        break;
      case Phase::kDone:
        break;
    }
  }
  return progress_.phase == Phase::kDone;
}

std::size_t LampView::clear(std::size_t work) {
  constexpr std::size_t kCellsPerWork = 8;  // it takes that much less to clear a cell than to visit it
  const std::size_t count =
      std::min(covered_.size() - progress_.next, work < covered_.size() ? kCellsPerWork * work : covered_.size());
  std::fill_n(covered_.begin() + static_cast<std::ptrdiff_t>(progress_.next), count, 0.0F);
  std::fill_n(entries_.begin() + static_cast<std::ptrdiff_t>(progress_.next), count, Entry{});
  progress_.next += count;
  if (progress_.next == covered_.size()) enter_phase(p_WL_.allFinite() ? Phase::kSee : Phase::kDone);
  return count / kCellsPerWork + 1;
}

std::size_t LampView::see_surface() {
  constexpr std::size_t kWorkPerTriangle = 12;
  if (progress_.next == map_.surfaces.size()) {
    enter_phase(Phase::kCover);
    return 0;
  }
  const world::Surface& surface = map_.surfaces[progress_.next];
  for (std::uint32_t t = 0; t < surface.triangle_count; ++t) {
    see(surface.first_triangle + t, static_cast<std::uint32_t>(progress_.next));
  }
  ++progress_.next;
  return kWorkPerTriangle * surface.triangle_count + 1;
}

/// Lays the present triangle over the rows of the present face, as far as the work goes.
std::size_t LampView::lay_triangle(std::size_t work) {
  constexpr std::size_t kWorkPerTriangle = 6;
  constexpr std::size_t kWorkPerRow = 6;
  if (progress_.next == map_.triangles.size()) {
    if (progress_.face + 1 < kFaces) {
      progress_ = {.phase = progress_.phase, .face = progress_.face + 1};
    } else if (progress_.phase == Phase::kCover) {
      enter_phase(Phase::kEnter);
    } else {
      enter_phase(Phase::kDone);
      placed_ = true;
    }
    return 0;
  }
  const auto triangle = static_cast<std::uint32_t>(progress_.next);
  std::size_t done = kWorkPerTriangle;
  Outline o;
  if (outline(progress_.face, triangle, o)) {
    const bool covers = progress_.phase == Phase::kCover;
    const auto limit = static_cast<float>(cells_);
    const int first = static_cast<int>(covers ? std::ceil(std::clamp(o.top, 0.0F, limit))
                                              : std::floor(std::clamp(o.top - kWider, 0.0F, limit - 1.0F)));
    const int end = static_cast<int>(covers ? std::floor(std::clamp(o.bottom, 0.0F, limit))
                                            : std::floor(std::clamp(o.bottom + kWider, 0.0F, limit - 1.0F)) + 1.0F);
    int y = std::max(first, progress_.row);
    for (; y < end && done < work; ++y) {
      done += kWorkPerRow + (covers ? cover_row(progress_.face, o, y) : enter_row(progress_.face, triangle, o, y));
    }
    progress_.row = y;
    if (y < end) return done;
  }
  ++progress_.next;
  progress_.row = 0;
  return done;
}

void LampView::see(std::uint32_t triangle, std::uint32_t surface) {
  const world::Triangle& t = map_.triangles[triangle];
  const Eigen::Vector3f a = map_.vertices[t[0]] - p_WL_;
  const Eigen::Vector3f b = map_.vertices[t[1]] - p_WL_;
  const Eigen::Vector3f c = map_.vertices[t[2]] - p_WL_;
  const Eigen::Vector3f n = (b - a).cross(c - a);
  const float away = a.dot(n);
  Seen& seen = seen_[triangle];
  seen.surface = surface;
  if (!(std::abs(away) > 1e-7F * n.norm())) {  // seen from its edge: hides nothing
    seen.side.fill(Eigen::Vector3f::Zero());
    seen.nearness.setZero();
    return;
  }
  // The same two corners give the same numbers in both triangles of an edge, but for the sign: no ray gets through between.
  const float sign = away > 0.0F ? 1.0F : -1.0F;
  seen.side = {sign * a.cross(b), sign * b.cross(c), sign * c.cross(a)};
  seen.nearness = n / away;
}

/// Cuts a triangle at the near plane of a face and lays it over its cells.
bool LampView::outline(std::size_t face, std::uint32_t triangle, Outline& out) const {
  if (seen_[triangle].nearness.isZero(0.0F)) return false;
  const auto axis = static_cast<Eigen::Index>(face / 2);
  const auto& across = kAcross[face / 2];
  const float sign = face % 2 == 0 ? 1.0F : -1.0F;
  const world::Triangle& t = map_.triangles[triangle];
  std::array<Eigen::Vector3f, 3> p;  // u, v and depth
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f q = map_.vertices[t[i]] - p_WL_;
    p[i] = {q[across[0]], q[across[1]], sign * q[axis]};
  }
  const auto beyond = [&](auto&& outside) { return outside(p[0]) && outside(p[1]) && outside(p[2]); };
  if (beyond([&](const Eigen::Vector3f& q) { return q.z() < near_m_; })) return false;
  if (beyond([](const Eigen::Vector3f& q) { return q.x() > q.z(); }) ||
      beyond([](const Eigen::Vector3f& q) { return -q.x() > q.z(); }) ||
      beyond([](const Eigen::Vector3f& q) { return q.y() > q.z(); }) ||
      beyond([](const Eigen::Vector3f& q) { return -q.y() > q.z(); })) {
    return false;
  }
  const float half = 0.5F * static_cast<float>(cells_);
  const auto keep = [&](const Eigen::Vector3f& q) {
    out.corners[out.count++] = {half + half * q.x() / q.z(), half + half * q.y() / q.z()};
  };
  out.count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f& a = p[i];
    const Eigen::Vector3f& b = p[(i + 1) % 3];
    if (a.z() >= near_m_) keep(a);
    if ((a.z() >= near_m_) == (b.z() >= near_m_)) continue;
    Eigen::Vector3f cut = a + (b - a) * ((near_m_ - a.z()) / (b.z() - a.z()));
    cut.z() = near_m_;
    keep(cut);
  }
  if (out.count < 3) return false;
  // nearness . ray with ray = depth ((u - half) / half, (v - half) / half, 1) is 1 on the triangle: so it is per depth.
  const Eigen::Vector3f& nearness = seen_[triangle].nearness;
  out.du = nearness[across[0]] / half;
  out.dv = nearness[across[1]] / half;
  out.at_origin = sign * nearness[axis] - half * (out.du + out.dv);
  out.top = std::numeric_limits<float>::max();
  out.bottom = -out.top;
  for (std::size_t i = 0; i < out.count; ++i) {
    out.top = std::min(out.top, out.corners[i].y());
    out.bottom = std::max(out.bottom, out.corners[i].y());
  }
  return true;
}

/// Notes the cells of a row that a triangle covers wholly, and its farthest depth in each: nothing behind that throws a shadow of its own there.
/// \return how many.
std::size_t LampView::cover_row(std::size_t face, const Outline& o, int y) {
  const auto limit = static_cast<float>(cells_);
  const float farthest = 0.5F * (std::abs(o.du) + std::abs(o.dv));
  float left = 0.0F;
  float right = 0.0F;
  float left_below = 0.0F;
  float right_below = 0.0F;
  if (!o.across(static_cast<float>(y), left, right)) return 0;
  if (!o.across(static_cast<float>(y + 1), left_below, right_below)) return 0;
  const int begin = static_cast<int>(std::ceil(std::clamp(std::max(left, left_below) + kWider, 0.0F, limit)));
  const int end = static_cast<int>(std::floor(std::clamp(std::min(right, right_below) - kWider, 0.0F, limit)));
  float* row = &covered_[(face * static_cast<std::size_t>(cells_) + static_cast<std::size_t>(y)) *
                         static_cast<std::size_t>(cells_)];
  const float start = o.at_origin + o.dv * (static_cast<float>(y) + 0.5F) + o.du * 0.5F - farthest;
  for (int x = begin; x < end; ++x) row[x] = std::max(row[x], start + o.du * static_cast<float>(x));
  return static_cast<std::size_t>(std::max(end - begin, 0));
}

/// Enters a triangle in every cell of a row that it touches and in which nothing covers it. \return how many it touches.
std::size_t LampView::enter_row(std::size_t face, std::uint32_t triangle, const Outline& o, int y) {
  const auto limit = static_cast<float>(cells_);
  const float nearest = 0.5F * (std::abs(o.du) + std::abs(o.dv));
  const auto above = static_cast<float>(y);
  const float below = above + 1.0F;
  float left = std::numeric_limits<float>::max();
  float right = -left;
  float l = 0.0F;
  float r = 0.0F;
  if (o.across(above, l, r)) {
    left = std::min(left, l);
    right = std::max(right, r);
  }
  if (o.across(below, l, r)) {
    left = std::min(left, l);
    right = std::max(right, r);
  }
  for (std::size_t i = 0; i < o.count; ++i) {
    if (o.corners[i].y() < above - kWider || o.corners[i].y() > below + kWider) continue;
    left = std::min(left, o.corners[i].x());
    right = std::max(right, o.corners[i].x());
  }
  if (!(left <= right) || right < -kWider || left > limit + kWider) return 0;
  const int begin = static_cast<int>(std::floor(std::clamp(left - kWider, 0.0F, limit - 1.0F)));
  const int end = static_cast<int>(std::floor(std::clamp(right + kWider, 0.0F, limit - 1.0F)));
  const std::size_t row =
      (face * static_cast<std::size_t>(cells_) + static_cast<std::size_t>(y)) * static_cast<std::size_t>(cells_);
  const float start = o.at_origin + o.dv * (above + 0.5F) + o.du * 0.5F + nearest;
  for (int x = begin; x <= end; ++x) {
    const std::size_t cell = row + static_cast<std::size_t>(x);
    if (start + o.du * static_cast<float>(x) < covered_[cell] * 0.9999F) continue;
    if (entries_[cell].triangle == kNone) {
      entries_[cell].triangle = triangle;
    } else if (entries_used_ < entries_.size()) {
      entries_[entries_used_] = {triangle, entries_[cell].next};
      entries_[cell].next = static_cast<std::uint32_t>(entries_used_++);
    } else {
      full_ = true;
    }
  }
  return static_cast<std::size_t>(end - begin + 1);
}

std::uint32_t LampView::cell_of(const Eigen::Vector3f& ray) const {
  const float rx = ray.x();
  const float ry = ray.y();
  const float rz = ray.z();
  const float ax = std::abs(rx);
  const float ay = std::abs(ry);
  const float az = std::abs(rz);
  // As kAcross has it.
  float along = rz;
  float u = rx;
  float v = ry;
  int face = 4;
  if (ax >= ay && ax >= az) {
    along = rx;
    u = ry;
    v = rz;
    face = 0;
  } else if (ay >= az) {
    along = ry;
    u = rz;
    v = rx;
    face = 2;
  }
  face += along < 0.0F ? 1 : 0;
  const float half = 0.5F * static_cast<float>(cells_);
  const float per_depth = half / std::max(std::abs(along), 1e-20F);
  const auto most = static_cast<float>(cells_ - 1);
  const int x = static_cast<int>(std::min(std::max(half + u * per_depth, 0.0F), most));
  const int y = static_cast<int>(std::min(std::max(half + v * per_depth, 0.0F), most));
  return static_cast<std::uint32_t>((face * cells_ + y) * cells_ + x);
}

LampView::Answer LampView::look_along(const Eigen::Vector3f& way, float times, std::uint32_t own) const {
  if (!placed_) return {};
  const Entry* const entries = entries_.data();
  const float most = most_ * times;
  const std::uint32_t first = cell_of(way);
  Answer answer;
  if (entries[first].next == kNone) answer.seen = entries[first].triangle;
  for (std::uint32_t i = first; i != kNone; i = entries[i].next) {
    const std::uint32_t triangle = entries[i].triangle;
    if (triangle == kNone) return answer;
    const Seen& seen = seen_[triangle];
    if (seen.surface == own || !(seen.meets(way) > most)) continue;
    answer.hidden = true;
    return answer;
  }
  return answer;
}

float LampView::reach(const Eigen::Vector3f& p_W) const {
  if (!placed_) return 0.0F;
  const Eigen::Vector3f ray = p_W - p_WL_;
  float nearest = 0.0F;
  for (std::uint32_t i = cell_of(ray); i != kNone; i = entries_[i].next) {
    const std::uint32_t triangle = entries_[i].triangle;
    if (triangle == kNone) break;
    nearest = std::max(nearest, seen_[triangle].meets(ray));
  }
  return nearest > 0.0F ? 1.0F / nearest : std::numeric_limits<float>::infinity();
}

}  // namespace cgsr::shade
