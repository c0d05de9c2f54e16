#pragma once

#include <cstdint>
#include <string_view>

#include "platform/error.h"
#include "platform/time.h"

namespace cgsr::hal {

/// Velocity of the robot in its own frame (x forward, y left, z up).
struct Twist {
  double forward_mps = 0.0;
  double left_radps = 0.0;  ///< about z, positive turns left.
};

/// What the base last reported. The pose is the odometry's, from start(): it drifts.
struct Odometry {
  MonoTime stamp{};
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  Twist velocity;
  double pitch_rad = 0.0;  ///< positive leans forward.
};

enum class DriveFailure : std::uint8_t {
  kNotStarted,
  kNotReady,    ///< the base refuses motion: disabled, emergency stop, low battery.
  kSendFailed,  ///< the command did not leave this computer.
  kNoFeedback,  ///< nothing heard from the base yet, or nothing recent enough to drive on.
};
constexpr std::string_view to_string(DriveFailure failure) {
  switch (failure) {
    case DriveFailure::kNotStarted:
      return "not started";
    case DriveFailure::kNotReady:
      return "not ready";
    case DriveFailure::kSendFailed:
      return "send failed";
    case DriveFailure::kNoFeedback:
      return "no feedback";
  }
  return "";
}

/// A base that is driven by velocity commands and reports odometry.
///
/// Threads: start and stop from the service thread, the rest from the motion thread only. Nothing here blocks or
/// allocates but start and stop. `now` never falls from call to call.
class Drive {
 public:
  virtual ~Drive() = default;

  /// Opens the base. It stands still and stays still until the first command. Starting twice is an error; after stop()
  /// it may be started again: the odometry's pose then begins anew.
  virtual Result<void> start() = 0;

  /// Commands a velocity from `now` on; non-finite values are refused as kSendFailed and change nothing. A base may
  /// bound what it is asked for (speed, acceleration): odometry tells what it does. It stops by itself when commands
  /// cease (the Segway after 0.4 s).
  virtual tl::expected<void, DriveFailure> command(const Twist& twist, MonoTime now) = 0;

  /// \return the newest odometry at or before `now`; its stamp says how old it is.
  virtual tl::expected<Odometry, DriveFailure> odometry(MonoTime now) = 0;

  /// Commands zero and closes. Idempotent.
  virtual void stop() = 0;
};

}  // namespace cgsr::hal
