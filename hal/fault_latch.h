#pragma once

#include <cstdint>
#include <string_view>

#include <tl/expected.hpp>

#include "platform/time.h"

namespace cgsr::hal {

/// Why a base does not move, said by those that know.
enum class DriveFault : std::uint8_t {
  kNone,
  kStarting,         ///< not enough whole sets of feedback yet, after the start or after a fault.
  kBusOff,           ///< the CAN controller took itself off the bus.
  kLinkLost,         ///< commands do not leave: the interface is gone, or its queue stays full.
  kSecondCommander,  ///< somebody else commands the base.
  kPoweredOff,       ///< the user interface is on, the power base is not.
  kFeedbackLost,     ///< a message the drive needs is too old.
  kEmergencyStop,    ///< the emergency stop is open.
  kSafetyShutdown,   ///< the base shuts itself down.
  kBaseFault,        ///< the base reports any other fault of its own: limits, integrity, temperature.
  kLowBattery,       ///< the base warns of an empty battery, or has one.
  kMotorsOff,        ///< disabled, not in the mode that was asked for, or the motors are without power.
  kYawContradiction,  ///< the reported yaw rate turns against the wheels: its sign is configured wrongly. Until a restart.
};

/// \return the fault in words, for people.
constexpr std::string_view to_string(DriveFault fault) {
  constexpr std::string_view kWords[] = {"none",
                                         "waiting for whole sets of feedback",
                                         "the CAN controller is off the bus",
                                         "commands do not leave the CAN interface",
                                         "somebody else commands the base",
                                         "the power base is switched off",
                                         "feedback is too old",
                                         "the emergency stop is open",
                                         "the base shuts itself down",
                                         "the base reports a fault of its own",
                                         "the battery is low",
                                         "the motors are off",
                                         "the yaw rate turns against the wheels: base.rmp.scales.yaw_rate_sign"};
  return kWords[static_cast<std::size_t>(fault)];
}

/// What a base offers beside Drive when its faults latch: once one was seen, a velocity other than zero is refused
/// (kNotReady) until the cause is gone, feedback has been whole for a while, and rearm() was called. Zero can be
/// commanded at any time.
///
/// Threads: as Drive::command. Nothing blocks or allocates.
class FaultLatch {
 public:
  virtual ~FaultLatch() = default;

  /// \return what stops the base now; when nothing does, the first fault that still waits for rearm(); else kNone.
  [[nodiscard]] virtual DriveFault fault() const = 0;

  /// Allows motion again. Whoever calls it takes responsibility: a person, a switch. \return what is still in the way.
  virtual tl::expected<void, DriveFault> rearm(MonoTime now) = 0;
};

}  // namespace cgsr::hal
