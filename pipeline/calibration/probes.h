#pragma once

#include <array>
#include <string>
#include <vector>

#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/board.h"
#include "pipeline/illumination/probe_observation.h"
#include "platform/error.h"

namespace cgsr::calibration {

/// One image of the probes: what was seen, and where the robot was.
struct ProbeView {
  int image = 0;
  illumination::ProbeObservation observation;
  geometry::Pose X_WR = geometry::Pose::Identity();
};

/// Camera, board and probes as images with a lamp at a known place say.
struct ProbeCalibration {
  geometry::Pose X_RC = geometry::Pose::Identity();  ///< the mount, by board and cones as they are seen.
  illumination::BoardParameters board;
  std::array<Eigen::Vector3d, 2> tip_sigma_m{};
  Eigen::Vector3d turn_sigma_deg = Eigen::Vector3d::Zero();
  double rms_before_m = 0.0;  ///< of shadows from where they should fall.
  double rms_m = 0.0;
  int views = 0;
  int shadows = 0;
};

/// Moves each tip, and turns the board, until the lamp's shadows fall where they were seen; what was measured by hand is the prior. Tips and turn
/// come apart where images show the lamp from different sides. The mount is the mean of what each image's registration found. Ours; the shadows fall along the rays of Eq. 5.1 and 5.2.
///
/// \param board  as `views` were observed with. \param p_WL  where the lamp is, world frame.
/// \return or why not: fewer than four shadows, shadows that contradict each other (RMS above 4 mm).
Result<ProbeCalibration> calibrate_probes(const illumination::Board& board,
                                          const illumination::BoardParameters& parameters,
                                          const std::vector<ProbeView>& views, const Eigen::Vector3d& p_WL);

/// Sections [mount] and [board] of robot.toml, as `cgsr light` reads them.
std::string probes_as_toml(const ProbeCalibration& calibration);

}  // namespace cgsr::calibration
