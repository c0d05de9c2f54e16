#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "pipeline/illumination/board.h"
#include "pipeline/illumination/lane_sums.h"
#include "pipeline/illumination/probe_shadow.h"
#include "pipeline/illumination/soft_step.h"

namespace cgsr::illumination {

/// A place beside a cone's outline and what the image shows there.
struct StripSample {
  Eigen::Vector2f at;  ///< along the outline from where it leaves the base, and away from the cone [m].
  float value;         ///< grey level.
  int place;           ///< the place along the outline, 0 to StripModel::kPlaces - 1.
};

/// The numbers that StripModel fits: metres, grey levels, grey levels per metre.
enum StripUnknown : std::uint8_t {
  kTipAlong,     ///< the shadow's tip, along the outline.
  kTipOut,       ///< the same, away from the cone.
  kShadowDepth,  ///< how much darker the board is in the shadow.
  kBoardLevel,   ///< the board's brightness where the outline leaves the base.
  kSlopeAlong,   ///< its rise along the outline.
  kSlopeOut,     ///< its rise away from the cone.
  kCone,         ///< the cone's brightness.
  kConeSlope,    ///< its rise along the outline.
  kEdge,         ///< the outline's place against the registered one.
  kEdgeSlope,    ///< what is added to that at the outline's far end.
  kSoftEnd,      ///< the standard deviation of the penumbra at the tip [m].
};

/// The brightness beside the outline of a cone: it goes from the cone's to the board's across a soft edge, and the board is darker by the shadow
/// of the cone, whose tip is unknown.
/// Ours, for ConeStrip; the tangents of a shadow's outline are the lines of Alg. 5.1.
///
/// Nothing is allocated. Threads: one.
class StripModel {
 public:
  static constexpr int kPlaces = 36;
  static constexpr double kStep_m = 0.0025;  ///< between places along the outline.
  static constexpr int kUnknowns = 11;
  using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
  using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;

  explicit StripModel(const Probe& probe);

  /// \param blur_m  of the lens, the pixel and the reading between pixels, on the board.
  void set_blur(float blur_m) { blur_m_ = blur_m; }

  /// Which part of the model is fitted to which samples.
  struct Pass {
    bool with_shadow;
    bool darker_counts;  ///< a sample darker than the model counts as much as a brighter one.
    int every;           ///< 1: all samples, 2: every second one.
    int iterations;
  };
  /// The normal equations of Gauss and Newton.
  struct Sums {
    Normal H = Normal::Zero();
    Unknowns g = Unknowns::Zero();
    double squares = 0.0;
    double weights = 0.0;
  };
  [[nodiscard]] Sums sum_up(const Unknowns& x, std::span<const StripSample> samples, const Pass& pass) const;

  /// What a sample shows against the model without a shadow.
  struct Shadowless {
    float board;    ///< the share of the board in the sample; the rest is cone.
    float missing;  ///< grey levels by which the sample is darker.
  };
  [[nodiscard]] Shadowless without_shadow(const Unknowns& x, const StripSample& sample) const;

  /// The shadow whose tip is at `tip`, in the frame of the samples; not valid when the tip lies within the base.
  [[nodiscard]] Outline shadow_outline(const Eigen::Vector2d& tip) const;

  /// The share of a lamp that the cone hides from the place of a sample: 0 lit, 1 in full shadow.
  /// \param over_length  1 / the length of the shadow's tangents [1/m].
  [[nodiscard]] float hidden(const Unknowns& x, const StripSample& sample, const Outline& outline,
                             float over_length) const;

 private:
  // The shadow's two tangents.
  struct Wedge {
    std::array<Eigen::Vector2f, 2> inward;
    std::array<Eigen::Vector2f, 2> line;
    std::array<float, 2> over_length{};
    float dark = 0.0F;
    float soft_end = 0.0F;
    bool valid = false;
  };
  struct WedgeLanes {
    Lane dark_share = Lane::Zero();
    Lane J_tip_x = Lane::Zero();
    Lane J_tip_y = Lane::Zero();
    Lane J_soft_end = Lane::Zero();
  };
  struct SampleLanes {
    Lane along;
    Lane out;
    Lane value;
    Lane there;  // 0 past the last sample
  };
  using Floats = Eigen::Matrix<float, kUnknowns, 1>;
  using Row = LaneSums<kUnknowns>::Row;

  [[nodiscard]] Wedge wedge_at(const Unknowns& x) const;
  static SampleLanes lanes_at(std::span<const StripSample> samples, int first, int every);
  [[nodiscard]] WedgeLanes darken(const Wedge& wedge, const Lane& along, const Lane& q) const;
  void linearize(const Floats& f, const SampleLanes& at, const WedgeLanes& shadow, Row& j) const;

  double radius_m_;
  SoftStep step_;
  float blur_m_ = 0.001F;
};

}  // namespace cgsr::illumination
