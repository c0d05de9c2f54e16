#pragma once

#include <vector>

#include <Eigen/Core>

#include "platform/error.h"

namespace cgsr::sim {

/// One stop of a path.
struct Waypoint {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  double speed_mps = 0.5;    ///< on the way here; > 0.
  double wait_s = 0.0;       ///< standing here before going on; >= 0.
  double heading_rad = 0.0;  ///< while waiting here, when `turns` says so.
  bool turns = false;        ///< false: keeps the direction it came in.
};

/// Where something is, which way it faces and how far it has walked.
struct PathPoint {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  double heading_rad = 0.0;
  double walked_m = 0.0;
  double speed_mps = 0.0;
};

/// A walk along straight lines at constant speeds: stands at the first waypoint until `start_s`, then goes from one to the next, waits
/// where it should, and stands at the last. It looks where it goes; turning takes time at `turn_radps`, about the middle of the turn.
class Path {
 public:
  Path() = default;

  /// \return what is wrong: no waypoint, a speed that is not above zero, a wait below zero, a number that is not finite.
  static Result<Path> make(std::vector<Waypoint> waypoints, double start_s, double turn_radps, bool loops);

  /// Standing for ever.
  static Path standing(const Eigen::Vector3d& p_W, double heading_rad);

  [[nodiscard]] PathPoint at(double time_s) const;
  [[nodiscard]] double duration_s() const;

 private:
  struct Leg {  // one straight walk or one wait
    double begin_s;
    double end_s;
    Eigen::Vector3d from;
    Eigen::Vector3d to;
    double heading_rad;
    double walked_before_m;
  };

  [[nodiscard]] double heading_near(std::size_t leg, double time_s, bool again) const;

  std::vector<Leg> legs_;  // never empty once made; consecutive in time
  double turn_radps_ = 2.0;
  bool loops_ = false;
};

}  // namespace cgsr::sim
