#include "pipeline/color/track/clutter.h"

#include <algorithm>

namespace cgsr::color {

void Clutter::reset() {
  level_ = parameters_.before_any;
  pending_count_ = 0;
}

void Clutter::add(double log_odds) {
  level_ = std::max(level_ - parameters_.forgetting, log_odds);
}

void Clutter::add_pending(double log_odds) {
  double& oldest = pending_[pending_count_ % kPending];
  add(pending_count_ >= kPending ? oldest : level_ - parameters_.forgetting);
  oldest = log_odds;
  ++pending_count_;
}

}  // namespace cgsr::color
