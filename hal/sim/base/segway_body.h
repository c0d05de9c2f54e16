#pragma once

#include <cstdint>

#include "hal/drive.h"
#include "hal/sim/base/base_parameters.h"

namespace cgsr::sim {

/// A unit vector that turns without sine and cosine: libc picks its versions of them by the CPU it finds, and then the
/// last bits, and in the end the bytes of a run, differ from machine to machine.
struct Direction {
  double x = 1.0;
  double y = 0.0;

  void turn(double left_rad);
};

/// Standard normal numbers, the same on every machine: the sum of twelve uniform ones (tails end at 6).
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  double next();

 private:
  std::uint64_t state_;
};

/// What the servo loop wants of the body.
struct BodyTarget {
  bool motors = false;   ///< without them it brakes, on its stand, upright.
  bool balances = true;  ///< else it stands on more than two wheels and does not pitch.
  hal::Twist velocity;
  double max_acceleration_mps2 = 1.5;
};

/// Wheels, body and ground of a two-wheeled robot that balances.
///
/// The body is an inverted pendulum of length l on wheels with velocity v: to accelerate it has to lean, and to lean it
/// first rolls back a little.
///
///   l theta'' = g theta - v'                      the pendulum, small angles
///   theta'' = w^2 (s'/g - theta) - 2 d w theta'   what balancing makes of it
///                                                 s: the wanted speed, bounded in slope and lagging
///
/// The second is integrated once (V' = theta, V'' = w^2 (s/g - V) - 2 d w V'), which gives v = g V - l theta' without
/// drift. Constant acceleration a leans it by a/g: 2.3 degrees for 0.4 m/s^2.
///
/// Over the ground go the wheels less their slip, a slow random process for each (Ornstein-Uhlenbeck), and turns less
/// scrub.
class SegwayBody {
 public:
  SegwayBody(const BaseParameters& parameters, double x_m, double y_m, double heading_rad, std::uint64_t seed);

  static constexpr double kStep_s = 0.001;

  /// One millisecond.
  void step(const BodyTarget& target);

  // Over the ground, in the world.
  [[nodiscard]] double x_m() const { return x_m_; }
  [[nodiscard]] double y_m() const { return y_m_; }
  [[nodiscard]] double heading_rad() const { return heading_rad_; }  ///< not wrapped.
  [[nodiscard]] const hal::Twist& velocity() const { return over_ground_; }
  [[nodiscard]] double pitch_rad() const { return pitch_rad_; }
  [[nodiscard]] double pitch_rate_radps() const { return pitch_rate_radps_; }

  // What the wheels did: all that the base itself knows.
  [[nodiscard]] double left_wheel_mps() const { return speed_mps_ - 0.5 * p_.track_m * turn_radps_; }
  [[nodiscard]] double right_wheel_mps() const { return speed_mps_ + 0.5 * p_.track_m * turn_radps_; }
  [[nodiscard]] double turn_radps() const { return turn_radps_; }
  [[nodiscard]] double left_way_m() const { return left_way_m_; }
  [[nodiscard]] double right_way_m() const { return right_way_m_; }
  [[nodiscard]] double acceleration_mps2() const { return acceleration_mps2_; }

 private:
  void drive(const BodyTarget& target);
  void roll_out();
  void roll();

  BaseParameters p_;
  Noise noise_;
  Direction direction_;
  double x_m_;
  double y_m_;
  double heading_rad_;
  hal::Twist over_ground_;

  double wanted_mps_ = 0.0;  // within the acceleration limit
  double smooth_mps_ = 0.0;  // s
  double lean_s_ = 0.0;      // V
  double pitch_rad_ = 0.0;   // theta
  double pitch_rate_radps_ = 0.0;
  double speed_mps_ = 0.0;  // v, of the axle's middle, by the wheels
  double acceleration_mps2_ = 0.0;
  double turn_radps_ = 0.0;
  double left_way_m_ = 0.0;
  double right_way_m_ = 0.0;
  double left_slip_ = 0.0;
  double right_slip_ = 0.0;
};

}  // namespace cgsr::sim
