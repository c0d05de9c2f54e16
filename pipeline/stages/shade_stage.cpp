#include "pipeline/stages/shade_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

namespace cgsr::stages {
namespace {

double max_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

constexpr std::size_t kMasks = 6;  // written, last, two on their way to housekeeping, one read there, one to spare

shade::ShadeMasks empty_masks(const shade::ShadeParameters& parameters) {
  const auto cells = static_cast<std::size_t>(parameters.width) * static_cast<std::size_t>(parameters.height);
  return {parameters.width, parameters.height, std::vector<std::uint8_t>(cells), std::vector<std::uint8_t>(cells)};
}

illumination::KnownLamp known_lamp(const GivenLamp& lamp) {
  illumination::KnownLamp known;
  known.p_WL = Eigen::Vector3d(lamp.position_m[0], lamp.position_m[1], lamp.position_m[2]);
  known.covariance = lamp.sigma_m * lamp.sigma_m * Eigen::Matrix3d::Identity();
  return known;
}

}  // namespace

std::string_view to_string(ShadeStatus status) {
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
      return "a new place of the lamp is being prepared";
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
      given_(known_lamp(parameters.lamp)),
      volumes_(std::make_shared<shade::ShadowVolumes>(*map_, parameters.masks)),
      masks_(kMasks, empty_masks(parameters.masks)) {}

std::optional<ShadowMasks> ShadeStage::update(WorkBudget& budget, const runtime::Aged<PoseEstimate>& pose,
                                              const runtime::Aged<LampReport>& lamp) {
  const PoseEstimate* const now = pose.within(Duration::zero());
  if (now == nullptr || !now->known()) return with_events({ShadeStatus::kPoseUnknown, {}});
  const LampReport* const report = lamp.within(kMaxLampAge);
  if (!lamp.value.has_board && parameters_.lamp.given)
    return update(budget, now->camera.X_WC, now->camera.covariance, &given_);
  return update(budget, now->camera.X_WC, now->camera.covariance,
                report != nullptr && report->known ? &report->lamp : nullptr);
}

std::optional<ShadowMasks> ShadeStage::update(WorkBudget& budget, const geometry::Pose& X_WC,
                                              const geometry::Matrix6d& covariance,
                                              const illumination::KnownLamp* lamp) {
  auto masks = masks_for(budget, X_WC, covariance, lamp);
  if (!masks) return std::nullopt;
  return with_events(std::move(*masks));
}

ShadowMasks ShadeStage::with_events(ShadowMasks output) {
  if (output.status != status_) output.events.add({"shadow masks", to_string(output.status), {}});
  status_ = output.status;
  return output;
}

std::optional<ShadowMasks> ShadeStage::masks_for(WorkBudget& budget, const geometry::Pose& X_WC,
                                                 const geometry::Matrix6d& covariance,
                                                 const illumination::KnownLamp* lamp) {
  if (lamp == nullptr) return ShadowMasks{ShadeStatus::kNoLamp, {}};
  const double lamp_sigma_m = max_sigma(lamp->covariance);
  if (!(lamp_sigma_m <= parameters_.max_lamp_sigma_m)) return ShadowMasks{ShadeStatus::kLampUnsure, {}};
  // Silhouettes cost far more than a new view of them: an estimate that wanders a little keeps the old ones, at the price of its way. A turn
  // either works on new ones or looks: both together would exceed what a turn may cost.
  const Eigen::Vector3d way = lamp->p_WL - volumes_->lamp();
  const bool usable = way.norm() <= parameters_.max_lamp_sigma_m;
  const bool looks = way.norm() <= parameters_.max_lamp_shift_m || (usable && !looked_last_);
  looked_last_ = looks;
  if (!looks) {
    volumes_->prepare(place_to_prepare(lamp->p_WL), budget);
    if (usable) return std::nullopt;
    return ShadowMasks{ShadeStatus::kPreparing, {}};
  }
  const shade::ShadeErrors errors{lamp->covariance + way * way.transpose(), covariance};
  auto masks = masks_.take();
  if (!masks) return ShadowMasks{ShadeStatus::kNoRoom, {}};
  masks.edit() = volumes_->look(X_WC, camera_, volumes_->lamp(), errors);
  return ShadowMasks{ShadeStatus::kMasked, std::move(masks), {}, volumes_};
}

// What is being prepared is not begun anew for every image's estimate, only where it lies elsewhere, or further off than what there is.
Eigen::Vector3d ShadeStage::place_to_prepare(const Eigen::Vector3d& p_WL) const {
  const double off_m = (p_WL - volumes_->next_lamp()).norm();
  const bool goes_on = off_m <= parameters_.max_lamp_sigma_m && off_m <= (p_WL - volumes_->lamp()).norm();
  return goes_on ? volumes_->next_lamp() : p_WL;
}

}  // namespace cgsr::stages
