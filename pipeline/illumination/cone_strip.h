#pragma once

#include <array>

#include <Eigen/Core>

#include "pipeline/illumination/board.h"
#include "pipeline/illumination/luma_view.h"
#include "pipeline/illumination/probe_shadow.h"
#include "pipeline/illumination/soft_step.h"

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
  static constexpr int kPlaces = 36;
  static constexpr int kAcross = 14;
  static constexpr int kUnknowns = 10;
  using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
  using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;

  // From where the outline leaves the base: x along it, y away from the cone.
  struct Frame {
    Eigen::Vector2d origin;
    Eigen::Vector2d along;
    Eigen::Vector2d outward;
    double px_per_m = 1000.0;  // across
  };
  struct Sample {
    Eigen::Vector2f at;
    float value;
    int place;
  };
  struct Sums {
    Normal H = Normal::Zero();
    Unknowns g = Unknowns::Zero();
    double squares = 0.0;
    double weights = 0.0;
  };

  [[nodiscard]] bool seen(const Eigen::Vector2d& p_B, const std::array<Outline, kMostProbes>& behind) const;
  [[nodiscard]] bool may_be(const LumaView& image, const BoardView& view,
                            const std::array<Outline, kMostProbes>& behind, const Frame& frame) const;
  int choose_samples(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
                     const Frame& frame);
  [[nodiscard]] bool fit_side(const LumaView& image, const BoardView& view,
                              const std::array<Outline, kMostProbes>& behind, std::size_t side, ProbeShadow& shadow,
                              double& gain);
  [[nodiscard]] Sums sum_up(const Unknowns& x, int count, bool with_shadow, bool darker_counts, int every) const;
  struct Ends {
    std::array<std::size_t, 2> place{};
    std::array<float, 2> fall{};  ///< how much is missing before and not behind it; the larger one first.
  };
  static Ends ends_of(const std::array<float, kPlaces>& missing);
  [[nodiscard]] bool start_from(Unknowns& x, int count) const;
  [[nodiscard]] bool is_shown(const Unknowns& x, int count) const;
  [[nodiscard]] float hidden(const Eigen::Vector2f& from_foot, const Outline& outline, float over_length,
                             float blur_m) const;

  Board board_;
  Probe probe_;
  int index_;
  ShadowParameters parameters_;
  double lamp_height_m_;
  SoftStep step_;
  std::array<Sample, static_cast<std::size_t>(kPlaces) * kAcross> samples_{};
  float blur_m_ = 0.001F;
};

}  // namespace cgsr::illumination
