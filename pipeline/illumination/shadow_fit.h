#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "pipeline/illumination/board.h"
#include "pipeline/illumination/luma_view.h"
#include "pipeline/illumination/probe_shadow.h"
#include "pipeline/illumination/soft_step.h"

namespace cgsr::illumination {

/// What a fit begins with.
struct ShadowStart {
  Eigen::Vector2d tip_shadow = Eigen::Vector2d::Zero();  ///< on the board.
  double contrast = 0.0;                                 ///< grey levels.
  double level = 0.0;                                    ///< of the board at the foot.
  double known_m = 0.0;  ///< how well the tip is known beforehand; 0: not, and the tip itself is not looked at.
};

/// Fits the shadow of a probe to the brightness along both of its lines: the shadow of the tip, the foot and radius of the base within what
/// calibration leaves open, the shadow's contrast and the board's brightness, a plane. Edges are as soft as a lamp of the given radius makes
/// them. No edge image is needed, all of a line counts, and a line that is half hidden is completed.
///
/// Nothing is allocated.
class ShadowFit {
 public:
  /// \param lamp_height_m  a lamp's height above the board, for the width of soft edges.
  ShadowFit(const Probe& probe, const Board& board, const ShadowParameters& parameters, double lamp_height_m);

  /// \param behind  what each cone hides from the camera.
  /// \return whether a shadow of that shape is there, and `shadow`.
  bool fit(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
           const ShadowStart& start, ProbeShadow& shadow);

 private:
  static constexpr int kMostSamples = 320;
  static constexpr int kUnknowns = 9;
  using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

  struct Sample {
    Eigen::Vector2f from_foot;
    float value;
    int place;  // along the lines, both lines counted on
  };
  // What the samples across a line at one place say by themselves.
  struct Place {
    int side = 0;
    float hh = 0.0F, h = 0.0F, hv = 0.0F, v = 0.0F;
    int count = 0;
  };
  struct Choice {
    Eigen::Vector2d tip_shadow;
    double slack_m;  // beyond the soft edge
    bool with_tip;
    bool sparse;
  };
  struct Sums {
    Normal H = Normal::Zero();
    Unknowns g = Unknowns::Zero();
    double variance = 0.0;  // of a sample
  };

  int choose(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
             const Choice& choice);
  int choose_enough(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
                    Choice choice);
  [[nodiscard]] bool sum_up(const Unknowns& x, int count, Sums& sums);
  void add_known(const Unknowns& x, const ShadowStart& start, Sums& sums) const;
  [[nodiscard]] bool settle(const LumaView& image, const BoardView& view,
                            const std::array<Outline, kMostProbes>& behind, const ShadowStart& start, Unknowns& x,
                            Sums& sums);
  [[nodiscard]] bool may_be_shadow(const Unknowns& x) const;
  [[nodiscard]] bool is_shown(ProbeShadow& shadow) const;
  [[nodiscard]] double reach_on_board(const Eigen::Vector2d& from, const Eigen::Vector2d& line, double most) const;
  [[nodiscard]] double penumbra_sigma(double along) const;

  Board board_;
  Probe probe_;
  ShadowParameters parameters_;
  double lamp_height_m_;
  SoftStep step_;
  std::array<Sample, kMostSamples> samples_{};
  std::array<Place, 64> places_{};
  double m_per_px_ = 1e-3;
};

}  // namespace cgsr::illumination
