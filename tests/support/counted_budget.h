#pragma once

#include "platform/work_budget.h"

namespace cgsr {

/// Grants so many units and no more.
class CountedBudget final : public WorkBudget {
 public:
  explicit CountedBudget(int units) : left_(units) {}
  bool grant() override { return left_-- > 0; }

 private:
  int left_;
};

}  // namespace cgsr
