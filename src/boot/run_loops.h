#pragma once

#include "platform/stop.h"
#include "src/boot/robot_state.h"

namespace cgsr::boot {

/// One thread steps all tasks in the order of docs/architecture.md; the stamps of the images are the time.
/// \return what became of the camera.
Result<void> run_lock_step(RobotState& state, StopRequest& stop);

/// Every task has its thread (docs/threads.md) and the clock is real.
Result<void> run_live(RobotState& state, StopRequest& stop);

/// \return what became of the camera. To be asked before the camera is told to stop, which counts as lost too.
Result<void> camera_outcome(const RobotState& state);

}  // namespace cgsr::boot
