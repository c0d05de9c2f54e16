#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pipeline/stages/probes_stage.h"
#include "platform/error.h"
#include "src/config/robot.h"
#include "tools/lab/experiment.h"
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

/// What the images of one lamp, one by one, told of its place.
struct LampAnswers {
  std::vector<double> error_cm, sigma_cm;
  int asked = 0;
  int within_bound = 0;
  std::map<std::string, int> unanswered;  ///< images, by reason.

  /// \param p_RL  where the lamp truly is.
  void judge(const Eigen::Vector3d& p_RL, const stages::LampReport& report);
};

/// Means of lamps, or of homes with one each.
class AnswersByLamp {
 public:
  /// Nothing where it was not asked.
  void add(const LampAnswers& lamp);
  /// Intervals are over the lamps.
  void add_rows(const std::string& row, std::uint64_t seed, Report& report) const;

 private:
  std::vector<double> answered_, error_cm_, sigma_cm_, within_bound_;
};

}  // namespace cgsr::lab
