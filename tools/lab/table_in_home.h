#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "hal/sim/generator/home.h"
#include "hal/sim/scene/scene.h"
#include "platform/error.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

/// Something in a drawn home that a ball can lie on and under, a lamp that throws its shadow, and a robot that sees both. Places are of a
/// ball's lowest point (radius 0.1 m); each is free, and the robot sees the ball's middle.
struct TableInHome {
  std::size_t lamp = 0;  ///< of home.lights.lamps: the one that is on.
  sim::Pose X_WR = sim::Pose::Identity();
  std::vector<Eigen::Vector3d>
      above;  ///< close above the top, in the lamp's light; at the first the robot sees most of the lit side.
  std::vector<Eigen::Vector3d>
      in_shade;                      ///< on the floor below it; what a map holds hides the lamp from the whole ball.
  std::vector<Eigen::Vector3d> lit;  ///< on the floor below or beside it; the whole ball sees the lamp's centre.
};

/// Looks for one by rays, whatever the furniture is called: floor with 0.3 m of air and then something above it within 1.1 m.
/// \return nothing: this home has none that a robot on free floor 1.8 to 5 m away sees so.
Result<std::optional<TableInHome>> find_table(const sim::GeneratedHome& home, Random& random);

/// \return the home's world with the robot that has a probe board alone, at X_WR, and with that lamp alone switched on.
sim::WorldSpec world_at(const sim::GeneratedHome& home, const TableInHome& table);

}  // namespace cgsr::lab
