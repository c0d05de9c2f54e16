#include "pipeline/stages/shade_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

namespace cgsr::stages {
namespace {

double largest_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

constexpr int kUnitsOfALook = 26;  // new masks cost about as much as so many units of work on the silhouettes
constexpr std::size_t kMasks = 6;  // written, last, two on their way to housekeeping, one read there, one to spare

render::ShadeMasks empty_masks(const render::ShadeParameters& parameters) {
  const auto cells = static_cast<std::size_t>(parameters.width) * static_cast<std::size_t>(parameters.height);
  return {parameters.width, parameters.height, std::vector<std::uint8_t>(cells), std::vector<std::uint8_t>(cells)};
}

}  // namespace

std::string_view name_of(ShadeStatus status) {
  switch (status) {
    case ShadeStatus::kMasked:
      return "masked";
    case ShadeStatus::kNoMap:
      return "no map";
    case ShadeStatus::kNoLamp:
      return "no lamp known";
    case ShadeStatus::kLampUnsure:
      return "the lamp is not known well enough";
    case ShadeStatus::kPreparing:
      return "silhouettes of the lamp's new place are being computed";
    case ShadeStatus::kPoseUnknown:
      return "pose not known";
    case ShadeStatus::kNoRoom:
      return "all mask buffers are in use";
  }
  return "unknown";
}

ShadeStage::ShadeStage(std::shared_ptr<const world::Map> map, const geometry::Camera& camera,
                       const ShadeStageParameters& parameters)
    : map_(std::move(map)),
      camera_(camera),
      parameters_(parameters),
      volumes_(*map_, parameters.masks),
      masks_(kMasks, empty_masks(parameters.masks)) {}

std::optional<ShadowMasks> ShadeStage::update(WorkBudget& budget, const runtime::Aged<PoseEstimate>& pose,
                                              const runtime::Aged<LampReport>& lamp) {
  const PoseEstimate* const now = pose.within(Duration::zero());
  if (now == nullptr || !now->known()) return ShadowMasks{ShadeStatus::kPoseUnknown, {}};
  const LampReport* const report = lamp.within(kMaxLampAge);
  return update(budget, now->camera.X_WC, now->camera.covariance,
                report != nullptr && report->known ? &report->lamp : nullptr);
}

std::optional<ShadowMasks> ShadeStage::update(WorkBudget& budget, const geometry::Pose& X_WC,
                                              const geometry::Matrix6d& covariance,
                                              const illumination::KnownLamp* lamp) {
  if (lamp == nullptr) return ShadowMasks{ShadeStatus::kNoLamp, {}};
  const double lamp_sigma_m = largest_sigma(lamp->covariance);
  if (!(lamp_sigma_m <= parameters_.max_lamp_sigma_m)) return ShadowMasks{ShadeStatus::kLampUnsure, {}};
  // A turn either works on the silhouettes of a new place or looks: both together would exceed what a turn may cost. Old silhouettes serve
  // meanwhile for a lamp that may as well be where they are from.
  const bool at_place = (lamp->p_WL - p_WL_kept_).norm() <= parameters_.max_lamp_shift_m;
  const auto usable = [&] { return (lamp->p_WL - p_WL_kept_).norm() <= parameters_.max_lamp_sigma_m; };
  const bool looks = at_place || (usable() && !looked_last_);
  if (at_place) p_WL_prepared_ = kNowhere;
  looked_last_ = looks || prepare(lamp->p_WL, budget);
  if (!looked_last_) {
    if (usable()) return std::nullopt;
    return ShadowMasks{ShadeStatus::kPreparing, {}};
  }
  const Eigen::Vector3d way = lamp->p_WL - p_WL_kept_;
  const render::ShadeErrors errors{lamp->covariance + way * way.transpose(), covariance};
  auto masks = masks_.take();
  if (!masks) return ShadowMasks{ShadeStatus::kNoRoom, {}};
  masks.edit() = volumes_.look(X_WC, camera_, p_WL_kept_, errors);
  return ShadowMasks{ShadeStatus::kMasked, std::move(masks)};
}

// Silhouettes cost far more than a new view of them: an estimate that wanders a little keeps the old ones, at the price of its way. What is being
// computed is not begun anew for every image's estimate, only for one that lies elsewhere.
bool ShadeStage::prepare(const Eigen::Vector3d& p_WL, WorkBudget& budget) {
  if (!((p_WL - p_WL_prepared_).norm() <= parameters_.max_lamp_sigma_m)) p_WL_prepared_ = p_WL;
  if (!volumes_.prepare(p_WL_prepared_, budget)) return false;
  p_WL_kept_ = p_WL_prepared_;
  p_WL_prepared_ = kNowhere;
  for (int unit = 0; unit < kUnitsOfALook; ++unit) {
    if (!budget.grant()) return false;  // the masks come with the next turn
  }
  return true;
}

}  // namespace cgsr::stages
