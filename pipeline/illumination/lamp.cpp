#include "pipeline/illumination/lamp.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace cgsr::illumination {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Joint = Eigen::Matrix<double, 4, 1>;
using JointCovariance = Eigen::Matrix<double, 4, 4>;

constexpr int kIterations = 5;
constexpr double kLeastAboveTip_m = 0.05;
constexpr double kUnknownHeight_m = 3.0;     // as good as none
constexpr double kMostPlausibleChi2 = 18.0;  // of a pair of shadows that is one lamp's, 2 degrees of freedom

Matrix3d cross(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// The lamp that explains the shadows best, the height having been known with `height_sigma_m`.
struct Fit {
  Vector3d p_RL = Vector3d::Zero();
  Matrix3d covariance = Matrix3d::Zero();
  double chi2 = 0.0;
  bool good = false;
};

Fit fit_lamp(const Board& board, double height_m, double height_sigma_m,
             const std::array<const ProbeShadow*, kMostProbes>& shadow, const geometry::Matrix6d& registration,
             const Vector3d& start_R) {
  Fit fit;
  fit.p_RL = start_R;
  const geometry::Pose X_BR = board.X_RB.inverse();
  const double tip_variance = board.place_sigma_m * board.place_sigma_m;
  const double turn_variance = board.turn_sigma_rad * board.turn_sigma_rad;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Vector3d p_BL = X_BR * fit.p_RL;
    JointCovariance V = JointCovariance::Identity();
    Joint residual = Joint::Zero();
    Eigen::Matrix<double, 4, 3> J = Eigen::Matrix<double, 4, 3>::Zero();
    Eigen::Matrix<double, 4, 6> J_pose = Eigen::Matrix<double, 4, 6>::Zero();
    Eigen::Matrix<double, 4, 3> J_turn = Eigen::Matrix<double, 4, 3>::Zero();
    for (std::size_t i = 0; i < kMostProbes; ++i) {
      if (shadow[i] == nullptr) continue;
      const Vector3d& tip = board.probe[i].p_BA;
      if (p_BL.z() < tip.z() + kLeastAboveTip_m) return fit;
      const auto model = shadow_of(p_BL, tip);
      const auto row = static_cast<Eigen::Index>(2 * i);
      residual.segment<2>(row) = shadow[i]->p_BS - model.p_BS;
      J.middleRows<2>(row) = model.J_lamp * X_BR.linear();
      J_pose.middleRows<2>(row) = shadow[i]->J_pose;
      J_turn.middleRows<2>(row) = model.J_lamp * cross(p_BL);
      V.block<2, 2>(row, row) = shadow[i]->covariance + tip_variance * model.J_tip * model.J_tip.transpose();
    }
    V += J_pose * registration * J_pose.transpose() + turn_variance * J_turn * J_turn.transpose();
    const Eigen::LLT<JointCovariance> weigh(V);
    if (weigh.info() != Eigen::Success) return fit;
    Matrix3d H = J.transpose() * weigh.solve(J);
    Vector3d g = J.transpose() * weigh.solve(residual);
    const double height_weight = 1.0 / (height_sigma_m * height_sigma_m);
    H(2, 2) += height_weight;
    g.z() += height_weight * (height_m - fit.p_RL.z());
    // So that a plane alone has an answer: a lamp is within some metres of the robot.
    constexpr double kFar = 1.0 / (20.0 * 20.0);
    H(0, 0) += kFar;
    H(1, 1) += kFar;
    const Eigen::LLT<Matrix3d> solver(H);
    if (solver.info() != Eigen::Success) return fit;
    fit.covariance = solver.solve(Matrix3d::Identity());
    fit.chi2 = residual.dot(weigh.solve(residual));
    const Vector3d change = solver.solve(g);
    fit.p_RL += change;
    const double low = (board.X_RB.translation().z() + 0.2);
    fit.p_RL.z() = std::max(fit.p_RL.z(), low);
    if (change.squaredNorm() < 1e-10) break;
  }
  fit.good = fit.p_RL.allFinite();
  return fit;
}

Vector3d start_from(const Board& board, double height_m, const ProbeShadow& shadow, std::size_t probe) {
  const double z =
      (board.X_RB.inverse() * Vector3d(board.X_RB.translation().x(), board.X_RB.translation().y(), height_m)).z();
  return board.X_RB * on_ray(shadow.p_BS, board.probe[probe].p_BA, z);
}

}  // namespace

std::string_view to_string(LampStatus status) {
  switch (status) {
    case LampStatus::kFound:
      return "found";
    case LampStatus::kPartial:
      return "partial";
    case LampStatus::kNoShadow:
      return "no shadow";
    case LampStatus::kDisagree:
      return "probes disagree";
    case LampStatus::kBelowTips:
      return "lamp height below the probes";
  }
  return "unknown";
}

Result<void> check_lamp(const Board& board, const LampParameters& parameters) {
  for (int i = 0; i < board.probes; ++i) {
    const double tip_m = (board.X_RB * board.probe[static_cast<std::size_t>(i)].p_BA).z();
    if (parameters.height_m < tip_m + kLeastAboveTip_m) {
      return fail(fmt::format(
          "lamp.height_m = {}: a probe's tip is {:.3f} m above the floor, expected a lamp at least {} m higher",
          parameters.height_m, tip_m, kLeastAboveTip_m));
    }
  }
  return {};
}

Vector3d on_ray(const Vector2d& p_BS, const Vector3d& p_BA, double z_m) {
  const Vector3d from(p_BS.x(), p_BS.y(), 0.0);
  return from + (p_BA - from) * (z_m / p_BA.z());
}

std::optional<Vector3d> nearest_to_rays(std::span<const TipShadow> shadows) {
  Matrix3d H = Matrix3d::Zero();
  Vector3d g = Vector3d::Zero();
  for (const TipShadow& shadow : shadows) {
    const Vector3d from(shadow.p_S.x(), shadow.p_S.y(), 0.0);
    const Vector3d way = (shadow.p_A - from).normalized();
    const Matrix3d across = Matrix3d::Identity() - way * way.transpose();
    H += across;
    g += across * from;
  }
  // Parallel rays leave the way along them open.
  const Eigen::SelfAdjointEigenSolver<Matrix3d> values(H);
  if (shadows.size() < 2 || values.eigenvalues()[0] < 1e-4) return std::nullopt;
  return Vector3d(values.eigenvectors() * (values.eigenvectors().transpose() * g).cwiseQuotient(values.eigenvalues()));
}

ShadowModel shadow_of(const Vector3d& p_BL, const Vector3d& p_BA) {
  ShadowModel model;
  const double a = p_BA.z();
  const double over = 1.0 / (p_BL.z() - a);
  const Vector2d across = (p_BA - p_BL).head<2>();
  model.p_BS = p_BA.head<2>() + across * (a * over);
  model.J_lamp.setZero();
  model.J_lamp(0, 0) = model.J_lamp(1, 1) = -a * over;
  model.J_lamp.col(2) = -across * (a * over * over);
  model.J_tip.setZero();
  model.J_tip(0, 0) = model.J_tip(1, 1) = p_BL.z() * over;
  model.J_tip.col(2) = across * (p_BL.z() * over * over);
  return model;
}

namespace {

// The shadows together; the ray or plane of each alone is where the fit begins.
struct Rays {
  std::array<Vector3d, kMostProbes> alone;
  int count = 0;   // shadows of two lines
  int first = -1;  // the probe whose shadow has most lines
};

Rays rays_of(const Board& board, const LampParameters& parameters,
             const std::array<const ProbeShadow*, kMostProbes>& shadow, LampEstimate& estimate) {
  Rays rays;
  for (std::size_t i = 0; i < kMostProbes; ++i) {
    if (shadow[i] == nullptr) continue;
    estimate.probes |= 1 << i;
    estimate.lines += shadow[i]->lines;
    rays.alone[i] = start_from(board, parameters.height_m, *shadow[i], i);
    if (shadow[i]->lines == 2) ++rays.count;
    if (rays.first < 0 || shadow[i]->lines > shadow[static_cast<std::size_t>(rays.first)]->lines)
      rays.first = static_cast<int>(i);
  }
  return rays;
}

// Where two rays come nearest, whatever the height.
void triangulate(const Board& board, const LampParameters& parameters,
                 const std::array<const ProbeShadow*, kMostProbes>& shadow,
                 const geometry::Matrix6d& registration_covariance, LampEstimate& estimate) {
  const Fit free =
      fit_lamp(board, parameters.height_m, kUnknownHeight_m, shadow, registration_covariance, estimate.p_RL);
  if (!free.good) return;
  estimate.triangulated = true;
  estimate.p_RL_triangulated = free.p_RL;
  estimate.covariance_triangulated = free.covariance;
  estimate.height_measured = free.covariance(2, 2) < parameters.height_sigma_m * parameters.height_sigma_m;
}

}  // namespace

LampEstimate estimate_lamp(const Board& board, const LampParameters& parameters,
                           const std::array<const ProbeShadow*, kMostProbes>& shadow,
                           const geometry::Matrix6d& registration_covariance) {
  LampEstimate estimate;
  if (!check_lamp(board, parameters)) {
    estimate.status = LampStatus::kBelowTips;
    return estimate;
  }
  const Rays rays = rays_of(board, parameters, shadow, estimate);
  if (rays.first < 0) return estimate;
  if (rays.count == 2 && (rays.alone[0] - rays.alone[1]).norm() > parameters.max_disagreement_m) {
    estimate.status = LampStatus::kDisagree;
    return estimate;
  }
  const auto first = static_cast<std::size_t>(rays.first);
  const Fit fit = fit_lamp(board, parameters.height_m, parameters.height_sigma_m, shadow, registration_covariance,
                           rays.alone[first]);
  if (!fit.good) {
    estimate.status = LampStatus::kDisagree;
    return estimate;
  }
  estimate.p_RL = fit.p_RL;
  estimate.covariance = fit.covariance;
  // A plane and a ray, or two planes, that do not fit each other.
  if (estimate.probes == 3 && rays.count < 2 && fit.chi2 > kMostPlausibleChi2) {
    estimate.status = LampStatus::kDisagree;
    return estimate;
  }
  estimate.status = estimate.lines >= 2 ? LampStatus::kFound : LampStatus::kPartial;
  if (rays.count == 2) triangulate(board, parameters, shadow, registration_covariance, estimate);
  const Vector3d to_lamp = board.X_RB.inverse() * estimate.p_RL;
  const Vector2d flat = to_lamp.head<2>() - board.probe[first].p_BA.head<2>();
  estimate.angle_rad = std::atan2(flat.norm(), to_lamp.z());
  return estimate;
}

namespace {

// Which shadows have become lamps as pairs, and why the last pair that did not was refused.
struct Pairs {
  std::array<std::array<bool, ShadowFinder::kMostShadows>, kMostProbes> used{};
  LampStatus refusal = LampStatus::kNoShadow;
};

const ProbeShadow& shadow_at(const ProbeObservation& observation, std::size_t probe, int k) {
  return observation.probe[probe].shadow[static_cast<std::size_t>(k)];
}

// Pairs first, the one whose rays meet best before the other.
Pairs pair_shadows(const Board& board, const LampParameters& parameters, const ProbeObservation& observation,
                   LampEstimates& all) {
  Pairs pairs;
  const int left = observation.probe[0].count;
  const int right = observation.probe[1].count;
  for (int pair = 0; pair < std::min(left, right); ++pair) {
    double best = std::numeric_limits<double>::infinity();
    LampEstimate best_estimate;
    int best_left = -1;
    int best_right = -1;
    for (int l = 0; l < left; ++l) {
      for (int r = 0; r < right; ++r) {
        if (pairs.used[0][static_cast<std::size_t>(l)] || pairs.used[1][static_cast<std::size_t>(r)]) continue;
        const ProbeShadow& at_left = shadow_at(observation, 0, l);
        const ProbeShadow& at_right = shadow_at(observation, 1, r);
        const auto estimate =
            estimate_lamp(board, parameters, {&at_left, &at_right}, observation.registration.covariance);
        if (estimate.status != LampStatus::kFound) {
          pairs.refusal = estimate.status;
          continue;
        }
        const double apart =
            (start_from(board, parameters.height_m, at_left, 0) - start_from(board, parameters.height_m, at_right, 1))
                .norm();
        if (apart >= best) continue;
        best = apart;
        best_estimate = estimate;
        best_left = l;
        best_right = r;
      }
    }
    if (best_left < 0) break;
    pairs.used[0][static_cast<std::size_t>(best_left)] = pairs.used[1][static_cast<std::size_t>(best_right)] = true;
    all.lamp[static_cast<std::size_t>(all.count++)] = best_estimate;
  }
  return pairs;
}

}  // namespace

LampEstimates locate_lamps(const Board& board, const LampParameters& parameters, const ProbeObservation& observation) {
  LampEstimates all;
  if (observation.status != ObservationStatus::kSeen) return all;
  Pairs pairs = pair_shadows(board, parameters, observation, all);
  // Two shadows that would be one lamp's and do not meet are nobody's, but a ray is not given up for a single line.
  if (observation.probe[0].count == 1 && observation.probe[1].count == 1 && all.count == 0) {
    const int left_lines = shadow_at(observation, 0, 0).lines;
    if (left_lines == shadow_at(observation, 1, 0).lines) {
      all.status = pairs.refusal;
      return all;
    }
    pairs.used[left_lines == 2 ? 1 : 0][0] = true;
  }
  for (std::size_t probe = 0; probe < kMostProbes; ++probe) {
    for (int k = 0; k < observation.probe[probe].count; ++k) {
      if (pairs.used[probe][static_cast<std::size_t>(k)] || all.count >= ShadowFinder::kMostShadows) continue;
      std::array<const ProbeShadow*, kMostProbes> alone{};
      alone[probe] = &shadow_at(observation, probe, k);
      const auto estimate = estimate_lamp(board, parameters, alone, observation.registration.covariance);
      pairs.refusal = estimate.status;
      if (estimate.status == LampStatus::kFound || estimate.status == LampStatus::kPartial)
        all.lamp[static_cast<std::size_t>(all.count++)] = estimate;
    }
  }
  all.status = all.count > 0 ? all.lamp[0].status : pairs.refusal;
  return all;
}

}  // namespace cgsr::illumination
