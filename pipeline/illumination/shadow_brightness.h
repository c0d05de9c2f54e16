#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "pipeline/illumination/lane_sums.h"
#include "pipeline/illumination/soft_step.h"

namespace cgsr::illumination {

inline constexpr int kShadowUnknowns = 10;  ///< ShadowBrightness::Unknown
using ShadowUnknowns = Eigen::Matrix<double, kShadowUnknowns, 1>;
using ShadowNormal = Eigen::Matrix<double, kShadowUnknowns, kShadowUnknowns>;

/// Places on the board with the brightness that was seen there, four to a lane: x, y from the measured foot.
struct ShadowSamples {
  static constexpr int kMost = 320;
  alignas(16) std::array<float, kMost> x{};
  alignas(16) std::array<float, kMost> y{};
  alignas(16) std::array<float, kMost> value{};
  alignas(16) std::array<float, kMost> clipped{};  ///< 1: the image holds no more light here; else 0.
  std::array<int, kMost> place{};                  ///< along the lines, both lines counted on
  int count = 0;
  int clipped_count = 0;

  void clear() { count = clipped_count = 0; }
  /// From `level` on the image holds no more light: what is there or above is clipped, nothing else is. Which neighbour's noise goes over the end of a colour
  /// would choose the darker ones of places that are equally bright.
  void clip_at(float level) {
    clipped_count = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const bool is_clipped = value[i] >= level;
      value[i] = std::min(value[i], level);
      clipped[i] = is_clipped ? 1.0F : 0.0F;
      clipped_count += is_clipped ? 1 : 0;
    }
  }
  void add(const Eigen::Vector2f& from_foot, float level, bool is_clipped, int at) {
    const auto i = static_cast<std::size_t>(count++);
    x[i] = from_foot.x();
    y[i] = from_foot.y();
    value[i] = level;
    clipped[i] = is_clipped ? 1.0F : 0.0F;
    clipped_count += is_clipped ? 1 : 0;
    place[i] = at;
  }
};

/// What is known of the shadow's edges.
struct ShadowEdges {
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();  ///< as measured: what the samples count from.
  double blur_m = 0.0005;                          ///< of the image, on the board: a standard deviation.
  double zero = 0.0;                               ///< of the levels: LightLevels.
  bool like_image =
      false;  ///< what the lamp softens is as what the image blurs, with no end: for a fit that is still far off.
};

/// The normal equations of Gauss and Newton, robust weights counted.
struct ShadowSums {
  ShadowNormal H = ShadowNormal::Zero();
  ShadowUnknowns g = ShadowUnknowns::Zero();
  double squares = 0.0;
  double weights = 0.0;
};

/// The brightness of the board about a probe, with the shadow that ten unknowns describe: both lines are tangents from the shadow of the tip
/// to the base, and the brightness between them is less by the contrast. Levels are compared as the camera coded the light (LightLevels). A place where the image holds no more
/// light is a lower bound of the board's brightness. Ours; the dissertation (Alg. 5.1) takes the lines from an edge image.
class ShadowBrightness {
 public:
  /// Where the shadow of the tip falls, foot and radius of the base, the shadow's contrast, and the board's brightness beside it, a plane about
  /// the measured foot; and the standard deviation of the penumbra where the tip's shadow falls, none at the base. Metres on the board, grey
  /// levels.
  enum Unknown : std::uint8_t { kTipX, kTipY, kFootX, kFootY, kRadius, kDark, kLevel, kSlopeX, kSlopeY, kSoftness };

  /// \param x  valid() is false where the shadow of the tip falls on the base.
  ShadowBrightness(const ShadowUnknowns& x, const ShadowEdges& edges, const SoftStep& step);

  [[nodiscard]] bool valid() const { return valid_; }

  /// Sums over all samples. Allocates nothing.
  [[nodiscard]] ShadowSums sum_up(const ShadowSamples& samples) const;

  struct Value {
    float plain;  ///< without the shadow.
    float
        hidden;  ///< of the contrast that all of the shadow has, 0..1: the share of the lamp that is hidden, as the camera codes it.
  };
  [[nodiscard]] Value at(const Eigen::Vector2f& from_foot) const;

 private:
  // A line, from the base to the tip's shadow.
  struct Line {
    float inward_x = 0.0F, inward_y = 0.0F;
    float along_x = 0.0F, along_y = 0.0F;  // over its length
  };

  void code(const Lane& hidden, Lane& coded, Lane& slope, Lane& by_contrast) const;

  const SoftStep* step_;
  std::array<Line, 2> line_{};
  float in_shadow_ = 0.0F;             ///< of the light beside the shadow, what is left in it.
  float contrast_ = 0.0F;              ///< of the level beside it, above LightLevels::zero.
  bool is_clamped_ = false;            ///< the contrast: the curve stays as it is for a little more of it.
  float off_x_ = 0.0F, off_y_ = 0.0F;  // of the foot from where it was measured
  float radius_ = 0.0F;
  float dark_ = 0.0F;
  float level_ = 0.0F;
  float slope_x_ = 0.0F, slope_y_ = 0.0F;
  float blur_ = 0.0F;
  float disc_ = 1.0F;  ///< 0: no edge has the shape of the lamp.
  float penumbra_ = 0.0F;
  bool valid_ = false;
};

}  // namespace cgsr::illumination
