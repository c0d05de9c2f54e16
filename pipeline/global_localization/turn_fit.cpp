#include "pipeline/global_localization/turn_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "pipeline/localization/solve.h"
#include "pipeline/localization/work.h"

namespace cgsr::global_localization {
namespace {

using geometry::Matrix6d;
using geometry::Pose;
using geometry::Vector6d;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kWholeTurn = 2.0 * std::numbers::pi;
constexpr int kRounds = 8;
constexpr int kCoarseRounds = 4;  // of every other image, by turns
constexpr float kFirstRadius_px = 24.0F;
constexpr float kLeastRadius_px = 4.0F;
constexpr float kShrink = 0.7F;        // of the matching radius with each round
constexpr double kRobustShare = 0.33;  // of it: farther off a distance counts less and less,
constexpr double kRobustSigmas = 2.0;  // ... but not within so many sigmas
constexpr double kIndependent = 0.1;   // of distances: wrong matches lie side by side

}  // namespace

TurnFit::TurnFit(localization::Localizer& localizer, const Pose& X_RC, const GlobalLocalizerParameters& parameters)
    : localizer_(&localizer), X_RC_(X_RC) {
  Vector6d sigmas;
  sigmas << parameters.place_sigma_m, parameters.place_sigma_m, parameters.heading_sigma_deg * kDegree,
      parameters.drift_sigma_m, parameters.drift_sigma_m, parameters.drift_sigma_deg * kDegree;
  prior_information_ = sigmas.array().square().inverse();
}

void TurnFit::begin(const Pose& X_WR) {
  X_WR_begun_ = X_WR;
  off_.setZero();
  round_ = 0;
  begin_round();
}

void TurnFit::begin_round() {
  information_.setZero();
  gradient_.setZero();
  view_ = round_ < kCoarseRounds ? static_cast<std::size_t>(round_ % 2) : 0;
}

float TurnFit::radius_px() const {
  return kFirstRadius_px * std::pow(kShrink, static_cast<float>(round_));
}

bool TurnFit::go_on(const Turn& turn, WorkBudget& budget) {
  while (round_ < kRounds) {
    while (view_ < kViews) {
      if (!localization::granted(budget, localization::kLookUnits + localization::kRoundUnits)) return false;
      add(turn, turn.keyframes()[view_]);
      view_ += round_ < kCoarseRounds ? 2 : 1;
    }
    step();
    ++round_;
    begin_round();
  }
  return true;
}

Pose TurnFit::X_WR(const Turn& turn, const Keyframe& keyframe) const {
  const double part = keyframe.turned_rad / kWholeTurn;
  const Eigen::Vector3d& begun = X_WR_begun_.translation();
  Pose X_WR =
      geometry::pose_on_floor(begun.x() + off_(0), begun.y() + off_(1), geometry::heading_of(X_WR_begun_) + off_(2)) *
      turn.X_FR(keyframe);
  X_WR.linear() = Eigen::AngleAxisd(part * off_(5), Eigen::Vector3d::UnitZ()).toRotationMatrix() * X_WR.linear();
  X_WR.translation().head<2>() += part * off_.segment<2>(3);
  return X_WR;
}

// Each distance by how the robot's place and heading move it.
void TurnFit::add(const Turn& turn, const Keyframe& keyframe) {
  const double part = keyframe.turned_rad / kWholeTurn;
  const Pose X_WR_here = X_WR(turn, keyframe);
  const Pose X_WC = X_WR_here * X_RC_;
  // A turn at the first image moves the robot too where it does not pivot on its middle; one of its odometry does not.
  Eigen::Vector3d arm = X_WC.translation() - X_WR_here.translation();
  const Eigen::Vector3d by_turn_here = Eigen::Vector3d::UnitZ().cross(arm);
  arm = X_WC.translation() - X_WR_begun_.translation();
  arm.head<2>() -= off_.head<2>() + part * off_.segment<2>(3);
  const Eigen::Vector3d by_turn_at_first = Eigen::Vector3d::UnitZ().cross(arm);
  const auto lines = localizer_->distances_from(X_WC, keyframe.edges, std::max(kLeastRadius_px, radius_px()));
  for (const localization::LineDistance& line : lines) {
    double distance_px = 0.0;
    Eigen::Matrix<double, 1, 6> by_camera;
    if (!localization::distance_of(line, X_WC, localizer_->camera(), distance_px, by_camera)) continue;
    Vector6d by_off;
    const auto by_turn = [&](const Eigen::Vector3d& moves) { return by_camera.head<3>().dot(moves) + by_camera(5); };
    by_off << by_camera(0), by_camera(1), by_turn(by_turn_at_first), part * by_camera(0), part * by_camera(1),
        part * by_turn(by_turn_here);
    const double reach_px = std::max(kRobustSigmas * line.sigma_px, kRobustShare * static_cast<double>(radius_px()));
    const double in_reach = distance_px / reach_px;
    const double weight = kIndependent * line.weight / (line.sigma_px * line.sigma_px * (1.0 + in_reach * in_reach));
    information_ += weight * by_off * by_off.transpose();
    gradient_ += weight * distance_px * by_off;
  }
}

void TurnFit::step() {
  information_.diagonal() += prior_information_;
  gradient_ += prior_information_.cwiseProduct(off_);
  const Vector6d step = information_.llt().solve(gradient_);
  if (step.allFinite()) off_ -= step;
}

}  // namespace cgsr::global_localization
