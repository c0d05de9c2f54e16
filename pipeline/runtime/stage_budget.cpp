#include "pipeline/runtime/stage_budget.h"

#include <algorithm>

namespace cgsr::runtime {

bool StageBudget::grant() {
  if (refused_) return false;
  if (granted_ == units_ || (clock_ != nullptr && !time_is_left())) {
    refused_ = true;
    return false;
  }
  ++granted_;
  return true;
}

bool StageBudget::time_is_left() {
  const auto now = clock_->now();
  if (granted_ > 0) longest_unit_ = std::max(longest_unit_, now - last_grant_);
  last_grant_ = now;
  return now < end_ && now + longest_unit_ <= end_;
}

}  // namespace cgsr::runtime
