#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/drive.h"
#include "platform/parameters.h"

namespace cgsr::hal {

struct KinematicDriveParameters {
  double max_forward_mps = 1.5;
  double max_turn_radps = 3.0;
  double forward_acceleration_mps2 = 1.0;
  double turn_acceleration_radps2 = 4.0;
  double command_timeout_s = 0.4;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("max_forward_mps", self.max_forward_mps, {0.0, 10.0}, "m/s",
                 "The largest forward speed; faster commands are clipped to it.");
    visit.number("max_turn_radps", self.max_turn_radps, {0.0, 20.0}, "rad/s",
                 "The largest turn rate; faster commands are clipped to it.");
    visit.number("forward_acceleration_mps2", self.forward_acceleration_mps2, {0.01, 100.0}, "m/s^2",
                 "The acceleration with which the speed follows a command.");
    visit.number("turn_acceleration_radps2", self.turn_acceleration_radps2, {0.01, 1000.0}, "rad/s^2",
                 "The angular acceleration with which the turn rate follows a command.");
    visit.number("command_timeout_s", self.command_timeout_s, {0.01, 10.0}, "s",
                 "The base slows down to zero when it has received no command for this time.");
  }
};

/// What the dummy base plays for a test of its user.
enum class DriveMood : std::uint8_t {
  kWell,
  kNotReady,  ///< emergency stop pressed: refuses commands with kNotReady and slows to zero.
  kSendFails,  ///< the cable is out: commands fail with kSendFailed, odometry goes stale, the base slows to zero by itself.
  kFeedbackStops  ///< commands arrive, odometry stays what it was.
};
std::string_view to_string(DriveMood mood);

/// A base without wheels: a unicycle whose speed and turn follow the command with limited acceleration.
///
///   v, w   approach the target by at most a dt; the target becomes 0 when the last command is command_timeout_s old
///   x += v cos(h) dt,  y += v sin(h) dt,  h += w dt     v, w and h of the middle of the step
///
/// It lives on the grid of whole milliseconds. A command counts from the next point of the grid on, odometry
/// is that of the last one: the same commands at the same times give the same bits, however often odometry is asked for.
/// Not modelled: balance (pitch stays 0), wheel slip, delay.
///
/// Threads: as Drive; play() and last_command() from any.
class KinematicDrive final : public Drive {
 public:
  explicit KinematicDrive(const KinematicDriveParameters& parameters = {}) : parameters_(parameters) {}

  Result<void> start() override;
  tl::expected<void, DriveFailure> command(const Twist& twist, MonoTime now) override;
  tl::expected<Odometry, DriveFailure> odometry(MonoTime now) override;
  void stop() override;

  void play(DriveMood mood) { mood_.store(mood, std::memory_order_relaxed); }

  /// \return the last command that it took, zero after stop(); none before the first.
  [[nodiscard]] std::optional<Twist> last_command() const;

 private:
  void advance(MonoTime now);
  void step();
  [[nodiscard]] bool stands_still() const;

  const KinematicDriveParameters parameters_;
  std::atomic<DriveMood> mood_{DriveMood::kWell};
  bool started_ = false;
  bool on_grid_ = false;  // the first `now` has been seen
  bool heard_any_ = false;
  Odometry state_;           // at the last point of the grid
  Odometry heard_;           // what odometry() tells
  Twist target_;             // already cut to the maxima
  MonoTime target_until_{};  // the timeout of the last command

  // Two numbers that belong together but may tear: each is written by the motion thread alone, and who reads them while it
  // runs wants to know whether they are zero.
  std::atomic<double> last_forward_mps_{0.0};
  std::atomic<double> last_left_radps_{0.0};
  std::atomic<bool> commanded_{false};
};

}  // namespace cgsr::hal
