#include "pipeline/render/sphere_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "pipeline/render/sphere_margins.h"

namespace cgsr::render {
namespace {

constexpr std::size_t kGroup = 64;
constexpr std::size_t kSmallMap =
    8192;  ///< up to here the file's own order groups well enough, and answers come in order.

/// Ten bits of a number, two zeros between each.
std::uint32_t spread(std::uint32_t ten_bits) {
  std::uint32_t v = ten_bits & 0x3FFU;
  v = (v | (v << 16U)) & 0x030000FFU;
  v = (v | (v << 8U)) & 0x0300F00FU;
  v = (v | (v << 4U)) & 0x030C30C3U;
  return (v | (v << 2U)) & 0x09249249U;
}

/// Order of places along a Morton curve: neighbours in the order are neighbours in space.
std::vector<std::uint32_t> order_of(std::span<const SphereGroups::Sphere> spheres) {
  std::vector<std::uint32_t> order(spheres.size());
  std::iota(order.begin(), order.end(), 0U);
  if (spheres.size() <= kSmallMap) return order;
  Eigen::Array3f least = Eigen::Array3f::Constant(std::numeric_limits<float>::max());
  Eigen::Array3f most = -least;
  for (const auto& sphere : spheres) {
    least = least.min(sphere.centre.array());
    most = most.max(sphere.centre.array());
  }
  const float per_m = 1023.0F / std::max((most - least).maxCoeff(), 1e-6F);
  std::vector<std::uint32_t> code(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Eigen::Array3f cell = (spheres[i].centre.array() - least) * per_m;
    code[i] = spread(static_cast<std::uint32_t>(cell.x())) | (spread(static_cast<std::uint32_t>(cell.y())) << 1U) |
              (spread(static_cast<std::uint32_t>(cell.z())) << 2U);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return code[a] < code[b]; });
  return order;
}

constexpr auto better = [](const auto& a, const auto& b) {
  return a.rank != b.rank ? a.rank < b.rank : a.index < b.index;
};

}  // namespace

Frustum frustum_of(const geometry::Pose& X_WC, const View& view, double near_m) {
  Frustum frustum;
  const auto set = [&](std::size_t k, const Eigen::Vector3d& n_C, double offset) {
    const Eigen::Vector3d n_W = X_WC.linear() * n_C.normalized();
    frustum.normal[k] = n_W.cast<float>();
    frustum.offset[k] = static_cast<float>(offset - n_W.dot(X_WC.translation()));
  };
  // Cell -0.5 is the left border: fx x + (cx + 0.5) z >= 0, and so on.
  set(0, {view.fx, 0.0, view.cx + 0.5}, 0.0);
  set(1, {-view.fx, 0.0, view.width - 0.5 - view.cx}, 0.0);
  set(2, {0.0, view.fy, view.cy + 0.5}, 0.0);
  set(3, {0.0, -view.fy, view.height - 0.5 - view.cy}, 0.0);
  set(4, {0.0, 0.0, 1.0}, -near_m);
  frustum.p_WC = X_WC.translation().cast<float>();
  return frustum;
}

void SphereGroups::Spheres::resize(std::size_t count) {
  x.resize(count);
  y.resize(count);
  z.resize(count);
  radius.resize(count);
}

SphereGroups::SphereGroups(std::span<const Sphere> spheres, const SelectionLimits& limits, Preference preference)
    : count_(spheres.size()),
      looked_at_most_(std::max(static_cast<std::size_t>(limits.max_visited), kGroup)),
      chosen_most_(static_cast<std::size_t>(limits.max_chosen)),
      weight_most_(static_cast<std::uint64_t>(limits.max_weight)),
      preference_(preference),
      index_(order_of(spheres)) {
  items_.resize(count_);
  weight_.resize(count_);
  const std::size_t group_count = (count_ + kGroup - 1) / kGroup;
  groups_.resize(group_count);
  group_margin_.resize(group_count);
  margin_.resize(kGroup);
  ranked_.reserve(std::max(group_count, std::min(count_, looked_at_most_ + kGroup)));
  place_.reserve(std::min(count_, looked_at_most_ + kGroup));
  chosen_.reserve(std::min(count_, looked_at_most_ + kGroup));
  for (std::size_t i = 0; i < count_; ++i) {
    const Sphere& sphere = spheres[index_[i]];
    items_.x[i] = sphere.centre.x();
    items_.y[i] = sphere.centre.y();
    items_.z[i] = sphere.centre.z();
    items_.radius[i] = sphere.radius;
    weight_[i] = sphere.weight;
  }
  for (std::size_t g = 0; g < group_count; ++g) {
    const std::size_t first = g * kGroup;
    const std::size_t last = std::min(first + kGroup, count_);
    Eigen::Array3f least = Eigen::Array3f::Constant(std::numeric_limits<float>::max());
    Eigen::Array3f most = -least;
    for (std::size_t i = first; i < last; ++i) {
      const Eigen::Array3f centre(items_.x[i], items_.y[i], items_.z[i]);
      least = least.min(centre - items_.radius[i]);
      most = most.max(centre + items_.radius[i]);
    }
    const Eigen::Array3f centre = 0.5F * (least + most);
    float radius = 0.0F;
    for (std::size_t i = first; i < last; ++i) {
      const Eigen::Array3f at(items_.x[i], items_.y[i], items_.z[i]);
      radius = std::max(radius, (at - centre).matrix().norm() + items_.radius[i]);
    }
    groups_.x[g] = centre.x();
    groups_.y[g] = centre.y();
    groups_.z[g] = centre.z();
    groups_.radius[g] = radius;
  }
}

std::span<const std::uint32_t> SphereGroups::select(const Frustum& frustum, double least, float within_m) {
  const auto min_squared = static_cast<float>(least * least);
  reach_m_ = kEverything;
  weight_in_view_ = 0;
  ranked_.clear();
  place_.clear();
  chosen_.clear();
  margins_in(frustum, groups_.x.data(), groups_.y.data(), groups_.z.data(), group_margin_.size(), group_margin_.data());
  for (std::size_t g = 0; g < group_margin_.size(); ++g) {
    if (group_margin_[g] < -groups_.radius[g]) continue;
    const Eigen::Vector3f centre(groups_.x[g], groups_.y[g], groups_.z[g]);
    const float near_m = (centre - frustum.p_WC).norm() - groups_.radius[g];
    if (near_m <= within_m) ranked_.push_back({near_m, static_cast<std::uint32_t>(g)});
  }
  if (ranked_.size() * kGroup > looked_at_most_) nearest_groups();
  for (const Ranked& group : ranked_) {
    const std::size_t first = group.index * kGroup;
    const std::size_t last = std::min(first + kGroup, count_);
    if (group_margin_[group.index] >= groups_.radius[group.index]) {  // all of it is in view
      for (std::size_t i = first; i < last; ++i) keep_if_wanted(i, frustum, min_squared, within_m);
      continue;
    }
    margins_in(frustum, &items_.x[first], &items_.y[first], &items_.z[first], last - first, margin_.data());
    for (std::size_t i = first; i < last; ++i) {
      if (margin_[i - first] >= -items_.radius[i]) keep_if_wanted(i, frustum, min_squared, within_m);
    }
  }
  if (too_many()) keep_preferred(frustum);
  for (const std::uint32_t place : place_) chosen_.push_back(index_[place]);
  return chosen_;
}

void SphereGroups::nearest_groups() {
  const auto end = ranked_.begin() + static_cast<std::ptrdiff_t>(looked_at_most_ / kGroup);
  std::nth_element(ranked_.begin(), end, ranked_.end(), better);
  reach_m_ = end->rank;
  ranked_.erase(end, ranked_.end());
  std::sort(ranked_.begin(), ranked_.end(), [](const Ranked& a, const Ranked& b) { return a.index < b.index; });
}

void SphereGroups::keep_if_wanted(std::size_t place, const Frustum& frustum, float min_squared, float within_m) {
  const float x = items_.x[place] - frustum.p_WC.x();
  const float y = items_.y[place] - frustum.p_WC.y();
  const float z = items_.z[place] - frustum.p_WC.z();
  const float radius = items_.radius[place];
  const float squared = x * x + y * y + z * z;
  const float furthest = within_m + radius;
  if (radius * radius < min_squared * squared || squared > furthest * furthest) return;
  place_.push_back(static_cast<std::uint32_t>(place));
  weight_in_view_ += weight_[place];
}

bool SphereGroups::too_many() const {
  return place_.size() > chosen_most_ || (preference_ == Preference::kNearest && weight_in_view_ > weight_most_);
}

void SphereGroups::keep_preferred(const Frustum& frustum) {
  ranked_.clear();
  for (const std::uint32_t place : place_) {
    const Eigen::Vector3f centre(items_.x[place], items_.y[place], items_.z[place]);
    const float distance = (centre - frustum.p_WC).norm();
    const float radius = items_.radius[place];
    ranked_.push_back(
        {preference_ == Preference::kNearest ? distance - radius : distance / std::max(radius, 1e-6F), place});
  }
  std::size_t max_chosen = chosen_most_;
  if (preference_ == Preference::kNearest) {
    const auto holds_camera = [](const Ranked& each) { return each.rank <= 0.0F; };
    const auto about = std::count_if(ranked_.begin(), ranked_.end(), holds_camera);
    max_chosen = std::max(max_chosen, static_cast<std::size_t>(about));
  }
  if (ranked_.size() > max_chosen) {
    const auto end = ranked_.begin() + static_cast<std::ptrdiff_t>(max_chosen);
    std::nth_element(ranked_.begin(), end, ranked_.end(), better);
    if (preference_ == Preference::kNearest) reach_m_ = std::min(reach_m_, end->rank);
    ranked_.erase(end, ranked_.end());
  }
  if (preference_ == Preference::kNearest) keep_within_weight();
  place_.clear();
  for (const Ranked& kept : ranked_) place_.push_back(kept.index);
  std::sort(place_.begin(), place_.end());
}

void SphereGroups::keep_within_weight() {
  std::uint64_t weight = 0;
  for (const Ranked& kept : ranked_) weight += weight_[kept.index];
  if (weight <= weight_most_) return;
  std::sort(ranked_.begin(), ranked_.end(), better);
  weight = 0;
  // A sphere that holds the camera may hide whatever there is: left out, nothing could be told of any place.
  const auto end = std::find_if(ranked_.begin(), ranked_.end(), [&](const Ranked& kept) {
    weight += weight_[kept.index];
    return weight > weight_most_ && kept.rank > 0.0F;
  });
  if (end == ranked_.end()) return;
  reach_m_ = std::min(reach_m_, end->rank);
  ranked_.erase(end, ranked_.end());
}

}  // namespace cgsr::render
