#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "pipeline/illumination/board.h"
#include "pipeline/illumination/luma_view.h"
#include "pipeline/illumination/probe_shadow.h"
#include "pipeline/illumination/shadow_brightness.h"
#include "pipeline/illumination/soft_step.h"

namespace cgsr::illumination {

/// What a fit begins with.
struct ShadowStart {
  Eigen::Vector2d tip_shadow = Eigen::Vector2d::Zero();  ///< on the board.
  double contrast = 0.0;                                 ///< grey levels.
  double level = 0.0;                                    ///< of the board at the foot.
  double seen_level = 0.0;                               ///< likewise, as the image holds it.
  double lamp_radius_m = 0.0;                            ///< 0: what the parameters say.
  double known_m = 0.0;  ///< how well the tip is known beforehand; 0: not, and the tip itself is not looked at.
};

/// Fits the shadow of a probe to the brightness along both of its lines: the shadow of the tip, the foot and radius of the base within what
/// calibration leaves open, the shadow's contrast, how soft its edges are and the board's brightness, a plane; where the image is clipped, as far as the dark side of the edges tells it. The softness tells the lamp's
/// radius; beforehand it is known to the parameters' standard deviation. No edge image is needed, all of a line counts, and a line that is half hidden is completed.
/// Ours; the dissertation finds the lines by Canny and Hough (Alg. 5.1).
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
  static constexpr std::size_t kMostPlaces = 28;  // along both lines

  struct Choice {
    Eigen::Vector2d tip_shadow;
    double softness_m;
    double slack_m;  // beyond the soft edge
    bool with_tip;
    bool sparse;
  };
  struct Fitted {
    ShadowUnknowns x;
    ShadowNormal information;
    double variance = 0.0;  // of a sample
  };

  void choose(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
              const Choice& choice);
  [[nodiscard]] float ceiling(const LumaView& image) const;
  [[nodiscard]] bool choose_enough(const LumaView& image, const BoardView& view,
                                   const std::array<Outline, kMostProbes>& behind, Choice choice);
  void add_known(const ShadowUnknowns& x, const ShadowStart& start, ShadowSums& sums) const;
  [[nodiscard]] bool settle(const LumaView& image, const BoardView& view,
                            const std::array<Outline, kMostProbes>& behind, const ShadowStart& start, Fitted& fitted);
  [[nodiscard]] double seen_contrast(const ShadowUnknowns& x, const ShadowStart& start) const;
  [[nodiscard]] bool may_be_shadow(const ShadowUnknowns& x, double seen_contrast) const;
  [[nodiscard]] bool is_dark(double seen_contrast, const ShadowNormal& covariance) const;
  [[nodiscard]] bool is_shown(const ShadowUnknowns& x, ProbeShadow& shadow) const;
  [[nodiscard]] double softness_left_open_m(const ShadowUnknowns& x) const;
  [[nodiscard]] Eigen::Matrix2d tip_left_open(const ShadowUnknowns& x) const;
  [[nodiscard]] double reach_on_board(const Eigen::Vector2d& from, const Eigen::Vector2d& line, double most) const;

  Board board_;
  Probe probe_;
  ShadowParameters parameters_;
  double softness_per_radius_;
  SoftStep step_;
  ShadowSamples samples_;
  std::array<Eigen::Vector2f, ShadowSamples::kMost> pixel_{};  // of each sample
  std::array<std::size_t, kMostPlaces> side_of_{};             // which line a place lies along
  ShadowEdges edges_;
};

}  // namespace cgsr::illumination
