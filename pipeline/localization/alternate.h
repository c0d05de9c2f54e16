#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/localization/agreement_by_part.h"
#include "pipeline/localization/expected.h"
#include "pipeline/localization/localizer_parameters.h"
#include "pipeline/localization/matching.h"
#include "pipeline/localization/segment_table.h"
#include "pipeline/localization/solve.h"
#include "pipeline/render/expectation.h"
#include "platform/work_budget.h"

namespace cgsr::localization {

/// A prior with what is needed of it again and again.
struct Belief {
  explicit Belief(const Prior& given);

  Prior prior;
  geometry::Matrix6d information;
  bool valid = false;  ///< finite, and the covariance positive definite.
};

/// A pose that expectation and maximisation settled on.
struct Estimate {
  bool solved = false;
  Solution solution;
  int expected = 0;
  int matches = 0;
  float explained =
      0.0F;  ///< share of the expected visible length found, each edge by how sure it is to be perceived, near matches more.
  /// How much of what is expected was perceived and of what was perceived is expected, 0..1: a pose that expects next to nothing is not right
  /// because it finds that, nor one that expects an edge everywhere.
  float agreement = 0.0F;
  /// What a gate may believe of it: each perceived edge counts by how much it tells; and seen from outside of the map, which is then a thing and
  /// not the surroundings, only what was perceived on it: what stands about it says nothing.
  float agreement_on_map = 0.0F;
  /// Likewise, in the parts of the image where they agree least; with AlternateOptions::by_part.
  float agreement_in_the_worst = 0.0F;
  float prior_chi2 = 0.0F;
  int rounds = 0;
  bool cut_off = false;  ///< the budget ended it before it settled.
};

/// From a belief as narrow as a followed pose's, what lies two pixels off is another edge rather than this one's error: SolverOptions::robust.
inline constexpr double kFollowedRobust = 0.7;

/// How one alternation of expectation and maximisation goes. Pixels are those of the working image.
struct AlternateOptions {
  int rounds = 6;
  int rounds_done = 0;                     ///< of these, in an earlier image: the radius has shrunk as often.
  float radius_px = 24.0F;                 ///< of the first round.
  double robust = SolverOptions{}.robust;  ///< likewise there.
  bool look_first = true;                  ///< false: the pieces of the last look are good enough.
  bool look_again = true;                  ///< when the pose moved far.
  /// Of a search: after the radius has reached min_match_radius_px it shrinks on to settle_radius_px, with the robust constant kFollowedRobust.
  bool settle = false;
  bool by_part = false;  ///< for the gate: where in the image they agree.
  bool measured_noise =
      false;  ///< the pose out of the noise that the matches show; its covariance stays the stated one's.
};

/// Expectation and maximisation (4.1): what is visible from the pose, matched with what was perceived, moves the pose; and again until it
/// settles. Between full expectations the known pieces are projected anew.
class Alternation {
 public:
  /// \param map, expectation  outlive it.
  Alternation(const world::Map& map, const LocalizerParameters& parameters, render::Expectation& expectation,
              const geometry::Camera& camera, std::size_t most_perceived);

  /// \param budget  asked before each round, and before each look at the map: kRoundUnits and kLookUnits.
  Estimate refine(const geometry::Pose& start, const Belief& belief, const SegmentTable& perceived,
                  const AlternateOptions& options, WorkBudget& budget);

  /// Draws the expectation from a pose; project() and view() go with it.
  void look(const geometry::Pose& X_WC);
  /// glCorrect projects what is known to be visible, and looks anew where the pose is farther than max_view_shift_px from where that was seen; the
  /// dissertation's methods look anew.
  /// \return false when the budget does not hold the look.
  bool look_if_far(const geometry::Pose& X_WC, WorkBudget& budget);
  /// Whether look_if_far would look.
  [[nodiscard]] bool must_look(const geometry::Pose& X_WC);
  void project(const geometry::Pose& X_WC) { view_.project(X_WC, camera_); }
  [[nodiscard]] const ExpectedView& view() const { return view_; }
  /// Localizer::distances_from().
  std::span<const LineDistance> distances_from(const geometry::Pose& X_WC, const SegmentTable& perceived,
                                               float radius_px);

  /// The square of the image's mean motion, px^2, for a step: step^T M step. From the pieces projected last; without any, from a wall 3 m away.
  [[nodiscard]] geometry::Matrix6d motion_metric(const geometry::Pose& X_WC) const;

  /// Of work since reset_counts().
  [[nodiscard]] int looks() const { return looks_; }
  [[nodiscard]] int rounds() const { return rounds_; }
  void reset_counts() { looks_ = rounds_ = 0; }

 private:
  [[nodiscard]] MatchingRules rules_within(float radius_px) const;
  void gather(std::span<const Match> matches, const SegmentTable& perceived);
  void gather_ends(const ProjectedPiece& piece, const PerceivedEdge& edge, LineDistance end);
  /// Moves a solution to where the noise that its matches show has it; its cost there is that with the stated noise.
  void take_measured_noise(const geometry::Pose& start, const Belief& belief, const SolverOptions& solver,
                           Solution& solution);
  [[nodiscard]] bool is_far(const geometry::Pose& X_WC, const geometry::Matrix6d& metric) const;
  [[nodiscard]] bool on_map(const PerceivedEdge& edge) const;
  [[nodiscard]] float length_on_map(const SegmentTable& perceived, const geometry::Pose& X_WC) const;
  void judge(std::span<const Match> matches, const SegmentTable& perceived, const geometry::Pose& X_WC,
             Estimate& estimate) const;
  void judge_by_part(std::span<const Match> matches, const SegmentTable& perceived, const geometry::Pose& X_WC,
                     Estimate& estimate);

  LocalizerParameters parameters_;
  Eigen::AlignedBox3d bounds_;  ///< of the map and what is close by.
  render::Expectation* expectation_;
  geometry::Camera camera_;
  ExpectedView view_;
  Matcher matcher_;
  AgreementByPart by_part_;
  std::vector<render::VisiblePiece> visible_;
  std::vector<LineDistance> lines_;
  std::optional<geometry::Pose> X_WC_looked_;  ///< where the last look was from.
  int corners_ = 0;                            ///< among them.
  int looks_ = 0;
  int rounds_ = 0;
};

}  // namespace cgsr::localization
