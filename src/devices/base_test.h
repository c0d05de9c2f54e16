#pragma once

#include <functional>
#include <string>

#include "hal/rmp/rmp_drive.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace cgsr::devices {

struct BaseTestOptions {
  double listen_s = 5.0;
  bool arm = false;  ///< after listening: drive, if a person confirms it.
  double forward_mps = 0.1;
  double left_radps = 0.2;
  double move_s = 1.0;  ///< each of the two movements.
};

/// Who watches the test: output, a question to a person, and when to end.
struct BaseTestObserver {
  std::function<void(const std::string& line)> print;
  std::function<bool()> confirm = [] { return false; };
  std::function<bool()> stop_requested = [] { return false; };
};

/// Listens to a base and shows odometry, status and faults twice a second. Sends nothing, unless options.arm and the
/// person who confirms it: then forward, zero, left, zero, each compared with what the base reports of it.
///
/// \param drive  not started. \param parameters  its own. \return why the test did not pass: no feedback, a fault, or a
/// movement with the wrong sign.
Result<void> test_base(hal::rmp::RmpDrive& drive, const hal::rmp::RmpParameters& parameters, Clock& clock,
                       const BaseTestOptions& options, const BaseTestObserver& observer);

}  // namespace cgsr::devices
