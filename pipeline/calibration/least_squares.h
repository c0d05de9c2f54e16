#pragma once

#include <cmath>
#include <functional>

#include <Eigen/Core>

namespace cgsr::calibration {

/// What a fit came to.
struct Fit {
  Eigen::VectorXd parameters;
  Eigen::VectorXd residuals;
  Eigen::MatrixXd covariance;  ///< of the parameters, the residuals' own scatter taken for their error.
  double rms = 0.0;            ///< of the residuals.

  [[nodiscard]] double sigma(Eigen::Index i) const { return std::sqrt(covariance(i, i)); }
};

/// (Levenberg 1944, Marquardt 1963) with differences for derivatives: for calibrations, which have few parameters and all the time.
/// \param residuals_at  a vector as long as there are measurements, out of parameters of order 1 (metres, radians, scales).
Fit fit_least_squares(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& residuals_at,
                      Eigen::VectorXd parameters);

}  // namespace cgsr::calibration
