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

void LampAnswers::judge(const Eigen::Vector3d& p_RL, const stages::LampReport& report) {
  ++asked;
  if (report.single_image.count == 0 || report.single_image.status != illumination::LampStatus::kFound) {
    ++unanswered[std::string(reason_of(report))];
    return;
  }
  const auto& estimate = report.single_image.lamp[0];
  const LampError off = lamp_error(estimate.p_RL - p_RL, estimate.covariance);
  error_cm.push_back(off.error_cm);
  sigma_cm.push_back(off.sigma_cm);
  within_bound += off.within_bound ? 1 : 0;
}

void AnswersByLamp::add(const LampAnswers& lamp) {
  if (lamp.asked == 0) return;
  const auto count = static_cast<double>(lamp.error_cm.size());
  answered_.push_back(count / lamp.asked);
  if (lamp.error_cm.empty()) return;
  error_cm_.push_back(mean(lamp.error_cm));
  sigma_cm_.push_back(mean(lamp.sigma_cm));
  within_bound_.push_back(lamp.within_bound / count);
}

void AnswersByLamp::add_rows(const std::string& row, std::uint64_t seed, Report& report) const {
  if (answered_.empty()) return;
  report.rows.push_back(mean_row(row, "answered", "", answered_, seed));
  if (error_cm_.empty()) return;
  report.rows.push_back(mean_row(row, "mean error", "cm", error_cm_, seed));
  report.rows.push_back(mean_row(row, "stated sigma", "cm", sigma_cm_, seed));
  report.rows.push_back(mean_row(row, "within its 99 % bound", "", within_bound_, seed));
}

LampError lamp_error(const Eigen::Vector3d& off_m, const Eigen::Matrix3d& covariance) {
  return {100.0 * off_m.norm(), 100.0 * std::sqrt(covariance.trace()), off_m.dot(covariance.inverse() * off_m) < kChi2};
}

}  // namespace cgsr::lab
