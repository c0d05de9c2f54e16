#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/camera.h"
#include "hal/can_bus.h"
#include "hal/drive.h"
#include "hal/simulation.h"
#include "hal/socketcan/parameters.h"
#include "hal/switches.h"
#include "platform/clock.h"
#include "src/config/robot.h"

namespace cgsr::boot {

/// What a factory may use.
struct DeviceContext {
  const config::Robot& config;
  hal::Simulation* simulation;  ///< null exactly when config.simulated() is false. Outlives the devices.
  MonoTime simulation_origin;   ///< the program's time at which the simulation's is 0; 0 where its stamps are the time.
  RealClock& clock;             ///< outlives the devices.
};

/// A camera that streams, and what there is to say of it.
struct OpenCamera {
  std::unique_ptr<hal::Camera> camera;
  hal::CameraMode mode;
  MonoTime first_due{};            ///< when the first image is there, in lock-step.
  std::vector<std::string> notes;  ///< for the person who started the robot.
};

/// The camera of the kind camera.kind, started. \return what is wrong with the device or its files.
Result<OpenCamera> open_camera(const DeviceContext& context);

/// The base of the kind base.kind, not started. \return what is wrong with its bus.
Result<std::unique_ptr<hal::Drive>> make_base(const DeviceContext& context);

/// The lines of the kind switches.kind, not started.
Result<std::unique_ptr<hal::Switches>> make_switches(const DeviceContext& context);

/// A CAN interface of this computer, not started. Of what travels there only the messages of the RMP family and what
/// commands it reach the program (hal/rmp/messages.h).
std::unique_ptr<hal::CanBus> make_socketcan_bus(const hal::socketcan::SocketCanParameters& parameters);

}  // namespace cgsr::boot
