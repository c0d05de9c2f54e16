#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/pose.h"
#include "pipeline/render/view.h"

namespace cgsr::render {

/// What a camera can see, as planes in W: n . p + offset >= 0 inside. Left, right, top, bottom, near. This is the viewing frustum (2.2) without
/// its far plane; offsets are in metres.
struct Frustum {
  std::array<Eigen::Vector3f, 5> normal;
  std::array<float, 5> offset{};
  Eigen::Vector3f p_WC = Eigen::Vector3f::Zero();
};

Frustum frustum_of(const geometry::Pose& X_WC, const View& view, double near_m);

/// How much one call of SphereGroups::select() looks at and answers with.
struct SelectionLimits {
  int max_visited = 8192;  ///< spheres, whole groups of them, nearest first.
  int max_chosen = std::numeric_limits<int>::max();
  int max_weight = std::numeric_limits<int>::max();  ///< of the chosen together.
};

/// What is left where more is in view than the limits allow.
enum class Preference : std::uint8_t {
  kNearest,  ///< what may hide others: nothing nearer than reach_m() is missing. What holds the camera is taken whatever the limits say.
  kLargest,  ///< by what they look like: radius over distance.
};

/// Bounding spheres in groups of neighbours: what is not in view is left out by the group, and where too much is in view the nearest groups
/// and, of them, the things that are preferred are taken. Made once; select() allocates nothing.
/// Culling by bounding volumes of a hierarchy (Clark 1976), here of two levels: the pruning that the dissertation (4.4) leaves open.
class SphereGroups {
 public:
  struct Sphere {
    Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< in W, metres.
    float radius = 0.0F;
    std::uint32_t weight = 0;  ///< counted with Preference::kNearest only.
  };
  static constexpr float kEverything = std::numeric_limits<float>::infinity();

  SphereGroups(std::span<const Sphere> spheres, const SelectionLimits& limits, Preference preference);

  /// \param least  spheres whose radius is less than so many times their distance are left out.
  /// \param within_m  spheres that lie further away as a whole are left out.
  /// \return indices into the spheres of those that touch the frustum, ascending when nothing had to be left out of a small map; valid until
  ///         the next call. Cost: about 10 instructions a group, and 10 a sphere in the groups that are in view.
  std::span<const std::uint32_t> select(const Frustum& frustum, double least = 0.0, float within_m = kEverything);

  /// \return how far from the camera the last answer is whole: what the limits left out lies beyond. kEverything when they left out nothing.
  [[nodiscard]] float reach_m() const { return reach_m_; }

 private:
  struct Spheres {
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> z;
    std::vector<float> radius;
    void resize(std::size_t count);
  };
  struct Ranked {
    float rank;  ///< less is better.
    std::uint32_t index;
  };

  void nearest_groups();
  void keep_if_wanted(std::size_t place, const Frustum& frustum, float min_squared, float within_m);
  void keep_preferred(const Frustum& frustum);
  void keep_within_weight();
  [[nodiscard]] bool too_many() const;

  std::size_t count_;
  std::size_t looked_at_most_;
  std::size_t chosen_most_;
  std::uint64_t weight_most_;
  Preference preference_;
  Spheres items_;
  Spheres groups_;
  std::vector<std::uint32_t> weight_;  ///< of the sphere at a place of items_.
  std::vector<std::uint32_t> index_;   ///< likewise.
  std::vector<float> group_margin_;
  std::vector<float> margin_;
  std::vector<Ranked> ranked_;
  std::vector<std::uint32_t> place_;
  std::vector<std::uint32_t> chosen_;
  std::uint64_t weight_in_view_ = 0;
  float reach_m_ = kEverything;
};

}  // namespace cgsr::render
