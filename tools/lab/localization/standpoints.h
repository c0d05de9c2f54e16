#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/pose.h"
#include "pipeline/localization/correction.h"
#include "tools/lab/localization/place.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

/// The edges of what a robot's map holds as the simulator has them, and which of them a camera sees: by casting rays, not by any code of the
/// vision.
class TrueEdges {
 public:
  explicit TrueEdges(const sim::Scene& scene);

  /// \return how many edges have a piece of at least `min_px` in one go that nothing hides.
  [[nodiscard]] int seen(Place& place, const geometry::Pose& X_WC, double min_px = 20.0) const;

  [[nodiscard]] std::size_t size() const { return edges_.size(); }

 private:
  std::vector<std::array<Eigen::Vector3f, 2>> edges_;
};

/// Where a robot may stand.
struct Area {
  double left_m;
  double right_m;
  double near_m;
  double far_m;
};

/// \return the floor of a shipped world.
Area area_of(std::string_view world);

/// Where a camera is.
struct Standpoint {
  geometry::Pose X_WR = geometry::Pose::Identity();
  geometry::Pose X_WC = geometry::Pose::Identity();
  int edges = 0;  ///< that it sees.
};

struct View {
  int min_edges = 6;
  int most_edges = 1 << 20;
};

/// Draws a place on the floor with 35 cm of air around the camera and its mast, any heading, tilted by N(0, 1 degree) about either axis, that
/// sees as many edges as was asked for.
/// \return nothing when two thousand draws did not meet one.
std::optional<Standpoint> draw_standpoint(Place& place, const TrueEdges& edges, const Area& area, const View& view,
                                          Random& random);

/// How far a prior is off: N(0, 15 cm) along the floor, 4 degrees of heading, 1 degree of tilt about either axis, all of them `scale` times
/// as much.
geometry::Vector6d draw_prior_error(double scale, Random& random);

/// \return the camera's pose as the robot believes it: off by `error`, and by the mount that it was told instead of its own.
geometry::Pose believed(const geometry::Pose& X_WC, const geometry::Vector6d& error, const geometry::Pose& X_RC,
                        const geometry::Pose& X_RC_told);

}  // namespace cgsr::lab
