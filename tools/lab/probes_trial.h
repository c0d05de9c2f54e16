#pragma once

#include <cstdint>

#include "pipeline/stages/probes_stage.h"
#include "platform/error.h"
#include "src/config/robot.h"
#include "tools/lab/probe_room.h"

namespace cgsr::lab {

/// The robot's own stage for lamps (Alg. 5.1), with board, mount and camera as a copy that was measured with the stated errors.
/// \param seed  of those errors.  \param lamp  instead of the robot's section [lamp].
Result<stages::ProbesStage> measured_probes(const ProbeRoom& room, const config::Robot& robot, std::uint32_t seed,
                                            const illumination::LampParameters& lamp);

/// What an answer of one image is worth.
struct LampError {
  double error_cm = 0.0;
  double sigma_cm = 0.0;      ///< as the estimate states it.
  bool within_bound = false;  ///< the normalised squared error is below the bound that 99 % stay below.
};

/// \param off_m  estimate minus truth.
LampError lamp_error(const Eigen::Vector3d& off_m, const Eigen::Matrix3d& covariance);

}  // namespace cgsr::lab
