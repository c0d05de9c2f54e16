#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "pipeline/runtime/aged.h"
#include "pipeline/runtime/frame_record.h"
#include "pipeline/runtime/motion_stop.h"
#include "pipeline/runtime/schedule.h"
#include "pipeline/runtime/stage_budget.h"
#include "pipeline/runtime/stage_table.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace cgsr::runtime {

/// The type of what a stage's worker returns.
template <class Worker>
struct OutputOf {
  using Type = typename decltype(std::function{
      std::declval<Worker>()})::result_type;  // a function object; only to deduce it
};
template <class Worker>
requires requires {
  typename Worker::Output;
}
struct OutputOf<Worker> {
  using Type = typename Worker::Output;
};

/// One line of the loop: a name in the schedule, the worker that does the work, and its last output.
///
/// \tparam Worker  a class with `Output` and `Output update(inputs...)`, or, when its work comes in units,
///         `Output update(WorkBudget&, inputs...)`; or a function object with one signature of either kind. One that returns
///         std::optional<Output> keeps its last output, which ages, with nothing. Output is
///         default-constructible (meaning: nothing yet) and assignable. It must stay valid until the stage's next run: it owns
///         its data, holds a lease on it, or points into what the worker keeps; never into an image.
template <class Worker>
class Stage {
 public:
  using Output = typename OutputOf<Worker>::Type;

  /// \param made  null: the robot has none; the stage has its turn all the same, and its output stays the default.
  explicit Stage(std::unique_ptr<Worker> made) : name_(Worker::kName), worker_(std::move(made)) {}
  /// \param name  text that outlives the stage, the same as in the schedule.
  Stage(std::string_view name, Worker made) : name_(name), worker_(std::make_unique<Worker>(std::move(made))) {}

  [[nodiscard]] std::string_view name() const { return name_; }
  [[nodiscard]] const Aged<Output>& last() const { return last_; }
  /// \return the worker; null where the robot has none.
  [[nodiscard]] Worker* worker() { return worker_.get(); }

 private:
  friend class StageRunner;
  static constexpr std::size_t kNoRow = kMostStages;

  template <class... Inputs>
  std::optional<Output> work(WorkBudget& budget, const Inputs&... inputs) {
    if (!worker_) return Output{};
    if constexpr (requires { worker_->update(budget, inputs...); }) {
      return worker_->update(budget, inputs...);
    } else if constexpr (requires { worker_->update(inputs...); }) {
      return worker_->update(inputs...);
    } else if constexpr (std::is_invocable_v<Worker&, WorkBudget&, const Inputs&...>) {
      return (*worker_)(budget, inputs...);
    } else {
      return (*worker_)(inputs...);
    }
  }

  std::string_view name_;
  std::unique_ptr<Worker> worker_;
  Aged<Output> last_;
  std::size_t row_ = kNoRow;
};

/// What a frame is about.
struct FrameStart {
  MonoTime stamp{};  ///< of the image; without one, the time for which the frame runs.
  std::uint64_t image_sequence = 0;
  bool has_image = true;
};

/// Who says when work is too much.
enum class BudgetSource : std::uint8_t {
  kClock,  ///< live: budget_us of the schedule.
  kUnits,  ///< lock-step, counting: units of the schedule; nothing overruns or is late on however slow a machine.
};
std::string_view to_string(BudgetSource source);

/// Runs stages: gives each its turn and its budget, measures it, keeps the records, and lets no exception pass.
///
/// The first frame is the warm-up: every stage has a turn, so that all memory is there, and nothing is judged or
/// counted.
///
/// Threads: one, the vision thread; only MotionStop is shared. After bind nothing here allocates.
class StageRunner {
 public:
  /// \param clock measures; it also grants when `source` is kClock. \param stop is raised by the safety chain. Both
  ///       outlive the runner.
  StageRunner(const Clock& clock, Schedule schedule, BudgetSource source, MotionStop& stop);

  /// Gives every stage its row. \return an error that names each stage without a row and each row without a stage.
  template <class... Workers>
  Result<void> bind(Stage<Workers>&... stages) {
    return bind_rows({Binding{stages.name_, &stages.row_}...});
  }

  /// Starts a frame. \param repeat the record of the same frame from another run: turns, grants, overruns and lateness
  /// are then its own, not decided anew. It stays valid until end_frame.
  void begin_frame(const FrameStart& start, const FrameRecord* repeat = nullptr);

  /// Gives the stage its turn. \return its output: of now, or when it had no turn or threw, the last one with its age.
  /// \throws std::logic_error when the stage is not bound: a mistake in the program, not in the data.
  template <class Worker, class... Inputs>
  const Aged<typename Stage<Worker>::Output>& run(Stage<Worker>& stage, const Inputs&... inputs) {
    auto& last = stage.last_;
    if (begin_stage(stage.row_, stage.name_)) {
      try {
        if (auto output = stage.work(budget_, inputs...)) {
          last.value = *std::move(output);
          last.stamp = record_.stamp;
          last.age = Duration::zero();
        } else if (last.ever()) {
          last.age = record_.stamp - last.stamp;
        }
        end_stage(stage.row_, StageOutcome::kRan);
        return last;
      } catch (const std::exception& error) {
        note_fault(record_, stage.name_, error.what());
      } catch (...) {
        note_fault(record_, stage.name_, "an exception that is no std::exception");
      }
      end_stage(stage.row_, StageOutcome::kFaulted);
    }
    if (last.ever()) last.age = record_.stamp - last.stamp;
    return last;
  }

  /// Ends the frame. \return its record, valid until the next begin_frame.
  const FrameRecord& end_frame();

  [[nodiscard]] const Schedule& schedule() const { return schedule_; }
  [[nodiscard]] const StageTable& table() const { return table_; }

 private:
  struct Binding {
    std::string_view name;
    std::size_t* row;
  };
  Result<void> bind_rows(std::initializer_list<Binding> stages);
  bool begin_stage(std::size_t row, std::string_view name);
  StageOutcome turn_of(std::size_t row);
  StageBudget budget_of(std::size_t row) const;
  void end_stage(std::size_t row, StageOutcome outcome);
  [[nodiscard]] bool took_longer(Duration elapsed, Duration permitted) const;
  [[nodiscard]] const StageParameters& parameters(std::size_t row) const { return schedule_.rows()[row].parameters; }

  const Clock& clock_;
  Schedule schedule_;
  BudgetSource source_;
  MotionStop& stop_;
  StageTable table_;
  FrameRecord record_;
  const FrameRecord* repeat_ = nullptr;
  std::uint64_t frame_ = 0;
  std::array<bool, kMostStages> loses_next_turn_{};
  StageBudget budget_ = StageBudget::of_units(0);  // of the stage that runs
  MonoTime stage_started_{};
};

}  // namespace cgsr::runtime
