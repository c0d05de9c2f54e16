#pragma once

#include <array>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "pipeline/illumination/board.h"
#include "pipeline/illumination/luma_view.h"
#include "pipeline/illumination/probe_shadow.h"
#include "pipeline/illumination/strip_model.h"

namespace cgsr::illumination {

/// The shadow that lies behind its own cone but for a strip beside the cone's outline, some pixels wide: light from behind the camera, at small
/// angles. Searching and Alg. 5.1's lines cannot see it, since what is dark there is mixed with the cone's own edge. So both are explained at
/// once: brightness goes from the cone's to the board's across an outline whose exact place is unknown, and the board is darker by a shadow whose
/// tip is unknown. Beyond the tip the outline without a shadow shows what it looks like.
///
/// Nothing is allocated.
class ConeStrip {
 public:
  ConeStrip(const Board& board, int probe, const ShadowParameters& parameters, double lamp_height_m);

  /// \param behind  what each cone hides from the camera.
  /// \return whether a strip is there, and `shadow`.
  bool find(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
            ProbeShadow& shadow);

 private:
  static constexpr int kPlaces = StripModel::kPlaces;
  static constexpr int kAcross = 14;
  using Unknowns = StripModel::Unknowns;

  // From where the outline leaves the base: x along it, y away from the cone.
  struct Frame {
    Eigen::Vector2d origin;
    Eigen::Vector2d along;
    Eigen::Vector2d outward;
    double px_per_m = 1000.0;  // across
  };
  struct Fit {
    Unknowns x = Unknowns::Zero();
    StripModel::Sums sums;
    double variance = 1.0;  // of a sample, grey levels squared
    StripModel::Normal H = StripModel::Normal::Zero();
  };
  struct Ends {
    std::array<std::size_t, 2> place{};
    std::array<float, 2> fall{};  ///< how much is missing before and not behind it; the larger one first.
  };
  // Sums of the squared share that a shadow hides, and of its product with the residual.
  struct ShadowMatch {
    float hh = 0.0F;
    float hr = 0.0F;
  };

  [[nodiscard]] std::span<const StripSample> samples() const {
    return {samples_.data(), static_cast<std::size_t>(sample_count_)};
  }
  [[nodiscard]] bool is_seen(const Eigen::Vector2d& p_B, const std::array<Outline, kMostProbes>& behind) const;
  [[nodiscard]] bool may_be(const LumaView& image, const BoardView& view,
                            const std::array<Outline, kMostProbes>& behind, const Frame& frame) const;
  int choose_samples(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
                     const Frame& frame);
  [[nodiscard]] bool fit_side(const LumaView& image, const BoardView& view,
                              const std::array<Outline, kMostProbes>& behind, std::size_t side, ProbeShadow& shadow,
                              double& gain);
  [[nodiscard]] std::optional<Frame> frame_beside(const BoardView& view, const Outline& outline,
                                                  std::size_t side) const;
  [[nodiscard]] std::optional<Unknowns> first_guess(const Frame& frame) const;
  [[nodiscard]] bool solve(Fit& fit, const StripModel::Pass& pass) const;
  static Ends ends_of(const std::array<float, kPlaces>& missing);
  [[nodiscard]] bool guess_tip(Unknowns& x) const;
  [[nodiscard]] ShadowMatch match_shadow(const Unknowns& from, const Eigen::Vector2d& tip,
                                         std::span<const float> residual) const;
  [[nodiscard]] std::optional<double> gain_of(const Fit& fit) const;
  [[nodiscard]] bool is_shown(const Unknowns& x) const;
  [[nodiscard]] bool is_plausible(const Fit& fit) const;
  [[nodiscard]] bool place_shadow(const Fit& fit, const Frame& frame, const BoardView& view, ProbeShadow& shadow) const;

  Board board_;
  Probe probe_;
  int index_;
  ShadowParameters parameters_;
  StripModel model_;
  double softness_per_radius_;
  Unknowns prior_weight_;
  std::array<StripSample, static_cast<std::size_t>(kPlaces) * kAcross> samples_{};
  int sample_count_ = 0;
};

}  // namespace cgsr::illumination
