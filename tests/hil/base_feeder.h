#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/sim/base/simulated_rmp.h"
#include "platform/error.h"
#include "platform/time.h"
#include "tests/hil/recorded_motion.h"

namespace cgsr::hil {

/// What is wrong with the base at this moment.
struct BaseFaults {
  bool silent = false;          ///< what it sends is lost; it hears everything.
  bool emergency_stop = false;  ///< it says so and obeys nothing.
  bool powered_off = false;     ///< its box alone is on and says so; nothing obeys.
};

/// The simulated Segway on a CAN interface of this computer. What it did is kept in memory and written at the end.
///
/// Threads: one at a time.
class BaseFeeder {
 public:
  /// \param keep_s  of how long it keeps what it did. \param motion  what it says of its motion once a time of the recording is given; null: always
  /// what it does. Outlives it.
  static Result<std::unique_ptr<BaseFeeder>> start(const std::string& interface, MonoTime now, double keep_s,
                                                   RecordedMotion* motion);
  virtual ~BaseFeeder() = default;

  /// Catches up with the time and sends the sets of messages that are due. \param recorded  the time of the recording.
  virtual void advance_to(MonoTime now, const BaseFaults& faults, std::optional<Duration> recorded) = 0;

  /// Seconds on the monotonic clock, pose, speed and turn rate over the ground, a line for every step that moved or followed motion.
  virtual Result<void> write_truth(const std::string& file) const = 0;
};

}  // namespace cgsr::hil
