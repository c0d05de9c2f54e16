#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "pipeline/illumination/board.h"
#include "pipeline/illumination/luma_view.h"
#include "pipeline/illumination/soft_step.h"
#include "platform/parameters.h"

namespace cgsr::illumination {

struct ShadowParameters {
  double lamp_radius_m = 0.05;
  double least_contrast = 2.0;
  double least_share = 0.015;
  double least_support = 0.7;
  double largest_angle_deg = 76.0;
  double spacing_px = 5.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("lamp_radius_m", self.lamp_radius_m, {0.0, 1.0}, "m", "of a lamp: how soft shadows are");
    visit.number("least_contrast", self.least_contrast, {0.5, 100.0}, "grey levels", "between board and shadow");
    visit.number("least_share", self.least_share, {0.0, 1.0}, "", "the same, of the board's brightness");
    visit.number("least_support", self.least_support, {0.0, 1.0}, "",
                 "of the places along a line, how many must show the shadow's own contrast");
    visit.number("largest_angle_deg", self.largest_angle_deg, {30.0, 88.0}, "deg",
                 "of the light from the vertical: beyond it shadows are not looked for");
    visit.number("spacing_px", self.spacing_px, {1.0, 50.0}, "px", "between the places along a line");
  }
};

/// The shadow of one probe's tip on the board's plane, found by the outline of the whole shadow.
struct ProbeShadow {
  Eigen::Vector2d p_BS = Eigen::Vector2d::Zero();
  /// Of what this image's noise and the base's place do to p_BS. With one line only it is large along that line.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  /// d p_BS / d step of the camera (geometry::moved(X_BC, step)): the same camera saw the other probe.
  Eigen::Matrix<double, 2, 6> by_pose = Eigen::Matrix<double, 2, 6>::Zero();
  int lines = 0;  ///< 2: the tip is known; 1: the plane through lamp, tip and this line.
  std::array<bool, 2> line_seen{};
  double contrast = 0.0;  ///< grey levels.
  double support = 0.0;   ///< share of places along the lines that show it.
  double rms = 0.0;       ///< grey levels that the model does not explain.
};

/// Finds the shadows of one probe (Alg. 5.1). Where the dissertation takes Canny's edges and Hough's lines, and then the point where two of them
/// meet, this fits the meeting point itself: the two lines of a cone's shadow are the tangents from the shadow of its tip to its base, so the
/// shadow has two unknowns. A coarse search on rings around the base finds where a dark wedge is, and a fit of brightness with soft edges refines
/// it. What does not have that shape (texture, dirt, a hand) is not taken for it.
class ShadowFinder {
 public:
  static constexpr int kMostShadows = 2;

  /// \param lamp_height_m  a lamp's height above the board, for the width of soft edges. Allocates; nothing below does.
  ShadowFinder(const Board& board, int probe, const ShadowParameters& parameters, double lamp_height_m);

  struct Found {
    std::array<ProbeShadow, kMostShadows> shadow;
    int count = 0;
  };
  /// \param X_BC  the camera against the board, registered in this image.
  /// \param saturation  the brightest level that the image can hold.
  Found find(const LumaView& image, const geometry::Pose& X_BC, double saturation);

  /// Compares every wedge with every ray, which costs five times as much: what the quick search is judged by.
  void search_everywhere() { everywhere_ = true; }

  /// Of the places around the probe that the last image showed, the share that has no level left.
  [[nodiscard]] double share_saturated() const { return saturated_; }

 private:
  static constexpr int kRings = 8;
  static constexpr int kRays = 48;
  static constexpr int kHalfWedge = 7;  // rays to each side that a shadow may cover
  static constexpr int kHalfWindow = 11;
  static constexpr int kLengths = 10;
  static constexpr int kMostSamples = 320;
  using Ring = std::array<float, kRings>;

  struct Candidate {
    Eigen::Vector2d tip_shadow = Eigen::Vector2d::Zero();
    int ray = -1;
    double score = 0.0;
    double contrast = 0.0;
    double level = 0.0;
    double known_m = 0.0;  // how well the tip is known beforehand; 0: not, and the tip itself is not looked at
  };
  struct Sample {
    Eigen::Vector2f from_foot;
    float value;
    int place;  // along the lines, both lines counted on
  };
  struct Place {
    int side = 0;
    float hh = 0.0F, h = 0.0F, hv = 0.0F, v = 0.0F;
    int count = 0;
  };

  [[nodiscard]] double share_brighter_than(double level) const;
  void take_plane_away();
  void look_around(const LumaView& image, const BoardView& view);
  [[nodiscard]] Candidate best_candidate(const std::array<int, 4>& tried, int tried_count, bool everywhere) const;
  [[nodiscard]] bool may_be_middle(int ray) const;
  void sum_rays();
  [[nodiscard]] bool fit(const LumaView& image, const BoardView& view, const Candidate& candidate, ProbeShadow& shadow);
  int choose_samples(const LumaView& image, const BoardView& view, const Eigen::Vector2d& tip_shadow, double slack_m,
                     bool with_tip, bool sparse);
  [[nodiscard]] bool seen(const Eigen::Vector2d& p_B) const;
  void look_for_tip(const LumaView& image, const BoardView& view, ProbeShadow& shadow);
  [[nodiscard]] bool is_filled(const ProbeShadow& shadow) const;
  void take_away(const ProbeShadow& shadow);
  [[nodiscard]] float hidden_share(const Eigen::Vector2d& from_foot, const Outline& outline, double blur_m) const;
  [[nodiscard]] double penumbra_sigma(double along) const;

  Board board_;
  Probe probe_;
  ShadowParameters parameters_;
  double lamp_height_m_;
  SoftStep step_;
  std::array<Eigen::Vector2d, static_cast<std::size_t>(kRings) * kRays> grid_;  // from the foot
  std::vector<Ring> shape_;                                                     // [length][ray -kHalfWedge..kHalfWedge]
  std::vector<Ring> shape_square_;
  std::array<double, kLengths> length_m_{};
  std::array<Ring, kRays> value_{};
  std::array<Ring, kRays> valid_{};
  std::array<float, kRays> ray_value_{};  // their sums
  std::array<float, kRays> ray_valid_{};
  std::array<Outline, kMostProbes> behind_;  // what the cones hide from the camera
  std::array<Sample, kMostSamples> samples_{};
  std::array<Place, 64> places_{};
  double m_per_px_ = 1e-3;
  double level_ = 0.0;  // of the board at the foot
  double saturated_ = 0.0;
  bool everywhere_ = false;
};

}  // namespace cgsr::illumination
