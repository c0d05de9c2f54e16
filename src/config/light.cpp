#include "src/config/light.h"

#include <cmath>
#include <numbers>

namespace cgsr::config {

geometry::Pose Mount::X_RC() const {
  constexpr double kDegPerRad = 180.0 / std::numbers::pi;
  const double down = down_deg / kDegPerRad;
  const double s = std::sin(down);
  const double c = std::cos(down);
  geometry::Pose X = geometry::Pose::Identity();
  X.linear().col(0) = Eigen::Vector3d(0.0, -1.0, 0.0);
  X.linear().col(1) = Eigen::Vector3d(-s, 0.0, -c);
  X.linear().col(2) = Eigen::Vector3d(c, 0.0, -s);
  const Eigen::Vector3d turn(turn_deg[0], turn_deg[1], turn_deg[2]);
  X.linear() = geometry::rotation_of(turn / kDegPerRad) * X.linear();
  X.translation() = Eigen::Vector3d(position_m[0], position_m[1], position_m[2]);
  return X;
}

}  // namespace cgsr::config
