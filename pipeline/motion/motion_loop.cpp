#include "pipeline/motion/motion_loop.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/behavior/ramp.h"

namespace cgsr {

namespace {

constexpr Duration kLateAfter = 2 * kMotionPeriod;

bool finite(const hal::Twist& twist) {
  return std::isfinite(twist.forward_mps) && std::isfinite(twist.left_radps);
}

bool finite(const hal::Odometry& odometry) {
  return std::isfinite(odometry.x_m) && std::isfinite(odometry.y_m) && std::isfinite(odometry.heading_rad) &&
         finite(odometry.velocity);
}

StopCause cause_of(hal::DriveFailure failure) {
  switch (failure) {
    case hal::DriveFailure::kNotReady:
      return StopCause::kDriveNotReady;
    case hal::DriveFailure::kNoFeedback:
      return StopCause::kFeedbackStale;
    case hal::DriveFailure::kNotStarted:
    case hal::DriveFailure::kSendFailed:
      break;
  }
  return StopCause::kDriveFailed;
}

StopCause cause_of(hal::DriveFault fault) {
  switch (fault) {
    case hal::DriveFault::kNone:
      return StopCause::kNone;
    case hal::DriveFault::kBusOff:
    case hal::DriveFault::kLinkLost:
      return StopCause::kDriveFailed;
    case hal::DriveFault::kStarting:
    case hal::DriveFault::kFeedbackLost:
      return StopCause::kFeedbackStale;
    default:
      return StopCause::kDriveNotReady;
  }
}

/// The one to name when both hold.
StopCause graver(StopCause a, StopCause b) {
  if (a == StopCause::kNone) return b;
  if (b == StopCause::kNone) return a;
  return std::min(a, b);
}

}  // namespace

std::string_view to_string(MotionLoop::Mode mode) {
  switch (mode) {
    case MotionLoop::Mode::kLive:
      return "live";
    case MotionLoop::Mode::kDryRun:
      return "dry run";
  }
  return "";
}

MotionLoop::MotionLoop(std::unique_ptr<hal::Drive> drive, const MotionParameters& parameters, Mode mode)
    : drive_(std::move(drive)),
      latch_(dynamic_cast<hal::FaultLatch*>(drive_.get())),
      parameters_(parameters),
      mode_(mode),
      arm_when_possible_(parameters.armed_at_start) {}

MotionLoop::~MotionLoop() {
  stop();
}

Result<void> MotionLoop::start() {
  return drive_->start();
}

void MotionLoop::stop() {
  disarm(latched_);
  arm_when_possible_ = false;
  drive_->stop();
}

MotionStatus MotionLoop::step(MonoTime now, const MotionInputs& inputs) {
  MotionStatus status;
  take_time(now);
  const StopCause standing = standing_cause(now, inputs);
  disarm_if_due(now, standing);
  status.arm_refusal = arm(now, inputs.request, standing);
  status.cause = graver(standing, armed_ ? StopCause::kNone : StopCause::kDisarmed);
  send(status.cause == StopCause::kNone ? towards_goal(now, status) : hal::Twist{}, now, status);

  status.stamp = now;
  status.odometry = odometry_;
  if (goal_) {
    status.goal = goal_->twist;
    status.goal_stamp = goal_->stamp;
  }
  status.commanded = commanded_;
  status.armed = armed_;
  status.drive_fault = drive_fault();
  status.late = late_;
  status.latched = latched_;
  return status;
}

void MotionLoop::take_time(MonoTime now) {
  const Duration since_last = last_step_ ? now - *last_step_ : kMotionPeriod;
  last_step_ = now;
  late_ = since_last <= Duration::zero() || since_last > kLateAfter;
  steps_in_time_ = late_ ? 0 : std::min(steps_in_time_ + 1, kStepsInTimeToArm);
  // A late step must not become a jump of speed.
  elapsed_ = std::clamp(since_last, Duration::zero(), kLateAfter);
}

StopCause MotionLoop::take_goal(MonoTime now, const std::optional<Goal>& goal) {
  if (goal) {
    if (!finite(goal->twist) || goal->stamp > now) {
      goal_.reset();
      return StopCause::kBadGoal;
    }
    if (!goal_ || goal->stamp >= goal_->stamp) goal_ = goal;
  }
  if (!goal_) return StopCause::kNoGoal;
  return now - goal_->stamp > seconds(parameters_.goal_timeout_s) ? StopCause::kGoalStale : StopCause::kNone;
}

StopCause MotionLoop::take_odometry(MonoTime now) {
  const auto odometry = drive_->odometry(now);
  if (!odometry) return cause_of(odometry.error());
  if (!finite(*odometry) || odometry->stamp > now) return StopCause::kFeedbackStale;
  odometry_ = *odometry;
  return now - odometry_.stamp > seconds(parameters_.feedback_timeout_s) ? StopCause::kFeedbackStale : StopCause::kNone;
}

StopCause MotionLoop::standing_cause(MonoTime now, const MotionInputs& inputs) {
  StopCause cause = graver(take_odometry(now), send_failure_);
  // Disarmed, a fault that only waits for rearm() must not stand in the way of arming.
  if (armed_) cause = graver(cause, cause_of(drive_fault()));
  cause = graver(cause, take_goal(now, inputs.goal));
  if (inputs.stop) cause = graver(cause, StopCause::kStopRequested);
  if (!inputs.safety_chain_ok) cause = graver(cause, StopCause::kSafetyFault);
  if (!inputs.images_in_time) cause = graver(cause, StopCause::kImagesLate);
  return cause;
}

void MotionLoop::disarm_if_due(MonoTime now, StopCause standing) {
  if (standing == StopCause::kStopRequested) arm_when_possible_ = false;
  if (!armed_ || standing == StopCause::kNone) {
    held_since_.reset();
    return;
  }
  if (!held_since_) held_since_ = now;
  if (latches(standing)) {
    disarm(standing);
  } else if (now - *held_since_ > seconds(parameters_.max_hold_s)) {
    disarm(StopCause::kHeldTooLong);
  }
}

StopCause MotionLoop::arm(MonoTime now, ArmRequest request, StopCause standing) {
  if (request == ArmRequest::kDisarm) {
    arm_when_possible_ = false;
    disarm(latched_);
    return StopCause::kNone;
  }
  if (armed_ || (request == ArmRequest::kNone && !arm_when_possible_)) return StopCause::kNone;

  const StopCause loop = steps_in_time_ < kStepsInTimeToArm ? StopCause::kLoopLate : StopCause::kNone;
  StopCause refusal = graver(standing, loop);
  if (refusal == StopCause::kNone) refusal = rearm_drive(now);
  if (refusal == StopCause::kNone) {
    armed_ = was_armed_ = true;
    arm_when_possible_ = false;
    latched_ = StopCause::kNone;
  }
  return request == ArmRequest::kArm ? refusal : StopCause::kNone;
}

StopCause MotionLoop::rearm_drive(MonoTime now) {
  if (latch_ == nullptr || mode_ == Mode::kDryRun) return StopCause::kNone;
  const auto rearmed = latch_->rearm(now);
  return rearmed ? StopCause::kNone : cause_of(rearmed.error());
}

hal::DriveFault MotionLoop::drive_fault() const {
  return latch_ == nullptr ? hal::DriveFault::kNone : latch_->fault();
}

void MotionLoop::disarm(StopCause latched) {
  armed_ = false;
  latched_ = latched;
  held_since_.reset();
}

hal::Twist MotionLoop::towards_goal(MonoTime now, MotionStatus& status) const {
  const hal::Twist goal = clamp(goal_->twist, parameters_);
  const double elapsed_s = to_seconds(elapsed_);
  hal::Twist next;
  next.forward_mps = behavior::ramp(commanded_.forward_mps, goal.forward_mps, parameters_.max_acceleration_mps2,
                                    parameters_.max_deceleration_mps2, elapsed_s);
  if (goal_->halt && goal.forward_mps == 0.0) next.forward_mps = 0.0;
  next.left_radps = behavior::ramp(commanded_.left_radps, goal.left_radps, parameters_.max_turn_acceleration_radps2,
                                   parameters_.max_turn_acceleration_radps2, elapsed_s);

  // What is said now holds until the next cycle.
  const double age_s = to_seconds(now - odometry_.stamp + kMotionPeriod);
  const double within = speed_within_area(next.forward_mps, odometry_, age_s, parameters_);
  status.keep_in_slowed = within != next.forward_mps;
  next.forward_mps = within;
  return next;
}

void MotionLoop::send(const hal::Twist& twist, MonoTime now, MotionStatus& status) {
  commanded_ = twist;
  if (mode_ == Mode::kDryRun) return;

  const auto sent = drive_->command(twist, now);
  status.sent = sent.has_value();
  send_failure_ = sent ? StopCause::kNone : cause_of(sent.error());
  if (sent) return;

  commanded_ = {};
  static_cast<void>(drive_->command({}, now));  // so that zero is the last thing that was tried
  status.cause = graver(send_failure_, status.cause);
  if (armed_) disarm(send_failure_);
}

}  // namespace cgsr
