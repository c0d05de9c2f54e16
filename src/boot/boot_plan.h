#pragma once

#include <functional>
#include <string>
#include <vector>

#include "platform/error.h"

namespace cgsr::boot {

/// One step on the way from a robot's file to a robot that runs.
struct BootStep {
  std::string name;
  std::vector<std::string> needs;  ///< names of the steps that must have succeeded before.
  std::function<Result<void>()> run;
  std::function<void()> undo =
      {};  ///< called when the plan goes, last step first; only for a step that succeeded. May be empty.
};

/// A list of steps, walked from the first to the last. The robot's program stops at the first that fails and undoes what was done; `cgsr check`
/// walks on, past those whose needs are missing, and so finds every problem at once. A step that fails leaves nothing behind by itself.
///
/// Threads: one.
class BootPlan {
 public:
  BootPlan() = default;
  ~BootPlan();
  BootPlan(const BootPlan&) = delete;
  BootPlan& operator=(const BootPlan&) = delete;

  /// \param step  its needs stand before it in the list.
  void add(BootStep step) { steps_.push_back(std::move(step)); }

  /// Walks until a step fails. \return its error; the steps before it have then been undone, the last first.
  Result<void> run();
  /// Walks to the end. \return the errors of all steps that could be tried, in order.
  std::vector<Error> check();

  /// Undoes what succeeded, the last step first. Idempotent; the destructor does it too.
  void undo();

 private:
  [[nodiscard]] bool ready(const BootStep& step) const;

  std::vector<BootStep> steps_;
  std::vector<const BootStep*> done_;
};

}  // namespace cgsr::boot
