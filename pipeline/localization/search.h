#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/localization/alternate.h"
#include "pipeline/localization/direction_field.h"
#include "pipeline/localization/localizer_parameters.h"
#include "pipeline/localization/refinement.h"

namespace cgsr::localization {

/// A prior seen as motion of the image: the columns of `axes` are independent steps of one sigma, each of which moves the image by motion_px.
struct PriorShape {
  geometry::Matrix6d axes = geometry::Matrix6d::Zero();
  geometry::Vector6d motion_px = geometry::Vector6d::Zero();

  static PriorShape of(const geometry::Matrix6d& covariance, const geometry::Matrix6d& motion_metric);

  /// Along the axis that moves the image most.
  [[nodiscard]] double widest_px() const { return motion_px.maxCoeff(); }
};

/// Number `index` of a sequence of standard normal numbers whose tuples over `dimension` (0..5) fill space evenly (Halton 1960).
double even_normal(std::uint32_t index, int dimension);

/// What the poses of a search are compared by, in units of agreement: how much image and map agree, less the distance to the prior and how badly a
/// match fits in the mean (LocalizerParameters::misfit_weight). Below that of every other pose for one that could not be solved.
float search_rank(const Estimate& estimate, double misfit_weight);

/// Finds the pose in a wide prior: starts spread evenly over it, scored without matching; the best of them refined; then poses about the
/// winner, because two borders of one frame look alike and the right one may not have been tried. Goes on over several images.
/// Ours: Alg. 4.1 starts from one pose.
class Search {
 public:
  Search(const LocalizerParameters& parameters, Alternation& alternation, const geometry::Camera& camera);

  /// Begins anew about the belief.
  void begin(const Belief& belief);
  void stop() { stage_ = Stage::kIdle; }
  [[nodiscard]] bool running() const { return stage_ != Stage::kIdle; }

  /// Works on one image as far as the budget goes; what it cuts off goes on in the next image. \return whether the search came to its end: best()
  /// and lead() hold.
  bool go_on(const Belief& belief, const SegmentTable& perceived, WorkBudget& budget);

  void carried(const geometry::Pose& X_C0C1);

  [[nodiscard]] const Estimate& best() const { return best_; }
  [[nodiscard]] float lead() const { return lead_; }
  /// How many poses that differ by hypothesis_spacing_px the prior holds.
  [[nodiscard]] double cells() const { return cells_; }
  [[nodiscard]] int starts() const { return static_cast<int>(next_start_); }

 private:
  enum class Stage : std::uint8_t { kIdle, kStarts, kFinalists, kNeighbours, kVerdict, kConfirm };
  static constexpr std::size_t kJudged = 5;  ///< poses that are compared at the end.
  struct Candidate {
    geometry::Pose X_WC = geometry::Pose::Identity();
    float score = 0.0F;
  };

  bool try_starts(const Belief& belief, WorkBudget& budget, int& units);
  bool refine_finalists(const Belief& belief, const SegmentTable& perceived, WorkBudget& budget, int& units);
  bool try_neighbours(const Belief& belief, const SegmentTable& perceived, WorkBudget& budget, int& units);
  [[nodiscard]] geometry::Pose neighbour() const;
  bool judge_best(const Belief& belief, const SegmentTable& perceived, WorkBudget& budget);
  std::optional<Estimate> judged_at(const geometry::Pose& X_WC, const Belief& belief, const SegmentTable& perceived,
                                    WorkBudget& budget);
  void verdict();
  void keep(const Estimate& estimate);
  [[nodiscard]] double motion_between(const geometry::Pose& a, const geometry::Pose& b) const;
  [[nodiscard]] float rank_of(const Estimate& estimate) const {
    return search_rank(estimate, parameters_.misfit_weight);
  }

  geometry::Pose X_WC_walk_ = geometry::Pose::Identity();
  geometry::Pose X_WC_began_ = geometry::Pose::Identity();
  geometry::Pose X_C0C1_since_field_ = geometry::Pose::Identity();  ///< since the image that starts are scored in.
  Refinement refinement_;
  geometry::Matrix6d metric_ = geometry::Matrix6d::Zero();
  PriorShape shape_;
  Estimate best_;
  std::array<Estimate, kJudged> judged_;
  Alternation* alternation_;
  double cells_ = 1.0;
  std::size_t next_judged_ = 0;
  std::vector<Candidate> finalists_;  ///< best first.
  std::vector<Estimate> estimates_;   ///< distinct, best first.
  LocalizerParameters parameters_;
  DirectionField field_;
  std::uint32_t sequence_ = 0;  ///< where this search's even numbers begin: the next search tries other starts.
  std::uint32_t start_count_ = 0;
  std::uint32_t next_start_ = 0;
  std::uint32_t next_finalist_ = 0;
  int expected_at_best_start_ = 0;  ///< pieces of edges.
  std::uint32_t next_neighbour_ = 0;
  int walk_ = 0;
  float lead_ = 0.0F;
  Stage stage_ = Stage::kIdle;
  bool improved_ = false;
  bool field_built_ = false;
};

}  // namespace cgsr::localization
