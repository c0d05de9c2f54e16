#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/rmp/rmp_drive.h"
#include "hal/sim/base/virtual_segway.h"

namespace cgsr::test {

inline constexpr MonoTime kBegin{seconds(100.0)};

/// \return the time `s` seconds after the rig was switched on.
inline MonoTime at(double s) {
  return kBegin + seconds(s);
}

/// The driver on a virtual bus with a simulated base, beaten at 100 Hz as the motion loop does.
struct Rig {
  struct Setup {
    sim::BaseParameters base;
    std::vector<sim::BaseEvent> base_script;
    std::vector<sim::BusEvent> bus_script;
    hal::rmp::RmpParameters drive;
    std::uint64_t seed = 1;
  };

  Rig() : Rig(Setup{}) {}
  explicit Rig(const Setup& setup)
      : segway(setup.base, {.time = kBegin, .seed = setup.seed}, setup.base_script, setup.bus_script),
        drive(segway.host_port(), setup.drive) {
    if (const auto started = drive.start(); !started) ADD_FAILURE() << started.error().message;
  }

  /// One cycle of 10 ms: what the motion loop does, in its order. \return what the command came to.
  tl::expected<void, hal::DriveFailure> cycle(const hal::Twist& twist) {
    now += seconds(0.010);
    if (const auto heard = drive.odometry(now)) odometry = *heard;
    return drive.command(twist, now);
  }

  /// Beats until `s` seconds after the beginning. \return what the last command came to.
  tl::expected<void, hal::DriveFailure> run_until(double s, const hal::Twist& twist) {
    tl::expected<void, hal::DriveFailure> last;
    while (now < at(s)) last = cycle(twist);
    return last;
  }

  /// Beats with `twist` until the fault is there, at most two seconds. \return how long it took [s].
  std::optional<double> run_until_fault(hal::DriveFault fault, const hal::Twist& twist) {
    const MonoTime begin = now;
    while (now < begin + seconds(2.0)) {
      (void)cycle(twist);
      if (drive.fault() == fault) return to_seconds(now - begin);
    }
    return std::nullopt;
  }

  [[nodiscard]] double true_speed_mps() { return segway.base().state_at(now).velocity.forward_mps; }

  sim::VirtualSegway segway;
  hal::rmp::RmpDrive drive;
  hal::Odometry odometry;  // the last heard
  MonoTime now = kBegin;
};

inline constexpr hal::Twist kForward{.forward_mps = 0.4};
inline constexpr hal::Twist kStand{};

}  // namespace cgsr::test
