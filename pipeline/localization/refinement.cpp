#include "pipeline/localization/refinement.h"

namespace cgsr::localization {

std::optional<Estimate> Refinement::refine(const geometry::Pose& start, const Belief& belief,
                                           const SegmentTable& perceived, const AlternateOptions& options,
                                           WorkBudget& budget) {
  AlternateOptions now = options;
  geometry::Pose from = start;
  if (under_way_) {
    from = under_way_->X_WC;
    now.rounds_done = under_way_->rounds;
    now.look_first = alternation_->must_look(from);
  }
  const Estimate estimate = alternation_->refine(from, belief, perceived, now, budget);
  if (!estimate.cut_off) {
    under_way_.reset();
    return estimate;
  }
  if (estimate.rounds > 0) under_way_ = {estimate.solution.X_WC, now.rounds_done + estimate.rounds};
  return std::nullopt;
}

void Refinement::carried(const geometry::Pose& X_C0C1) {
  if (under_way_) under_way_->X_WC = under_way_->X_WC * X_C0C1;
}

}  // namespace cgsr::localization
