#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/lamp_filter.h"
#include "pipeline/render/shadow_volumes.h"
#include "pipeline/world/map.h"
#include "platform/parameters.h"

namespace cgsr {

/// Section [shade] of a robot's file.
struct ShadeStageParameters {
  double max_lamp_sigma_m = 0.3;
  double max_lamp_shift_m = 0.01;
  render::ShadeParameters masks;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("max_lamp_sigma_m", self.max_lamp_sigma_m, {0.001, 10.0}, "m",
                 "a lamp that is known no better makes no masks");
    visit.number("max_lamp_shift_m", self.max_lamp_shift_m, {0.0, 1.0}, "m",
                 "so far the lamp's estimate may wander before its silhouettes are made anew");
    visit.section("masks", self.masks, "How shaded regions are found (5.2)");
  }
};

enum class ShadeStatus : std::uint8_t {
  kMasked,       ///< there are masks.
  kNoMap,        ///< what could throw shadows is not known.
  kNoLamp,       ///< no lamp is known: ambient light only.
  kLampUnsure,   ///< known too roughly.
  kPoseUnknown,  ///< where the camera is is not known.
};
std::string_view name_of(ShadeStatus status);

/// The masks small enough to be handed to another thread by value: two bits a cell, for people's eyes.
class ShadePicture {
 public:
  static constexpr int kWidth = 160;
  static constexpr int kHeight = 120;

  void take(const render::ShadeMasks& masks);
  /// Bit 0: possibly shaded. Bit 1: the surface there is shaded.
  [[nodiscard]] int at(int column, int row) const {
    const auto cell = static_cast<std::size_t>(row * kWidth + column);
    return cells_[cell / 4] >> (2 * (cell % 4)) & 3;
  }

 private:
  std::array<std::uint8_t, kWidth * kHeight / 4> cells_{};
};

/// What lies in shadow in an image.
struct ShadeSight {
  ShadeStatus status = ShadeStatus::kNoMap;
  const render::ShadeMasks* masks = nullptr;  ///< until the stage's next run; null: none, and why `status` says.
  ShadePicture picture{};
};

/// Chapter 5's second half as the vision loop holds it: map, pose and lamp to the two masks.
///
/// Threads: one. After construction nothing here allocates.
class WhatIsShaded {
 public:
  /// \param map  outlives it.  \param camera  of the images that come.
  WhatIsShaded(const world::Map& map, const geometry::Camera& camera, const ShadeStageParameters& parameters)
      : camera_(camera), parameters_(parameters), volumes_(map, parameters.masks) {}

  /// \param lamp  null: none is known.
  ShadeSight look(const geometry::Pose& X_WC, const geometry::Matrix6d& covariance,
                  const illumination::KnownLamp* lamp);

 private:
  geometry::Camera camera_;
  ShadeStageParameters parameters_;
  render::ShadowVolumes volumes_;
  Eigen::Vector3d p_WL_kept_ = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
};

}  // namespace cgsr
