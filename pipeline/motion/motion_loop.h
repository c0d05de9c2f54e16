#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "hal/drive.h"
#include "hal/fault_latch.h"
#include "pipeline/motion/motion_limits.h"
#include "pipeline/motion/motion_status.h"
#include "platform/error.h"
#include "platform/time.h"

namespace cgsr {

/// The motion loop's cycle: who calls step() calls it this often.
inline constexpr Duration kMotionPeriod = seconds(0.010);

/// Owns the base and tells it, 100 times a second, how to move: the goal within the limits, or zero.
/// Ours: the dissertation (3.3.2) says only that motion runs on the same computer as vision.
///
/// It starts disarmed. Arming is refused, with the cause, while anything stops the robot or the loop was late within the
/// last second; where the base has a FaultLatch, arming re-arms it too. A stop is zero at once, without a ramp, and so is
/// a goal that halts; a slower goal is approached with the deceleration limit, unless the keep-in area needs more. After a latching cause the robot
/// is disarmed; after a holding one it starts again from zero with the acceleration limit. Rows and times: docs/faults.md.
///
/// A dry run computes and reports all this, and calls neither the base's command() nor its rearm().
///
/// Threads: start and stop from the service thread while no step runs, step from the motion thread only. step does not
/// block, allocate or throw.
class MotionLoop {
 public:
  enum class Mode : std::uint8_t { kLive, kDryRun };

  /// \param drive  not null, not started.
  MotionLoop(std::unique_ptr<hal::Drive> drive, const MotionParameters& parameters, Mode mode);
  ~MotionLoop();
  MotionLoop(const MotionLoop&) = delete;
  MotionLoop& operator=(const MotionLoop&) = delete;

  /// Opens the base, which stands still.
  Result<void> start();

  /// One cycle. \param now  never falls; a step that repeats or precedes the last `now` counts as late.
  MotionStatus step(MonoTime now, const MotionInputs& inputs);

  /// Disarms, commands zero and closes the base. Idempotent; the destructor does it too.
  void stop();

  /// Whether it ever was, in whatever mode. From the thread of step(), or once that has ended.
  [[nodiscard]] bool was_armed() const { return was_armed_; }

 private:
  static constexpr int kStepsInTimeToArm = 100;

  void take_time(MonoTime now);
  [[nodiscard]] StopCause take_goal(MonoTime now, const std::optional<Goal>& goal);
  [[nodiscard]] StopCause take_odometry(MonoTime now);
  [[nodiscard]] StopCause standing_cause(MonoTime now, const MotionInputs& inputs);
  [[nodiscard]] hal::DriveFault drive_fault() const;
  [[nodiscard]] StopCause arm(MonoTime now, ArmRequest request, StopCause standing);
  [[nodiscard]] StopCause rearm_drive(MonoTime now);
  void disarm_if_due(MonoTime now, StopCause standing);
  void disarm(StopCause latched);
  [[nodiscard]] hal::Twist towards_goal(MonoTime now, MotionStatus& status) const;
  void send(const hal::Twist& twist, MonoTime now, MotionStatus& status);

  std::unique_ptr<hal::Drive> drive_;
  hal::FaultLatch* latch_;  // the drive's other face; null when it has none
  MotionParameters parameters_;
  Mode mode_;
  bool armed_ = false;
  bool was_armed_ = false;
  bool arm_when_possible_;
  StopCause latched_ = StopCause::kNone;
  std::optional<Goal> goal_;
  hal::Odometry odometry_;
  hal::Twist commanded_;
  std::optional<MonoTime> last_step_;
  std::optional<MonoTime> held_since_;
  StopCause send_failure_ = StopCause::kNone;  // of the last command
  Duration elapsed_{};                         // for the ramps
  bool late_ = false;
  int steps_in_time_ = 0;  // since the last late one
};

std::string_view to_string(MotionLoop::Mode mode);

}  // namespace cgsr
