#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hal/rmp/scales.h"
#include "platform/parameters.h"

namespace cgsr::hal::rmp {

/// What the drive asks of the base after start(), once, before it was ready for the first time.
enum class ModeAtStart : std::uint8_t { kKeep, kTractor, kBalance };

inline constexpr std::array kModeAtStartNames = {Named<ModeAtStart>{"keep", ModeAtStart::kKeep},
                                                 Named<ModeAtStart>{"tractor", ModeAtStart::kTractor},
                                                 Named<ModeAtStart>{"balance", ModeAtStart::kBalance}};
constexpr std::string_view to_string(ModeAtStart mode) {
  return word_in(kModeAtStartNames, mode);
}

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
                 "The operating mode that the driver requests from the base at the start; keep leaves the mode that "
                 "was chosen on the base.");
    visit.number("hold_s", self.hold_s, {0.02, 0.3}, "s",
                 "A velocity command is repeated for this time when no newer one arrives; after that, zero is sent.");
    visit.number("feedback_warn_s", self.feedback_warn_s, {0.015, 0.1}, "s",
                 "A required message older than this is counted as late; two complete sets further apart than this are "
                 "not consecutive.");
    visit.number("feedback_timeout_s", self.feedback_timeout_s, {0.02, 0.3}, "s",
                 "The robot is stopped when a required message is older than this.");
    visit.number("min_ready_sets", self.min_ready_sets, {1, 1000}, "sets",
                 "The number of consecutive complete message sets, 10 ms each, after which the base is ready at the "
                 "start and after a fault.");
    visit.number("max_refusals", self.max_refusals, {1, 100}, "commands",
                 "The link is lost when a full queue has refused this many commands in a row.");
    visit.number("max_plausible_mps", self.max_plausible_mps, {1.0, 20.0}, "m/s",
                 "A message that reports a faster wheel is treated as damaged.");
    visit.number("max_plausible_radps", self.max_plausible_radps, {1.0, 50.0}, "rad/s",
                 "A message that reports a faster turn is treated as damaged.");
    visit.section("scales", self.scales, "The counts per physical unit on the bus of the base");
  }
};

}  // namespace cgsr::hal::rmp
