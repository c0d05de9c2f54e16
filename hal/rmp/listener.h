#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/can_bus.h"
#include "hal/drive.h"
#include "hal/fault_latch.h"
#include "hal/rmp/feedback_age.h"
#include "hal/rmp/messages.h"
#include "hal/rmp/odometer.h"
#include "hal/rmp/parameters.h"
#include "hal/rmp/yaw_check.h"

namespace cgsr::hal::rmp {

/// What the base says about itself, for a person to read.
struct RmpReport {
  ModeAndPower power;
  Status status;
  std::uint16_t firmware_build = 0;
};

/// \return what the status words and the mode forbid; kNone: the base is ready to move.
DriveFault reported_fault(const RmpReport& report);

/// What was noticed on the bus; none of them ever falls.
struct FeedbackCounters {
  std::uint64_t sets = 0;             ///< whole sets of feedback.
  std::uint64_t lost_sets = 0;        ///< by the servo frame counter.
  std::uint64_t late = 0;             ///< times that a needed message grew older than feedback_warn_s.
  std::uint64_t stale = 0;            ///< times that one grew older than feedback_timeout_s.
  std::uint64_t implausible = 0;      ///< messages left out for values that no base has.
  std::uint64_t jumps = 0;            ///< displacements left out, see Odometer.
  std::uint64_t new_baselines = 0;    ///< times that the base started counting anew.
  std::uint64_t undecodable = 0;      ///< frames of another family or size.
  std::uint64_t echo_mismatches = 0;  ///< echoes of none of the last commands: some did not arrive.
  std::uint64_t foreign_commands = 0;
};

/// Everything that is known about the base from its frames. A message with values that no base has counts as one that
/// did not come.
class Listener {
 public:
  explicit Listener(const RmpParameters& parameters);

  void take(const CanFrame& frame, MonoTime stamp);

  /// Remembers what the base was told, so that its echo can be compared.
  void said(const Command& command);

  /// \return whether every needed message has come at least once.
  [[nodiscard]] bool complete() const { return age_.complete(); }

  /// As FeedbackAge::oldest.
  [[nodiscard]] std::optional<FeedbackAge::Oldest> oldest(MonoTime now) const { return age_.oldest(now); }

  /// \return whether a needed message is too old at `now`; false until all have come. Counts what it sees.
  bool stale(MonoTime now);

  [[nodiscard]] int sets_in_a_row() const { return age_.sets_in_a_row(); }
  void break_series() { age_.break_series(); }

  [[nodiscard]] const Odometry& odometry() const { return odometry_; }
  [[nodiscard]] const RmpReport& report() const { return report_; }
  [[nodiscard]] const FeedbackCounters& counters() const { return counters_; }
  [[nodiscard]] const std::optional<MonoTime>& foreign_command_at() const { return foreign_command_at_; }
  [[nodiscard]] const std::optional<MonoTime>& powered_off_at() const { return powered_off_at_; }
  [[nodiscard]] YawCheck::Verdict yaw_check() const { return yaw_check_.verdict(); }

 private:
  void take_motion(const Motion& motion, MonoTime stamp);
  void take_integrated(const Integrated& integrated, MonoTime stamp);
  void take_attitude(const Attitude& attitude, MonoTime stamp);
  void check_echo(const Echo& echo);
  void fresh(MessageId id, MonoTime stamp);

  RmpParameters parameters_;
  FeedbackAge age_;
  Odometer odometer_;
  Odometry odometry_;
  RmpReport report_;
  FeedbackCounters counters_;
  std::optional<Motion> motion_;
  YawCheck yaw_check_;
  std::optional<MonoTime> foreign_command_at_;
  std::optional<MonoTime> powered_off_at_;
  std::array<Command, 4> said_{};  // a ring
  std::size_t said_count_ = 0;
  bool late_ = false;
  bool stale_ = false;
};

}  // namespace cgsr::hal::rmp
