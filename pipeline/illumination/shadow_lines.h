#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "pipeline/illumination/board.h"
#include "pipeline/illumination/luma_view.h"
#include "pipeline/illumination/probe_shadow.h"
#include "pipeline/illumination/shadow_fit.h"
#include "pipeline/illumination/soft_step.h"

namespace cgsr::illumination {

inline constexpr double kMostSaturated =
    0.1;  ///< of the places on the board that were looked at; above it: ObservationStatus::kSaturated if there is no shadow.

/// Finds the shadows of one probe (Alg. 5.1). Where the dissertation takes Canny's edges and Hough's lines, and then the point where two of them
/// meet, this looks for the meeting point itself: the two lines of a cone's shadow are the tangents from the shadow of its tip to its base, so the
/// shadow has two unknowns. A coarse search on rings around the base finds where a dark wedge is, its axis how long it is, and ShadowFit refines it. What does not have that shape (texture, dirt, a hand) is not taken for it.
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
  Found find(const LumaView& image, const geometry::Pose& X_BC);

  /// Compares every wedge with every ray, which costs five times as much: what the quick search is judged by.
  void search_everywhere() { everywhere_ = true; }

  /// Whether the last image can't hold the light around the probe: a shadow there is known less well, and may not be found.
  [[nodiscard]] bool is_saturated() const { return clipped_share_ > kMostSaturated; }

 private:
  static constexpr int kRings = 8;
  static constexpr int kRays = 48;
  static constexpr int kHalfWedge = 7;  // rays to each side that a shadow may cover
  static constexpr int kHalfWindow = 11;
  static constexpr int kLengths = 10;
  using Ring = std::array<float, kRings>;

  // A wedge that is dark: its ray, its length as an index of length_m_, how much of the brightness about the ray it explains.
  struct Candidate {
    int ray = -1;
    int length = 0;
    float score = 0.0F;
    double contrast = 0.0;  // grey levels
  };
  struct Lengths {
    int first;
    int end;
    int step;
  };

  // Along a shadow's axis, as far as the board reaches.
  static constexpr std::size_t kAxisPlaces = 20;
  struct AxisPlaces {
    std::array<double, kAxisPlaces> beside{};  // grey levels
    std::size_t count = 0;
  };

  void take_plane_away();
  [[nodiscard]] double noise() const;
  void look_around(const LumaView& image, const BoardView& view);
  [[nodiscard]] Candidate best_candidate(const std::array<int, 4>& tried, int tried_count, bool everywhere) const;
  [[nodiscard]] ShadowStart start_of(const Candidate& candidate) const;
  static bool is_near_tried(const std::array<int, 4>& tried, int tried_count, int ray);
  void compare_wedges(int ray, const Lengths& lengths, Candidate& best) const;
  [[nodiscard]] bool may_be_middle(int ray) const;
  [[nodiscard]] std::optional<double> off_plane(const LumaView& image, const BoardView& view,
                                                const Eigen::Vector2d& from_foot) const;
  [[nodiscard]] AxisPlaces beside_axis(const LumaView& image, const BoardView& view, const Eigen::Vector2d& axis) const;
  [[nodiscard]] ShadowStart follow_axis(const LumaView& image, const BoardView& view, const ShadowStart& start) const;
  [[nodiscard]] double plane_at(const Eigen::Vector2d& from_foot) const;
  void sum_rays();
  void look_for_tip(const LumaView& image, const BoardView& view, ProbeShadow& shadow);
  [[nodiscard]] bool fit_either(const LumaView& image, const BoardView& view, const ShadowStart& rings,
                                ProbeShadow& shadow);
  [[nodiscard]] bool is_explained(const ProbeShadow& shadow) const;
  [[nodiscard]] bool is_filled(const ProbeShadow& shadow) const;
  [[nodiscard]] static float seen_darkness(const ProbeShadow& shadow, float hidden);
  void take_away(const ProbeShadow& shadow);
  [[nodiscard]] float hidden_share(const Eigen::Vector2d& from_foot, const Outline& outline, double blur_m) const;

  Board board_;
  Probe probe_;
  ShadowParameters parameters_;
  ShadowFit fit_;
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
  // The board's brightness: at the foot, and its rise over a base's radius.
  Eigen::Vector3d plane_ = Eigen::Vector3d::Zero();
  double noise_ = 0.0;  // of the board by itself, grey levels
  double clipped_share_ = 0.0;
  bool everywhere_ = false;
};

}  // namespace cgsr::illumination
