#include "pipeline/runtime/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "platform/count_marks.h"

namespace cgsr::runtime {

std::string_view to_string(BudgetSource source) {
  switch (source) {
    case BudgetSource::kClock:
      return "clock";
    case BudgetSource::kUnits:
      return "units";
  }
  return "";
}

StageRunner::StageRunner(const Clock& clock, Schedule schedule, BudgetSource source, MotionStop& stop)
    : clock_(clock), schedule_(std::move(schedule)), source_(source), stop_(stop), table_(schedule_) {}

Result<void> StageRunner::bind_rows(std::initializer_list<Binding> stages) {
  std::vector<std::string> problems;
  std::vector<bool> taken(schedule_.rows().size(), false);
  for (const auto& [name, row] : stages) {
    const auto found = schedule_.find(name);
    if (!found) {
      problems.push_back(fmt::format("stage '{}' has no row in the schedule", name));
    } else if (taken[*found]) {
      problems.push_back(fmt::format("stage '{}' is there twice", name));
    } else {
      taken[*found] = true;
      *row = *found;
    }
  }
  for (std::size_t i = 0; i < taken.size(); ++i) {
    if (!taken[i]) problems.push_back(fmt::format("row '{}' of the schedule has no stage", schedule_.rows()[i].name));
  }
  if (problems.empty()) return {};
  return fail(fmt::format("{}", fmt::join(problems, "\n")));
}

void StageRunner::begin_frame(const FrameStart& start, const FrameRecord* repeat) {
  repeat_ = repeat;
  if (repeat != nullptr) frame_ = repeat->frame;  // a repetition may begin anywhere
  record_ = FrameRecord{};
  record_.frame = frame_;
  record_.image_sequence = start.image_sequence;
  record_.stamp = start.stamp;
  record_.stage_count = static_cast<std::uint32_t>(schedule_.rows().size());
  record_.has_image = start.has_image;
  record_.warm_up = repeat != nullptr ? repeat->warm_up : frame_ == 0;
  record_.started = clock_.now();
}

const FrameRecord& StageRunner::end_frame() {
  record_.finished = clock_.now();
  record_.late =
      repeat_ != nullptr ? repeat_->late : took_longer(record_.finished - record_.started, schedule_.frame_period());
  table_.add(record_);
  ++frame_;
  repeat_ = nullptr;
  count_image_end();
  return record_;
}

bool StageRunner::begin_stage(std::size_t row, std::string_view name) {
  if (row >= schedule_.rows().size()) {
    throw std::logic_error(fmt::format("stage '{}' was run before bind() gave it a row", name));
  }
  auto& record = record_.stages[row];
  record.outcome = turn_of(row);
  if (record.outcome != StageOutcome::kRan) return false;
  stage_started_ = clock_.now();
  budget_ = budget_of(row);
  count_stage_begin();
  return true;
}

/// \return kRan when it may run, else why it may not.
StageOutcome StageRunner::turn_of(std::size_t row) {
  if (repeat_ != nullptr) {
    const auto then = repeat_->stages[row].outcome;
    return then == StageOutcome::kFaulted ? StageOutcome::kRan : then;
  }
  if (record_.warm_up) return StageOutcome::kRan;
  if (!schedule_.due(row, frame_)) return StageOutcome::kNotDue;
  return std::exchange(loses_next_turn_[row], false) ? StageOutcome::kSkipped : StageOutcome::kRan;
}

StageBudget StageRunner::budget_of(std::size_t row) const {
  if (repeat_ != nullptr) return StageBudget::of_units(repeat_->stages[row].granted);
  if (source_ == BudgetSource::kClock) {
    return StageBudget::until(clock_, stage_started_ + std::chrono::microseconds(parameters(row).budget_us));
  }
  const auto units = static_cast<std::uint32_t>(parameters(row).units);
  return StageBudget::of_units(units == 0 ? StageBudget::kAll : units);
}

void StageRunner::end_stage(std::size_t row, StageOutcome outcome) {
  count_stage_end(schedule_.rows()[row].name.c_str());
  const auto elapsed = clock_.now() - stage_started_;
  auto& record = record_.stages[row];
  record.elapsed_ns = elapsed.count();
  record.granted = budget_.granted();
  record.refused = budget_.refused();
  record.outcome = outcome;
  record.overran = repeat_ != nullptr ? repeat_->stages[row].overran
                                      : took_longer(elapsed, std::chrono::microseconds(parameters(row).budget_us));

  const bool in_order = !record.overran && outcome == StageOutcome::kRan;
  if (parameters(row).on_overrun == OnOverrun::kSkip) {
    loses_next_turn_[row] = record.overran;
  } else if (in_order) {
    stop_.lower(row);
  } else {
    stop_.raise(row);
  }
}

bool StageRunner::took_longer(Duration elapsed, Duration permitted) const {
  return source_ == BudgetSource::kClock && !record_.warm_up && elapsed > permitted;
}

}  // namespace cgsr::runtime
