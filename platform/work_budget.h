#pragma once

namespace cgsr {

/// Permission for one more unit of work. An iterative algorithm asks before each unit and stops where it is told to: it never reads a
/// clock. Live, the answer comes from the time that is left; in lock-step, replay and counting from a fixed number of units.
class WorkBudget {
 public:
  virtual ~WorkBudget() = default;

  /// \return whether one more unit may be done; once false, false until the next image.
  virtual bool grant() = 0;
};

/// Always grants: for tools and tests that have all the time.
class UnlimitedBudget final : public WorkBudget {
 public:
  bool grant() override { return true; }
};

}  // namespace cgsr
