#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "pipeline/runtime/stage.h"
#include "platform/clock.h"

namespace cgsr::runtime {

inline constexpr Duration kPeriod = std::chrono::milliseconds(33);

/// A stage that takes as long as it is told and hands on its input. Its clock is its own to move: the test has one
/// thread.
struct Work {
  SimulatedClock* clock;
  const Duration* takes;
  int operator()(int input) const {
    clock->advance(*takes);
    return input;
  }
};

inline Schedule schedule_of(std::vector<ScheduleRow> rows) {
  auto schedule = Schedule::make(std::move(rows), kPeriod);
  if (!schedule) throw std::runtime_error(schedule.error().message);
  return *schedule;
}

inline ScheduleRow stage_row(std::string name, int every_frames, int phase, int budget_us,
                             OnOverrun on_overrun = OnOverrun::kSkip, int units = 0) {
  return {std::move(name), {every_frames, phase, budget_us, units, on_overrun}};
}

/// The start of the i-th frame of a 30 Hz camera.
inline FrameStart frame_start(int i) {
  return {MonoTime{} + i * kPeriod, static_cast<std::uint64_t>(i), true};
}

}  // namespace cgsr::runtime
