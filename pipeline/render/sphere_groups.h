#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/pose.h"
#include "pipeline/render/view.h"

namespace cgsr::render {

/// What a camera can see, as planes in W: n . p + offset >= 0 inside. Left, right, top, bottom, near.
struct Frustum {
  std::array<Eigen::Vector3f, 5> normal;
  std::array<float, 5> offset{};
  Eigen::Vector3f p_WC = Eigen::Vector3f::Zero();
};

Frustum frustum_of(const geometry::Pose& X_WC, const View& view, double near_m);

/// Bounding spheres in groups of neighbours: what is not in view is left out by the group, and where too much is in view the nearest groups
/// and, of them, the things that look largest are taken. Made once; select() allocates nothing.
class SphereGroups {
 public:
  struct Sphere {
    Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< in W, metres.
    float radius = 0.0F;
  };

  /// \param looked_at_most  spheres that one call of select() looks at, whole groups, nearest first.
  /// \param chosen_most  indices that it answers with.
  SphereGroups(std::span<const Sphere> spheres, int looked_at_most, int chosen_most);

  /// \param least  spheres whose radius is less than so many times their distance are left out.
  /// \return indices into the spheres of those that touch the frustum, ascending when nothing had to be left out of a small map; valid until
  ///         the next call. Cost: about 10 instructions a group, and 10 a sphere in the groups that are in view.
  std::span<const std::uint32_t> select(const Frustum& frustum, double least = 0.0);

  /// \return whether the last answer lacks something that may be in view.
  [[nodiscard]] bool cut() const { return cut_; }

 private:
  struct Spheres {
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> z;
    std::vector<float> radius;
    void resize(std::size_t count);
  };
  struct Near {
    float distance_m;
    std::uint32_t index;
  };

  void keep_if_large(std::size_t place, const Frustum& frustum, float least_squared);
  void keep_largest(const Frustum& frustum);

  std::size_t count_;
  std::size_t looked_at_most_;
  std::size_t chosen_most_;
  Spheres items_;
  Spheres groups_;
  std::vector<std::uint32_t> index_;  ///< of the sphere that stands at a place of items_.
  std::vector<float> group_margin_;
  std::vector<float> margin_;
  std::vector<Near> near_;
  std::vector<std::uint32_t> place_;
  std::vector<std::uint32_t> chosen_;
  bool cut_ = false;
};

}  // namespace cgsr::render
