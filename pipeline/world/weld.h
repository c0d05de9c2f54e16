#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace cgsr::world {

/// Points that are nearer to each other than `tolerance_m` become one, the first of them. Ours.
/// \param kept  filled with the points that are left.  \return for every point its index in `kept`.
std::vector<std::uint32_t> weld(std::span<const Eigen::Vector3f> points, double tolerance_m,
                                std::vector<Eigen::Vector3f>& kept);

}  // namespace cgsr::world
