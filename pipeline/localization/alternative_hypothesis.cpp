#include "pipeline/localization/alternative_hypothesis.h"

#include <algorithm>
#include <cmath>

#include "pipeline/localization/gate.h"
#include "pipeline/localization/search.h"

namespace cgsr::localization {
namespace {

// Where it starts: along what is least sure of the tracked pose.
constexpr int kDistances = 10;
constexpr int kAxes = 3;
constexpr std::uint32_t kProposals = 1000;  // then from the first one on
constexpr double kFixed_px = 1e-3;          // an axis whose sigma moves the image less is not open

double in_image(const geometry::Vector6d& step, const geometry::Matrix6d& metric) {
  return std::sqrt(step.dot(metric * step));
}

}  // namespace

AlternativeHypothesis::AlternativeHypothesis(const LocalizerParameters& parameters, Alternation& alternation)
    : alternation_(&alternation), parameters_(parameters) {}

void AlternativeHypothesis::carried(const geometry::Pose& X_C0C1) {
  X_WC_ = geometry::normalized(X_WC_ * X_C0C1);
}

void AlternativeHypothesis::forget() {
  images_ = 0;
  lead_ = 0.0F;
}

geometry::Pose AlternativeHypothesis::proposal(const Estimate& followed, const geometry::Matrix6d& metric) {
  const PriorShape shape = PriorShape::of(with_map_error(covariance_in_map(followed), parameters_), metric);
  Eigen::Matrix<double, kAxes, 1> direction;
  for (int i = 0; i < kAxes; ++i) direction[i] = even_normal(proposals_, i);
  direction.normalize();
  // Sevenths of the way round: near and far take turns.
  const AlternativeParameters& p = parameters_.alternative;
  const double distance_px =
      p.min_offset_px + (p.max_offset_px - p.min_offset_px) * (proposals_ * 7 % kDistances) / kDistances;
  proposals_ = (proposals_ + 1) % kProposals;
  geometry::Vector6d step = geometry::Vector6d::Zero();
  for (int i = 0; i < kAxes; ++i) {
    if (shape.motion_px[i] > kFixed_px) step += direction[i] * distance_px / shape.motion_px[i] * shape.axes.col(i);
  }
  return geometry::moved(followed.solution.X_WC, step);
}

Estimate AlternativeHypothesis::better_than(const Estimate& followed, const Belief& belief,
                                            const SegmentTable& perceived, WorkBudget& budget) {
  const AlternativeParameters& p = parameters_.alternative;
  if (followed.matches < p.min_matches) {
    forget();
    return followed;
  }
  const geometry::Matrix6d metric = alternation_->motion_metric(followed.solution.X_WC);
  // Edges that lead astray do so for many images, and a belief in the map as it is grows sure of them.
  const geometry::Matrix6d covariance = with_map_error(belief.prior.covariance, parameters_);
  const Belief doubted({belief.prior.X_WC, covariance});
  const Belief wider({belief.prior.X_WC, p.prior_widening * p.prior_widening * covariance});
  AlternateOptions options;
  options.rounds = p.rounds;
  options.radius_px = static_cast<float>(p.match_radius_px);
  options.robust = kFollowedRobust;
  options.look_first = images_ > 0;
  options.look_again = false;
  const geometry::Pose start = images_ > 0 ? X_WC_ : proposal(followed, metric);
  const Estimate beside = alternation_->refine(start, wider, perceived, options, budget);
  if (beside.rounds == 0) return followed;  // not granted: it stands as it did
  const geometry::Vector6d off = geometry::step_between(followed.solution.X_WC, beside.solution.X_WC);
  const auto chi2 = static_cast<float>(off.dot(doubted.information * off));
  const float lead = beside.agreement - followed.agreement - static_cast<float>(p.prior_weight) * chi2;
  if (!beside.solved || in_image(off, metric) < p.same_px || lead < -static_cast<float>(p.max_deficit)) {
    forget();
    return followed;
  }
  X_WC_ = beside.solution.X_WC;
  lead_ = static_cast<float>(p.lead_kept) * lead_ + std::min(lead, static_cast<float>(p.max_lead_per_image));
  ++images_;
  if (lead_ < 0.0F) forget();
  if (lead_ < static_cast<float>(p.min_lead) || images_ < p.min_images) return followed;
  options.rounds = parameters_.max_iterations;
  options.look_first = true;
  // The belief moves as a whole: it is as sure there as the doubted one was here.
  const Belief moved({beside.solution.X_WC, covariance});
  const Estimate better = alternation_->refine(beside.solution.X_WC, moved, perceived, options, budget);
  if (better.rounds == 0) return followed;  // not granted: the next image decides
  forget();
  return better.solved && better.agreement > followed.agreement ? better : followed;
}

}  // namespace cgsr::localization
