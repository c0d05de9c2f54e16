#include "src/boot/boot_plan.h"

#include <algorithm>

namespace cgsr::boot {

BootPlan::~BootPlan() {
  undo();
}

void BootPlan::undo() {
  while (!done_.empty()) {
    const BootStep* const step = done_.back();
    done_.pop_back();
    if (step->undo) step->undo();
  }
}

bool BootPlan::ready(const BootStep& step) const {
  return std::ranges::all_of(step.needs, [this](const std::string& need) {
    return std::ranges::any_of(done_, [&need](const BootStep* done) { return done->name == need; });
  });
}

Result<void> BootPlan::run() {
  for (const BootStep& step : steps_) {
    if (auto done = step.run(); !done) {
      undo();
      return done;
    }
    done_.push_back(&step);
  }
  return {};
}

std::vector<Error> BootPlan::check() {
  std::vector<Error> problems;
  for (const BootStep& step : steps_) {
    if (!ready(step)) continue;
    if (auto done = step.run(); done) {
      done_.push_back(&step);
    } else {
      problems.push_back(done.error());
    }
  }
  return problems;
}

}  // namespace cgsr::boot
