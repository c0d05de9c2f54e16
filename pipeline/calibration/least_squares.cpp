#include "pipeline/calibration/least_squares.h"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace cgsr::calibration {

Fit fit_least_squares(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& residuals_at,
                      Eigen::VectorXd parameters) {
  constexpr double kStep = 1e-6;
  constexpr int kMostRounds = 60;
  const Eigen::Index n = parameters.size();
  Fit fit;
  fit.residuals = residuals_at(parameters);
  double cost = fit.residuals.squaredNorm();
  double damping = 1e-4;
  Eigen::MatrixXd normal(n, n);
  Eigen::MatrixXd jacobian(fit.residuals.size(), n);
  for (int round = 0; round < kMostRounds; ++round) {
    for (Eigen::Index i = 0; i < n; ++i) {
      Eigen::VectorXd up = parameters;
      Eigen::VectorXd down = parameters;
      up[i] += kStep;
      down[i] -= kStep;
      jacobian.col(i) = (residuals_at(up) - residuals_at(down)) / (2.0 * kStep);
    }
    normal = jacobian.transpose() * jacobian;
    const Eigen::VectorXd slope = jacobian.transpose() * fit.residuals;
    bool better = false;
    double step_length = 0.0;
    while (!better && damping < 1e12) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() *= 1.0 + damping;
      damped.diagonal().array() += 1e-15;
      const Eigen::VectorXd step = -damped.ldlt().solve(slope);
      const Eigen::VectorXd residuals = residuals_at(parameters + step);
      const double new_cost = residuals.squaredNorm();
      better = new_cost < cost;
      if (better) {
        parameters += step;
        fit.residuals = residuals;
        step_length = step.norm();
        cost = new_cost;
        damping = std::max(damping * 0.1, 1e-12);
      } else {
        damping *= 10.0;
      }
    }
    if (!better || step_length < 1e-12) break;
  }
  const auto freedom = static_cast<double>(std::max<Eigen::Index>(fit.residuals.size() - n, 1));
  fit.covariance = cost / freedom * normal.completeOrthogonalDecomposition().pseudoInverse();
  fit.rms = std::sqrt(cost / static_cast<double>(std::max<Eigen::Index>(fit.residuals.size(), 1)));
  fit.parameters = parameters;
  return fit;
}

}  // namespace cgsr::calibration
