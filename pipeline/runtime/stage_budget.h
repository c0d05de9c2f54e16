#pragma once

#include <cstdint>
#include <limits>

#include "platform/clock.h"
#include "platform/work_budget.h"

namespace cgsr::runtime {

/// What one run of one stage may do. Live, until a time: a unit is granted while the longest one of this run so far
/// still fits before the end, so that an even loop stops in time and not one unit late. Elsewhere, a number of units.
class StageBudget final : public WorkBudget {
 public:
  static constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();

  /// \param clock outlives the budget.
  static StageBudget until(const Clock& clock, MonoTime end) { return StageBudget(&clock, end, kAll); }
  static StageBudget of_units(std::uint32_t units) { return StageBudget(nullptr, {}, units); }

  bool grant() override;

  [[nodiscard]] std::uint32_t granted() const { return granted_; }
  /// \return whether it ever said no.
  [[nodiscard]] bool refused() const { return refused_; }

 private:
  StageBudget(const Clock* clock, MonoTime end, std::uint32_t units) : clock_(clock), end_(end), units_(units) {}
  bool time_is_left();

  const Clock* clock_;
  MonoTime end_;
  std::uint32_t units_;
  std::uint32_t granted_ = 0;
  bool refused_ = false;
  MonoTime last_grant_{};
  Duration longest_unit_{};
};

}  // namespace cgsr::runtime
