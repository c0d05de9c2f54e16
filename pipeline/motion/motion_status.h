#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "hal/drive.h"
#include "hal/fault_latch.h"
#include "platform/description.h"
#include "platform/time.h"

namespace cgsr {

/// Why zero is commanded. The first that holds, in this order, is the one that is named. Ours, as the
/// motion loop is.
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
  kHeldTooLong,    ///< only as what latched: a holding cause lasted longer than max_hold_s.
  kLoopLate,       ///< only as a refusal to arm: a step of the last second came late, or a second has not passed yet.
  kDisarmed,       ///< nobody armed the robot, or somebody disarmed it.
};

/// \return the cause in words, for people.
std::string_view to_string(StopCause cause);

/// \return whether the cause disarms the robot at once; the others only hold it.
bool latches(StopCause cause);

/// The velocity that vision wants, robot frame, with the stamp of the image that it wants it for.
struct Goal {
  hal::Twist twist;
  MonoTime stamp{};
  bool halt = false;  ///< what was followed is gone: forward motion ends at once, without the deceleration limit.
};

enum class ArmRequest : std::uint8_t { kNone, kArm, kDisarm };
std::string_view to_string(ArmRequest request);

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
  hal::Odometry odometry;                 ///< the newest that the base gave; look at its stamp.
  hal::Twist goal;                        ///< the newest goal as it came, zero when there is none.
  MonoTime goal_stamp = MonoTime::min();  ///< of the image that it was decided for; min(): there is none.
  hal::Twist commanded;                   ///< what the base was told, or in a dry run would have been told.
  hal::DriveFault drive_fault = hal::DriveFault::kNone;  ///< of a base with a FaultLatch: what it says itself.
  bool sent = false;                                     ///< the base took the command; never true in a dry run.
  bool armed = false;
  bool keep_in_slowed = false;  ///< the keep-in area took speed from the goal.
  bool late = false;            ///< this step came later than two periods after the last, or time stood still.
  StopCause cause = StopCause::kDisarmed;    ///< why zero is commanded; kNone: the goal is.
  StopCause latched = StopCause::kNone;      ///< the fault that disarmed the robot, until it is armed again.
  StopCause arm_refusal = StopCause::kNone;  ///< in the step of a refused request: why.

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("commanded_mps", self.commanded.forward_mps, {4}, "m/s", "forward speed that the base was commanded");
    visit.number("commanded_radps", self.commanded.left_radps, {4}, "rad/s", "turn rate that the base was commanded");
    visit.flag("armed", self.armed, "the robot is armed");
    visit.text("stop_cause", to_string(self.cause), "why zero is commanded");
  }
};
static_assert(std::is_trivially_copyable_v<MotionStatus>);

}  // namespace cgsr
