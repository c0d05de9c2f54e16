#include "pipeline/localization/solve.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace cgsr::localization {
namespace {

using geometry::Matrix6d;
using geometry::Pose;
using geometry::Vector6d;

constexpr double kNear_m = 0.02;
constexpr int kLeastDistances = 3;
constexpr double kSettled = 1e-6;  // m and rad

// Everything of a pose and a camera that each distance needs.
struct View {
  View(const Pose& X_WC, const geometry::Camera& camera)
      : R_CW(X_WC.linear().transpose()),
        p_WC(X_WC.translation()),
        fx(camera.fx_px),
        fy(camera.fy_px),
        cx(camera.cx_px),
        cy(camera.cy_px) {}

  bool distance(const LineDistance& line, double& distance_px) const {
    const Eigen::Vector3d p_C = R_CW * (line.p_W - p_WC);
    if (!(p_C.z() > kNear_m)) return false;
    const double inverse = 1.0 / p_C.z();
    distance_px = line.normal.x() * (fx * p_C.x() * inverse + cx) + line.normal.y() * (fy * p_C.y() * inverse + cy) -
                  line.offset_px;
    return true;
  }

  bool distance(const LineDistance& line, double& distance_px, Vector6d& gradient) const {
    const Eigen::Vector3d r_W = line.p_W - p_WC;
    const Eigen::Vector3d p_C = R_CW * r_W;
    if (!(p_C.z() > kNear_m)) return false;
    const double inverse = 1.0 / p_C.z();
    const double u = fx * p_C.x() * inverse;
    const double v = fy * p_C.y() * inverse;
    distance_px = line.normal.x() * (u + cx) + line.normal.y() * (v + cy) - line.offset_px;
    // By p_C, then in W's axes. p_C = R_CW (p_W - p_WC): a step of the origin moves it by -R_CW, a turn w by R_CW [r_W]x w.
    const Eigen::Vector3d by_p_C(line.normal.x() * fx * inverse, line.normal.y() * fy * inverse,
                                 -(line.normal.x() * u + line.normal.y() * v) * inverse);
    const Eigen::Vector3d by_p_W = R_CW.transpose() * by_p_C;
    gradient.head<3>() = -by_p_W;
    gradient.tail<3>() = by_p_W.cross(r_W);
    return true;
  }

  Eigen::Matrix3d R_CW;
  Eigen::Vector3d p_WC;
  double fx;
  double fy;
  double cx;
  double cy;
};

// Cauchy's: the loss of a squared distance in sigmas, and the weight that makes it least squares.
double loss_of(double squared, double robust) {
  return robust > 0.0 ? robust * robust * std::log1p(squared / (robust * robust)) : squared;
}
double weight_of(double squared, double robust) {
  return robust > 0.0 ? 1.0 / (1.0 + squared / (robust * robust)) : 1.0;
}

// Only the lower triangle, and no temporaries: this runs for every distance of every step.
void accumulate(Matrix6d& A, Vector6d& g, const Vector6d& J, double weight, double distance) {
  for (int c = 0; c < 6; ++c) {
    const double weighted = weight * J[c];
    g[c] += weighted * distance;
    for (int r = c; r < 6; ++r) A(r, c) += weighted * J[r];
  }
}

void complete(Matrix6d& A) {
  for (int c = 1; c < 6; ++c)
    for (int r = 0; r < c; ++r) A(r, c) = A(c, r);
}

// The information of the distances and their rms, at a pose.
void summarise(std::span<const LineDistance> lines, const Prior& prior, const Matrix6d& prior_information,
               const geometry::Camera& camera, double robust, Solution& solution) {
  const View view(solution.X_WC, camera);
  Matrix6d A = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double squares = 0.0;
  double weights = 0.0;
  for (const LineDistance& line : lines) {
    double distance = 0.0;
    Vector6d J;
    if (!view.distance(line, distance, J)) continue;
    const double inverse_variance = 1.0 / (line.sigma_px * line.sigma_px);
    const double weight = line.weight * weight_of(distance * distance * inverse_variance, robust);
    accumulate(A, g, J, weight * inverse_variance, distance);
    if (line.end) continue;
    squares += weight * distance * distance;
    weights += weight;
  }
  complete(A);
  solution.data_information = A;
  solution.information = A + prior_information;
  solution.rms_px = weights > 0.0 ? std::sqrt(squares / weights) : 0.0;
  solution.cost = cost_of(lines, solution.X_WC, prior, prior_information, camera, robust).sum;
}

Solution solve_as_the_paper(std::span<const LineDistance> lines, const Pose& start, const Prior& prior,
                            const Matrix6d& prior_information, const geometry::Camera& camera) {
  constexpr double kEpsilon = 1e-5;  // of a step in metres or radians
  Solution solution;
  solution.X_WC = start;
  Matrix6d A = Matrix6d::Identity();  // lambda = 1
  Vector6d g = Vector6d::Zero();
  const Vector6d unit = prior.covariance.diagonal();
  const View here(start, camera);
  int count = 0;
  for (const LineDistance& line : lines) {
    double distance = 0.0;
    if (!here.distance(line, distance)) continue;
    Vector6d J = Vector6d::Zero();
    bool whole = true;
    for (int j = 0; j < 6 && whole; ++j) {
      Vector6d step = Vector6d::Zero();
      step[j] = kEpsilon;
      double there = 0.0;
      whole = View(geometry::moved(start, step), camera).distance(line, there);
      J[j] = (there - distance) / kEpsilon * unit[j];
    }
    if (!whole) continue;
    accumulate(A, g, J, 1.0, distance);
    ++count;
  }
  if (count < kLeastDistances) return solution;
  complete(A);
  const Vector6d p = -A.ldlt().solve(g);
  const Vector6d step = p.cwiseProduct(unit);
  if (!step.allFinite()) return solution;
  solution.X_WC = geometry::moved(start, step);
  solution.solved = true;
  solution.steps = 1;
  summarise(lines, prior, prior_information, camera, 0.0, solution);
  return solution;
}

}  // namespace

bool distance_of(const LineDistance& line, const Pose& X_WC, const geometry::Camera& camera, double& distance,
                 Eigen::Matrix<double, 1, 6>& jacobian) {
  Vector6d gradient = Vector6d::Zero();
  if (!View(X_WC, camera).distance(line, distance, gradient)) return false;
  jacobian = gradient.transpose();
  return true;
}

Cost cost_of(std::span<const LineDistance> lines, const Pose& X_WC, const Prior& prior,
             const Matrix6d& prior_information, const geometry::Camera& camera, double robust) {
  const View view(X_WC, camera);
  Cost cost;
  for (const LineDistance& line : lines) {
    double distance = 0.0;
    if (!view.distance(line, distance)) continue;
    cost.sum += line.weight * loss_of(distance * distance / (line.sigma_px * line.sigma_px), robust);
    ++cost.count;
  }
  const Vector6d off = geometry::step_between(prior.X_WC, X_WC);
  cost.sum += off.dot(prior_information * off);
  return cost;
}

// A loop of its own, beside calibration::least_squares: this one runs dozens of times per image. Its sizes are fixed, nothing is allocated, and its
// damping is begun only when a full step fails; a point that falls behind the camera drops out of the sum, which a general solver does not know.
Solution solve(std::span<const LineDistance> lines, const Pose& start, const Prior& prior,
               const Matrix6d& prior_information, const geometry::Camera& camera, const SolverOptions& options) {
  if (options.paper) return solve_as_the_paper(lines, start, prior, prior_information, camera);
  Solution solution;
  solution.X_WC = start;
  const Cost first = cost_of(lines, start, prior, prior_information, camera, options.robust);
  if (first.count < kLeastDistances || !std::isfinite(first.sum)) return solution;
  double cost = first.sum;
  double damping = 0.0;
  for (int i = 0; i < options.steps; ++i) {
    const View view(solution.X_WC, camera);
    Matrix6d A = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
    for (const LineDistance& line : lines) {
      double distance = 0.0;
      Vector6d J;
      if (!view.distance(line, distance, J)) continue;
      const double inverse_variance = 1.0 / (line.sigma_px * line.sigma_px);
      const double weight = line.weight * weight_of(distance * distance * inverse_variance, options.robust);
      accumulate(A, g, J, weight * inverse_variance, distance);
    }
    complete(A);
    // The prior's error turns with the pose by less than its own size: its derivative is taken as 1.
    A += prior_information;
    g += prior_information * geometry::step_between(prior.X_WC, solution.X_WC);
    bool better = false;
    Vector6d step = Vector6d::Zero();
    for (int attempt = 0; attempt < 4 && !better; ++attempt) {
      Matrix6d damped = A;
      damped.diagonal() *= 1.0 + damping;
      step = -damped.ldlt().solve(g);
      if (!step.allFinite()) return solution;
      const Pose there = geometry::moved(solution.X_WC, step);
      const Cost after = cost_of(lines, there, prior, prior_information, camera, options.robust);
      // A point that fell behind the camera must not count as an improvement.
      if (after.count >= first.count && after.sum <= cost) {
        solution.X_WC = there;
        cost = after.sum;
        damping *= 0.1;
        better = true;
      } else {
        damping = damping > 0.0 ? damping * 10.0 : 1e-2;
      }
    }
    ++solution.steps;
    if (!better || step.cwiseAbs().maxCoeff() < kSettled) break;
  }
  solution.X_WC = geometry::normalized(solution.X_WC);
  solution.solved = true;
  summarise(lines, prior, prior_information, camera, options.robust, solution);
  return solution;
}

}  // namespace cgsr::localization
