#pragma once

#include "src/boot/boot_plan.h"
#include "src/boot/robot_state.h"

namespace cgsr::boot {

/// Adds the steps by which a robot's file becomes a robot: devices, calibration, object, map, stages, outputs.
/// \param state  outlives the plan.
void add_robot_steps(BootPlan& plan, RobotState& state);

// The steps, by what they make. Each reads what the steps before it left in the state.
Result<void> open_simulation(RobotState& state);
Result<void> start_camera(RobotState& state);
Result<void> start_base(RobotState& state);
Result<void> start_switches(RobotState& state);
Result<void> load_model(RobotState& state);
Result<void> load_map(RobotState& state);
Result<void> read_calibration(RobotState& state);
Result<void> fit_calibration(RobotState& state);
Result<void> make_object(RobotState& state);
Result<void> make_localization(RobotState& state);
Result<void> make_light(RobotState& state);
Result<void> load_people(RobotState& state);
Result<void> make_people(RobotState& state);
Result<void> make_task(RobotState& state);
Result<void> make_loop(RobotState& state);
Result<void> open_outputs(RobotState& state);

}  // namespace cgsr::boot
