#include "pipeline/motion/motion_status.h"

namespace cgsr {

std::string_view to_string(ArmRequest request) {
  switch (request) {
    case ArmRequest::kNone:
      return "none";
    case ArmRequest::kArm:
      return "arm";
    case ArmRequest::kDisarm:
      return "disarm";
  }
  return "";
}

std::string_view to_string(StopCause cause) {
  switch (cause) {
    case StopCause::kNone:
      return "nothing stops it";
    case StopCause::kStopRequested:
      return "told to stop";
    case StopCause::kDriveFailed:
      return "the base does not take commands (bus off, cable, not started)";
    case StopCause::kDriveNotReady:
      return "the base refuses motion (emergency stop, disabled, low battery)";
    case StopCause::kFeedbackStale:
      return "no usable odometry from the base in time";
    case StopCause::kSafetyFault:
      return "a stage of the safety chain is in fault";
    case StopCause::kBadGoal:
      return "vision gave a goal that is not finite or from the future";
    case StopCause::kImagesLate:
      return "fewer than 90 % of the last 30 images were in time";
    case StopCause::kGoalStale:
      return "the newest goal is too old";
    case StopCause::kNoGoal:
      return "no goal has come yet";
    case StopCause::kHeldTooLong:
      return "stood still for too long on a passing cause";
    case StopCause::kLoopLate:
      return "the motion loop was late within the last second";
    case StopCause::kDisarmed:
      return "not armed";
  }
  return "unknown";
}

bool latches(StopCause cause) {
  return cause >= StopCause::kStopRequested && cause <= StopCause::kBadGoal;
}

}  // namespace cgsr
