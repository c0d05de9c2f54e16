#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>

#include "hal/drive.h"
#include "pipeline/motion_limits.h"
#include "platform/error.h"
#include "platform/time.h"

namespace cgsr {

/// The motion loop's beat: who calls step() calls it this often.
inline constexpr Duration kMotionPeriod = seconds(0.010);

/// Why zero is commanded. The first that holds, in this order, is the one that is named.
enum class StopCause : std::uint8_t {
  kNone,
  kStopRequested,  ///< latches. The process is told to stop.
  kDriveFailed,    ///< latches. A command did not leave the computer, or the base was not started: bus off, cable out.
  kDriveNotReady,  ///< latches. The base refuses motion: emergency stop, disabled, low battery.
  kFeedbackStale,  ///< latches. No usable odometry within feedback_timeout_s.
  kSafetyFault,    ///< latches. A stage of the safety chain faulted.
  kBadGoal,        ///< latches. A goal was not finite or stamped in the future.
  kImagesLate,     ///< holds. Fewer than 90 % of the last 30 images were in time.
  kGoalStale,      ///< holds. The newest goal's image is older than goal_timeout_s.
  kNoGoal,         ///< holds. No goal has come yet.
  kHeldTooLong,    ///< only as what latched: a holding cause lasted longer than longest_hold_s.
  kLoopLate,       ///< only as a refusal to arm: a step of the last second came late, or a second has not passed yet.
  kDisarmed,       ///< nobody armed the robot, or somebody disarmed it.
};

/// \return the cause in words, for people.
std::string_view text(StopCause cause);

/// What vision wants, with the stamp of the image that it wants it for.
struct Goal {
  hal::Twist twist;
  MonoTime stamp{};
};

enum class ArmRequest : std::uint8_t { kNone, kArm, kDisarm };

/// What a step is told. A default-constructed one permits no motion.
struct MotionInputs {
  std::optional<Goal> goal;      ///< the newest, when one came since the last step.
  bool images_in_time = false;   ///< at least 90 % of the last 30 images were in time.
  bool safety_chain_ok = false;  ///< no stage of the safety chain is in fault.
  bool stop = false;  ///< the process is told to stop. Ends all motion until it is false and the robot armed again.
  ArmRequest request = ArmRequest::kNone;  ///< an event: of a command, or an edge of the arming switch.
};

/// What a step did, for the log ring and for vision (odometry).
struct MotionStatus {
  MonoTime stamp{};
  hal::Odometry odometry;  ///< the newest that the base gave; look at its stamp.
  hal::Twist goal;         ///< the newest goal as it came, zero when there is none.
  hal::Twist commanded;    ///< what the base was told, or in a dry run would have been told.
  bool sent = false;       ///< the base took the command; never true in a dry run.
  bool armed = false;
  bool keep_in_slowed = false;  ///< the keep-in area took speed from the goal.
  bool late = false;            ///< this step came later than two periods after the last, or time stood still.
  StopCause cause = StopCause::kDisarmed;    ///< why zero is commanded; kNone: the goal is.
  StopCause latched = StopCause::kNone;      ///< the fault that disarmed the robot, until it is armed again.
  StopCause arm_refusal = StopCause::kNone;  ///< in the step of a refused request: why.
};
static_assert(std::is_trivially_copyable_v<MotionStatus>);

/// Owns the base and tells it, 100 times a second, how to move: the goal within the limits, or zero.
///
/// It starts disarmed. Arming is refused, with the cause, while anything stops the robot or the loop was late within
/// the last second. A stop is zero at once, without a ramp; a slower goal is approached with the deceleration limit.
/// After a latching cause the robot is disarmed; after a holding one it starts again from zero with the acceleration
/// limit. Rows and times: docs/faults.md. A dry run computes and reports all this and never commands anything, not even
/// zero.
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

  /// One beat. \param now  never falls; a step that repeats or precedes the last `now` counts as late.
  MotionStatus step(MonoTime now, const MotionInputs& inputs);

  /// Disarms, commands zero and closes the base. Idempotent; the destructor does it too.
  void stop();

 private:
  static constexpr int kStepsInTimeToArm = 100;

  void take_time(MonoTime now);
  [[nodiscard]] StopCause take_goal(MonoTime now, const std::optional<Goal>& goal);
  [[nodiscard]] StopCause take_odometry(MonoTime now);
  [[nodiscard]] StopCause standing_cause(MonoTime now, const MotionInputs& inputs);
  [[nodiscard]] StopCause arm(ArmRequest request, StopCause standing);
  void disarm_if_due(MonoTime now, StopCause standing);
  void disarm(StopCause latched);
  [[nodiscard]] hal::Twist towards_goal(MonoTime now, MotionStatus& status) const;
  void send(const hal::Twist& twist, MonoTime now, MotionStatus& status);

  std::unique_ptr<hal::Drive> drive_;
  MotionParameters parameters_;
  Mode mode_;
  bool armed_ = false;
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

}  // namespace cgsr
