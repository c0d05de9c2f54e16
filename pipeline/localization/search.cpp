#include "pipeline/localization/search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "pipeline/localization/gate.h"
#include "pipeline/localization/work.h"

namespace cgsr::localization {
namespace {

using geometry::Matrix6d;
using geometry::Pose;
using geometry::Vector6d;

constexpr double kSpread_px = 5.0;           // an axis of the prior that moves the image less needs no starts
constexpr double kNeighbourSpread_px = 1.5;  // ... no neighbours
constexpr double kFarthest = 2.5;            // sigmas
constexpr double kDistinct_px = 3.0;
constexpr double kAlternative_px = 8.0;  // nearer than this the second-best pose would be hardly an error
constexpr std::size_t kKept = 12;
constexpr int kFinalistUnits = 4;  // a start that is refined costs about as much as so many that are scored
constexpr int kNeighbourRounds = 4;
constexpr float kPriorWeight = 0.01F;  // of squared sigmas from the prior, off a start's score and a pose's rank
constexpr int kFewMatches = 4;         // fewer fit by chance
constexpr float kUnsolved = -1e6F;     // below the rank of any pose

// Acklam's rational approximation of the normal distribution's quantile; relative error below 1.2e-9.
double normal_quantile(double p) {
  constexpr std::array<double, 6> a = {-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                                       1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
  constexpr std::array<double, 5> b = {-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02,
                                       6.680131188771972e+01, -1.328068155288572e+01};
  constexpr std::array<double, 6> c = {-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                                       -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
  constexpr std::array<double, 4> d = {7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00,
                                       3.754408661907416e+00};
  const auto tail = [&](double q) {
    return (((((c[0] * q + c[1]) * q + c[2]) * q + c[3]) * q + c[4]) * q + c[5]) /
           ((((d[0] * q + d[1]) * q + d[2]) * q + d[3]) * q + 1.0);
  };
  if (p < 0.02425) return tail(std::sqrt(-2.0 * std::log(p)));
  if (p > 1.0 - 0.02425) return -tail(std::sqrt(-2.0 * std::log(1.0 - p)));
  const double q = p - 0.5;
  const double r = q * q;
  return (((((a[0] * r + a[1]) * r + a[2]) * r + a[3]) * r + a[4]) * r + a[5]) * q /
         (((((b[0] * r + b[1]) * r + b[2]) * r + b[3]) * r + b[4]) * r + 1.0);
}

}  // namespace

double even_normal(std::uint32_t index, int dimension) {
  constexpr std::array<std::uint32_t, 6> kBases = {2, 3, 5, 7, 11, 13};
  const std::uint32_t base = kBases[static_cast<std::size_t>(dimension)];
  double value = 0.0;
  double digit = 1.0;
  for (std::uint32_t rest = index + 1; rest > 0; rest /= base) {
    digit /= base;
    value += digit * static_cast<double>(rest % base);
  }
  return normal_quantile(value);
}

float search_rank(const Estimate& estimate, double misfit_weight) {
  if (!estimate.solved) return kUnsolved;
  const double of_matches = std::max(0.0, estimate.solution.cost - static_cast<double>(estimate.prior_chi2));
  return estimate.agreement - kPriorWeight * estimate.prior_chi2 -
         static_cast<float>(misfit_weight * of_matches / std::max(kFewMatches, estimate.matches));
}

PriorShape PriorShape::of(const Matrix6d& covariance, const Matrix6d& motion_metric) {
  const Matrix6d root = covariance.llt().matrixL();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(root.transpose() * motion_metric * root);
  PriorShape shape;
  // The widest axis first: Halton's smallest bases are the most even.
  for (int i = 0; i < 6; ++i) {
    shape.axes.col(i) = root * solver.eigenvectors().col(5 - i);
    shape.motion_px[i] = std::sqrt(std::max(0.0, solver.eigenvalues()[5 - i]));
  }
  return shape;
}

Search::Search(const LocalizerParameters& parameters, Alternation& alternation, const geometry::Camera& camera)
    : refinement_(alternation),
      alternation_(&alternation),
      parameters_(parameters),
      field_(camera.width_px, camera.height_px) {
  finalists_.reserve(static_cast<std::size_t>(parameters.finalists) + 1);
  estimates_.reserve(kKept + 1);
}

double Search::motion_between(const Pose& a, const Pose& b) const {
  const Vector6d step = geometry::step_between(a, b);
  return std::sqrt(step.dot(metric_ * step));
}

void Search::begin(const Belief& belief) {
  sequence_ += start_count_;
  refinement_.stop();
  metric_ = alternation_->motion_metric(belief.prior.X_WC);
  shape_ = PriorShape::of(belief.prior.covariance, metric_);
  cells_ = 1.0;
  for (int i = 0; i < 6; ++i) {
    if (shape_.motion_px[i] > kSpread_px)
      cells_ *= std::max(1.0, shape_.motion_px[i] / parameters_.hypothesis_spacing_px);
  }
  start_count_ = static_cast<std::uint32_t>(
      std::min(static_cast<double>(parameters_.max_hypotheses), std::ceil(parameters_.hypotheses_per_cell * cells_)));
  next_start_ = 0;
  next_finalist_ = 0;
  expected_at_best_start_ = 0;
  next_neighbour_ = 0;
  next_judged_ = 0;
  walk_ = 0;
  improved_ = false;
  field_built_ = false;
  X_WC_began_ = belief.prior.X_WC;
  finalists_.clear();
  estimates_.clear();
  best_ = Estimate{};
  lead_ = 0.0F;
  stage_ = Stage::kStarts;
}

void Search::carried(const Pose& X_C0C1) {
  if (!running()) return;
  X_WC_began_ = X_WC_began_ * X_C0C1;
  X_C0C1_since_field_ = X_C0C1_since_field_ * X_C0C1;
  X_WC_walk_ = X_WC_walk_ * X_C0C1;
  for (Candidate& candidate : finalists_) candidate.X_WC = candidate.X_WC * X_C0C1;
  for (Estimate& estimate : estimates_) estimate.solution.X_WC = estimate.solution.X_WC * X_C0C1;
  for (Estimate& estimate : judged_) estimate.solution.X_WC = estimate.solution.X_WC * X_C0C1;
  best_.solution.X_WC = best_.solution.X_WC * X_C0C1;
  refinement_.carried(X_C0C1);
}

bool Search::try_starts(const Belief& belief, WorkBudget& budget, int& units) {
  while (next_start_ < start_count_) {
    if (units <= 0 || !granted(budget, kLookUnits + kRoundUnits)) return false;
    --units;
    Vector6d step = Vector6d::Zero();
    if (next_start_ > 0) {
      for (int i = 0; i < 6; ++i) {
        if (shape_.motion_px[i] < kSpread_px) continue;
        const double z = even_normal(sequence_ + next_start_, i);
        step += std::clamp(z, -kFarthest, kFarthest) * shape_.axes.col(i);
      }
    }
    ++next_start_;
    Candidate candidate{.X_WC = geometry::moved(X_WC_began_, step)};
    const Pose X_WC_then = candidate.X_WC * X_C0C1_since_field_.inverse();
    alternation_->look(X_WC_then);
    alternation_->project(X_WC_then);
    const Vector6d off = geometry::step_between(belief.prior.X_WC, candidate.X_WC);
    candidate.score = field_.score(alternation_->view().projected()) -
                      kPriorWeight * static_cast<float>(off.dot(belief.information * off));
    const auto place = std::upper_bound(finalists_.begin(), finalists_.end(), candidate,
                                        [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    finalists_.insert(place, candidate);
    if (finalists_.size() > static_cast<std::size_t>(parameters_.finalists)) finalists_.pop_back();
  }
  return true;
}

void Search::keep(const Estimate& estimate) {
  if (!estimate.solved) return;
  for (auto known = estimates_.begin(); known != estimates_.end(); ++known) {
    if (motion_between(known->solution.X_WC, estimate.solution.X_WC) > kDistinct_px) continue;
    if (rank_of(*known) >= rank_of(estimate)) return;
    estimates_.erase(known);
    break;
  }
  const auto place = std::upper_bound(estimates_.begin(), estimates_.end(), estimate,
                                      [this](const Estimate& a, const Estimate& b) { return rank_of(a) > rank_of(b); });
  estimates_.insert(place, estimate);
  if (estimates_.size() > kKept) estimates_.pop_back();
}

bool Search::refine_finalists(const Belief& belief, const SegmentTable& perceived, WorkBudget& budget, int& units) {
  const AlternateOptions options{.rounds = parameters_.max_iterations,
                                 .radius_px = static_cast<float>(parameters_.max_match_radius_px),
                                 .settle = true};
  while (next_finalist_ < finalists_.size()) {
    if (units <= 0) return false;
    units -= kFinalistUnits;
    const auto estimate = refinement_.refine(finalists_[next_finalist_].X_WC, belief, perceived, options, budget);
    if (!estimate) return false;
    if (next_finalist_ == 0) expected_at_best_start_ = estimate->expected;
    ++next_finalist_;
    keep(*estimate);
  }
  return true;
}

Pose Search::neighbour() const {
  Vector6d step = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    if (shape_.motion_px[i] < kNeighbourSpread_px) continue;
    const double most = std::min(1.5, parameters_.hypothesis_spacing_px / shape_.motion_px[i]);
    const std::uint32_t number = static_cast<std::uint32_t>(walk_ * parameters_.neighbours) + next_neighbour_;
    step += most * std::clamp(even_normal(number, i), -kFarthest, kFarthest) * shape_.axes.col(i);
  }
  return geometry::moved(X_WC_walk_, step);
}

bool Search::try_neighbours(const Belief& belief, const SegmentTable& perceived, WorkBudget& budget, int& units) {
  if (estimates_.empty()) return true;
  const AlternateOptions options{.rounds = kNeighbourRounds,
                                 .radius_px = 0.5F * static_cast<float>(parameters_.max_match_radius_px),
                                 .settle = true};
  while (walk_ < parameters_.walks) {
    if (next_neighbour_ == 0) {
      X_WC_walk_ = estimates_.front().solution.X_WC;
      improved_ = false;
    }
    while (next_neighbour_ < static_cast<std::uint32_t>(parameters_.neighbours)) {
      if (units <= 0) return false;
      units -= 1;
      const auto estimate = refinement_.refine(neighbour(), belief, perceived, options, budget);
      if (!estimate) return false;
      ++next_neighbour_;
      const float before = rank_of(estimates_.front());
      keep(*estimate);
      if (rank_of(estimates_.front()) > before + 0.01F &&
          motion_between(estimates_.front().solution.X_WC, X_WC_walk_) > kDistinct_px)
        improved_ = true;
    }
    next_neighbour_ = 0;
    ++walk_;
    if (!improved_) break;
  }
  return true;
}

// With the gate's figures and the noise that its matches show: a wide prior must not pull a pose off what is seen well.
std::optional<Estimate> Search::judged_at(const Pose& X_WC, const Belief& belief, const SegmentTable& perceived,
                                          WorkBudget& budget) {
  const AlternateOptions options{.rounds = parameters_.max_iterations,
                                 .radius_px = static_cast<float>(parameters_.min_match_radius_px),
                                 .settle = true,
                                 .measured_noise = true};
  return refinement_.refine(X_WC, belief, perceived, options, budget);
}

// The best and those that come next: the last word is between them.
bool Search::judge_best(const Belief& belief, const SegmentTable& perceived, WorkBudget& budget) {
  while (next_judged_ < std::min(kJudged, estimates_.size())) {
    const auto estimate = judged_at(estimates_[next_judged_].solution.X_WC, belief, perceived, budget);
    if (!estimate) return false;
    judged_[next_judged_++] = *estimate;
  }
  return true;
}

void Search::verdict() {
  // Where no pose can be solved, it is for want of matches if the map shows something from the best start. What it shows from
  // other starts of a wide prior does not count: some edge is nearly always within its reach.
  best_ = Estimate{};
  best_.expected = expected_at_best_start_;
  lead_ = 1.0F;
  const std::size_t count = next_judged_;
  if (count == 0) return;
  std::sort(judged_.begin(), judged_.begin() + static_cast<std::ptrdiff_t>(count),
            [this](const Estimate& a, const Estimate& b) { return rank_of(a) > rank_of(b); });
  best_ = judged_[0];
  for (std::size_t i = 1; i < count; ++i) {
    if (motion_between(best_.solution.X_WC, judged_[i].solution.X_WC) <= kAlternative_px ||
        same_answer(best_.solution.X_WC, judged_[i].solution.X_WC, parameters_.decision))
      continue;
    lead_ = std::min(lead_, rank_of(best_) - rank_of(judged_[i]));
    break;
  }
}

bool Search::go_on(const Belief& belief, const SegmentTable& perceived, WorkBudget& budget) {
  int units = parameters_.hypotheses_per_image > 0 ? parameters_.hypotheses_per_image : 1 << 30;
  if (stage_ == Stage::kStarts) {
    if (!field_built_) {
      if (!granted(budget, kFieldUnits)) return false;
      field_.build(perceived);
      field_built_ = true;
      X_C0C1_since_field_ = Pose::Identity();
    }
    if (!try_starts(belief, budget, units)) return false;
    stage_ = Stage::kFinalists;
  }
  if (stage_ == Stage::kFinalists) {
    if (!refine_finalists(belief, perceived, budget, units)) return false;
    stage_ = Stage::kNeighbours;
  }
  if (stage_ == Stage::kNeighbours) {
    if (!try_neighbours(belief, perceived, budget, units)) return false;
    stage_ = Stage::kVerdict;
  }
  if (stage_ == Stage::kVerdict) {
    const bool judged_before = next_judged_ > 0;
    if (!judge_best(belief, perceived, budget)) return false;
    verdict();
    stage_ = judged_before && best_.solved ? Stage::kConfirm : Stage::kIdle;
  }
  // A pose that earlier images speak for is claimed for this one: by what this one says of it. Its lead over other poses is that
  // of the search, for they are not looked at again.
  if (stage_ == Stage::kConfirm) {
    const auto estimate = judged_at(best_.solution.X_WC, belief, perceived, budget);
    if (!estimate) return false;
    best_ = *estimate;
    stage_ = Stage::kIdle;
  }
  return true;
}

}  // namespace cgsr::localization
