#include "tools/lab/probes_trial.h"

#include <cmath>

#include <Eigen/LU>

namespace cgsr::lab {
namespace {

constexpr double kChi2 = 11.345;  // three degrees of freedom, 99 %

}  // namespace

Result<stages::ProbesStage> measured_probes(const ProbeRoom& room, const config::Robot& robot, std::uint32_t seed,
                                            const illumination::LampParameters& lamp) {
  const RobotCopy copy = RobotCopy::measured(room, seed, robot.probes.board);
  const auto board = illumination::make_board(copy.board, copy.X_RC, copy.camera);
  if (!board) return tl::unexpected(board.error());
  illumination::ProbesParameters probes = robot.probes;
  probes.board = copy.board;
  return stages::ProbesStage(*board, probes, lamp, copy.X_RC);
}

LampError lamp_error(const Eigen::Vector3d& off_m, const Eigen::Matrix3d& covariance) {
  return {100.0 * off_m.norm(), 100.0 * std::sqrt(covariance.trace()), off_m.dot(covariance.inverse() * off_m) < kChi2};
}

}  // namespace cgsr::lab
