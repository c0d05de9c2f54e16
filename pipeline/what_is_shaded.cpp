#include "pipeline/what_is_shaded.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace cgsr {
namespace {

double largest_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
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
    case ShadeStatus::kPoseUnknown:
      return "pose not known";
  }
  return "unknown";
}

void ShadePicture::take(const render::ShadeMasks& masks) {
  for (int row = 0; row < kHeight; ++row) {
    const int from_row = row * masks.height / kHeight * masks.width;
    for (int column = 0; column < kWidth; column += 4) {
      unsigned four = 0;
      for (int k = 0; k < 4; ++k) {
        const auto from = static_cast<std::size_t>(from_row + (column + k) * masks.width / kWidth);
        const unsigned two = (masks.possibly_shaded[from] & 1U) | (masks.surface_shaded[from] & 2U);
        four |= two << (2 * k);
      }
      cells_[static_cast<std::size_t>((row * kWidth + column) / 4)] = static_cast<std::uint8_t>(four);
    }
  }
}

ShadeSight WhatIsShaded::look(const geometry::Pose& X_WC, const geometry::Matrix6d& covariance,
                              const illumination::KnownLamp* lamp) {
  ShadeSight sight;
  if (lamp == nullptr) {
    sight.status = ShadeStatus::kNoLamp;
    return sight;
  }
  const double lamp_sigma_m = largest_sigma(lamp->covariance);
  if (!(lamp_sigma_m <= parameters_.max_lamp_sigma_m)) {
    sight.status = ShadeStatus::kLampUnsure;
    return sight;
  }
  sight.status = ShadeStatus::kMasked;
  // Silhouettes cost far more than a new view of them: an estimate that wanders a little keeps the old ones, at the price of its way.
  Eigen::Vector3d way = lamp->p_WL - p_WL_kept_;
  if (!(way.norm() <= parameters_.max_lamp_shift_m)) {
    p_WL_kept_ = lamp->p_WL;
    way.setZero();
  }
  const render::ShadeErrors errors{lamp->covariance + way * way.transpose(), covariance};
  sight.masks = &volumes_.look(X_WC, camera_, p_WL_kept_, errors);
  sight.picture.take(*sight.masks);
  return sight;
}

}  // namespace cgsr
