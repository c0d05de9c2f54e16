#include "pipeline/localization/near_starts.h"

#include <algorithm>

#include "pipeline/localization/gate.h"
#include "pipeline/localization/work.h"

namespace cgsr::localization {
namespace {

constexpr double kNearSpread_px = 1.0;       // an axis of the prior that moves the image less needs no starts
constexpr double kNearest = 1.8;             // sigmas
constexpr double kNearAlternative_px = 4.0;  // a pose that is further off and as good leaves the answer open
constexpr float kNearRadius = 0.6F;          // of the first start's

}  // namespace

NearStarts::NearStarts(const GateParameters& parameters, Alternation& alternation)
    : parameters_(parameters), alternation_(&alternation), refinement_(alternation) {}

float NearStarts::rank_of(const Estimate& estimate) const {
  return estimate.solved ? evidence_of(estimate, Standing{}, parameters_) : -10.0F;
}

void NearStarts::begin(const Belief& belief, const PriorShape& shape, const AlternateOptions& options) {
  running_ = true;
  refinement_.stop();
  options_ = options;
  shape_ = shape;
  X_WC_began_ = belief.prior.X_WC;
  found_ = {};
  next_ = 0;
}

void NearStarts::carried(const geometry::Pose& X_C0C1) {
  if (!running_) return;
  refinement_.carried(X_C0C1);
  X_WC_began_ = X_WC_began_ * X_C0C1;
  for (std::uint32_t i = 0; i < next_; ++i) found_[i].solution.X_WC = found_[i].solution.X_WC * X_C0C1;
}

geometry::Pose NearStarts::start(std::uint32_t number) const {
  if (number == 0) return X_WC_began_;
  geometry::Vector6d step = geometry::Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    if (shape_.motion_px[i] >= kNearSpread_px)
      step += std::clamp(even_normal(number, i), -kNearest, kNearest) * shape_.axes.col(i);
  }
  return geometry::moved(X_WC_began_, step);
}

bool NearStarts::go_on(const Belief& belief, const SegmentTable& perceived, WorkBudget& budget) {
  while (next_ < kStarts) {
    AlternateOptions options = options_;
    if (next_ > 0) {
      options.look_first = true;
      options.radius_px *= kNearRadius;
    }
    const auto estimate = refinement_.refine(start(next_), belief, perceived, options, budget);
    if (!estimate) return false;
    if (next_ == 0) metric_ = alternation_->motion_metric(X_WC_began_);
    found_[next_++] = *estimate;
  }
  if (!granted(budget, kLookUnits + kRoundUnits)) return false;  // for who settles the best one
  verdict();
  running_ = false;
  return true;
}

void NearStarts::verdict() {
  best_ = found_[0];
  for (const Estimate& estimate : found_) {
    if (rank_of(estimate) > rank_of(best_)) best_ = estimate;
  }
  lead_ = 1.0F;
  for (const Estimate& other : found_) {
    if (!other.solved) continue;
    const geometry::Vector6d step = geometry::step_between(best_.solution.X_WC, other.solution.X_WC);
    if (step.dot(metric_ * step) > kNearAlternative_px * kNearAlternative_px &&
        !same_answer(best_.solution.X_WC, other.solution.X_WC, parameters_))
      lead_ = std::min(lead_, rank_of(best_) - rank_of(other));
  }
}

}  // namespace cgsr::localization
