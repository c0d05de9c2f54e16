#include "tools/lab/shade_trial.h"

#include <cstdint>
#include <utility>

#include <fmt/format.h>

namespace cgsr::lab {
namespace {

constexpr int kMaxTurns = 10000;

}  // namespace

runtime::StageBudget budget_of(const runtime::StageParameters& row) {
  return runtime::StageBudget::of_units(row.units > 0 ? static_cast<std::uint32_t>(row.units)
                                                      : runtime::StageBudget::kAll);
}

geometry::Matrix6d StatedErrors::pose() const {
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  covariance.topLeftCorner<3, 3>() = place_sigma_m * place_sigma_m * Eigen::Matrix3d::Identity();
  covariance.bottomRightCorner<3, 3>() = turn_sigma_rad * turn_sigma_rad * Eigen::Matrix3d::Identity();
  return covariance;
}

illumination::KnownLamp StatedErrors::lamp(const Eigen::Vector3d& p_WL) const {
  illumination::KnownLamp lamp;
  lamp.p_WL = p_WL;
  lamp.covariance = lamp_sigma_m * lamp_sigma_m * Eigen::Matrix3d::Identity();
  return lamp;
}

Result<stages::ShadowMasks> masks_of(stages::ShadeStage& stage, const runtime::StageParameters& row,
                                     const geometry::Pose& X_WC, const geometry::Matrix6d& covariance,
                                     const illumination::KnownLamp& lamp) {
  auto status = stages::ShadeStatus::kPreparing;
  for (int turn = 0; turn < kMaxTurns && status == stages::ShadeStatus::kPreparing; ++turn) {
    auto budget = budget_of(row);
    auto masks = stage.update(budget, X_WC, covariance, &lamp);
    if (!masks) continue;
    if (masks->masks) return std::move(*masks);
    status = masks->status;
  }
  return fail(fmt::format("no shadow masks: {}", to_string(status)));
}

stages::ShadowMasks given_masks(shade::ShadeMasks masks) {
  Pool<shade::ShadeMasks> pool(1, std::move(masks));
  return {stages::ShadeStatus::kMasked, pool.take()};
}

color::BallSighting BallTracker::track(const ImageView& image, const stages::ShadowMasks& masks) {
  auto budget = budget_of(row_);
  const runtime::Aged<stages::ShadowMasks> fresh{masks, {}, Duration::zero()};
  return stage_->update(budget, image, {}, {}, fresh, {}).first().ball;
}

}  // namespace cgsr::lab
