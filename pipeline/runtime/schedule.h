#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"
#include "platform/parameters.h"
#include "platform/time.h"

namespace cgsr::runtime {

/// Most rows of a schedule: records of a frame have a fixed size.
inline constexpr std::size_t kMostStages = 24;

enum class OnOverrun : std::uint8_t {
  kSkip,        ///< the stage loses its next turn; those after it use its last output, which says how old it is.
  kStopMotion,  ///< the stage is part of the safety chain: the robot stops, also when the stage faults.
};
inline constexpr Named<OnOverrun> kOnOverrunNames[] = {{"skip", OnOverrun::kSkip},
                                                       {"stop_motion", OnOverrun::kStopMotion}};
constexpr std::string_view to_string(OnOverrun on_overrun) {
  return word_in(kOnOverrunNames, on_overrun);
}

/// One row of the schedule as the robot's file has it.
struct StageParameters {
  int every_frames = 1;
  int phase = 0;
  int budget_us = 1000;
  int units = 0;
  OnOverrun on_overrun = OnOverrun::kSkip;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("every_frames", self.every_frames, {1, 60}, "frames", "The stage runs in one of this many frames.");
    visit.number(
        "phase", self.phase, {0, 59}, "frames",
        "The frame within that cycle in which the stage runs, counted from 0; it must be less than every_frames.");
    visit.number("budget_us", self.budget_us, {100, 33000}, "µs", "The time that one run of the stage may take.");
    visit.number("units", self.units, {0, 1'000'000}, "1",
                 "The units of work that one run is granted where no clock decides (lock-step, replay, counting); 0 "
                 "grants all that it requests. A stage that does not iterate is one unit.");
    visit.choice("on_overrun", self.on_overrun, kOnOverrunNames,
                 "The reaction to a run that took longer than its budget.");
  }

  /// \return what is wrong with the keys together, empty when nothing is.
  [[nodiscard]] std::string inconsistency() const;
};

struct ScheduleRow {
  std::string name;
  StageParameters parameters;
};

/// Which stage runs in which frame, and what it may cost: one table, rows in the order of the loop. A frame is one
/// cycle of the vision loop, counted from 0 without gaps; images that were lost do not shift it.
class Schedule {
 public:
  /// Checks the whole table: names, phases, and that the budgets of every frame of the hyperperiod (after which the
  /// pattern repeats) fit `frame_period`.
  /// \return an error with everything that is wrong: of a frame that is too full its sum and who is in it.
  static Result<Schedule> make(std::vector<ScheduleRow> rows, Duration frame_period);

  [[nodiscard]] const std::vector<ScheduleRow>& rows() const { return rows_; }
  [[nodiscard]] Duration frame_period() const { return frame_period_; }
  [[nodiscard]] std::uint64_t hyperperiod_frames() const { return hyperperiod_; }

  /// \return whether the row has its turn in that frame.
  [[nodiscard]] bool due(std::size_t row, std::uint64_t frame) const;

  /// \return the sum of the budgets of all rows that are due in that frame.
  [[nodiscard]] Duration planned(std::uint64_t frame) const;

  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;

 private:
  Schedule(std::vector<ScheduleRow> rows, Duration frame_period, std::uint64_t hyperperiod);

  std::vector<ScheduleRow> rows_;
  Duration frame_period_;
  std::uint64_t hyperperiod_;
};

/// \return the table as it took effect, with the sum of the fullest frame.
std::string to_text(const Schedule& schedule);

/// \return the rows of a parameter struct whose sections are StageParameters, in the order in which it describes them,
///       so that a stage's name is written once.
template <class Stages>
std::vector<ScheduleRow> rows_of(const Stages& stages) {
  struct Collector {
    std::vector<ScheduleRow> rows;
    void section(std::string_view name, const StageParameters& parameters, std::string_view /*meaning*/) {
      rows.push_back({std::string(name), parameters});
    }
  } collector;
  Stages::describe(stages, collector);
  return collector.rows;
}

}  // namespace cgsr::runtime
