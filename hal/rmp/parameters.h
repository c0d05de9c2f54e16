#pragma once

#include <array>
#include <cstdint>

#include "hal/rmp/scales.h"
#include "platform/parameters.h"

namespace cgsr::hal::rmp {

/// What the drive asks of the base after start(), once, before it was ready for the first time.
enum class ModeAtStart : std::uint8_t { kKeep, kTractor, kBalance };

inline constexpr std::array kModeAtStartNames = {Named<ModeAtStart>{"keep", ModeAtStart::kKeep},
                                                 Named<ModeAtStart>{"tractor", ModeAtStart::kTractor},
                                                 Named<ModeAtStart>{"balance", ModeAtStart::kBalance}};

struct RmpParameters {
  ModeAtStart mode_at_start = ModeAtStart::kKeep;
  double hold_s = 0.150;
  double feedback_warn_s = 0.030;
  double feedback_timeout_s = 0.100;
  int min_ready_sets = 10;
  int max_refusals = 3;
  double max_plausible_mps = 5.0;
  double max_plausible_radps = 8.0;
  RmpScales scales;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("mode_at_start", self.mode_at_start, kModeAtStartNames,
                 "what the base is asked for at the start; keep: a person has chosen on the base itself");
    visit.number("hold_s", self.hold_s, {0.02, 0.3}, "s",
                 "how long a command holds without another; then zero is sent");
    visit.number("feedback_warn_s", self.feedback_warn_s, {0.015, 0.1}, "s",
                 "age of a needed message that is counted as late, and the longest way between two sets in a row");
    visit.number("feedback_timeout_s", self.feedback_timeout_s, {0.02, 0.3}, "s",
                 "age of a needed message past which the robot is stopped");
    visit.number("min_ready_sets", self.min_ready_sets, {1, 1000}, "sets",
                 "whole sets in a row, 10 ms each, before the base counts as ready, at the start and after a fault");
    visit.number("max_refusals", self.max_refusals, {1, 100}, "commands",
                 "commands in a row that a full queue refuses before the link counts as lost");
    visit.number("max_plausible_mps", self.max_plausible_mps, {1.0, 20.0}, "m/s",
                 "a wheel reported as faster is a damaged message");
    visit.number("max_plausible_radps", self.max_plausible_radps, {1.0, 50.0}, "rad/s", "likewise a turn");
    visit.section("scales", self.scales, "Counts per unit on the base's bus");
  }
};

}  // namespace cgsr::hal::rmp
