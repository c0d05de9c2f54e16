#include "src/tasks/motion_task.h"

namespace cgsr::tasks {

void MotionTask::step(MonoTime now) {
  MotionInputs inputs;
  inputs.goal = newest_goal(now);
  inputs.images_in_time = links_.images_in_time.load(std::memory_order_relaxed);
  inputs.safety_chain_ok = links_.motion_stop.look() == 0 && !links_.arming_report.is_old(now);
  inputs.stop = stop_.requested();
  if (const auto request = links_.arm_requests.pop()) {
    inputs.request = *request;
    arm_ = false;  // the switch has spoken
  } else if (arm_) {
    inputs.request = ArmRequest::kArm;
  }
  const MotionStatus status = loop_.step(now, inputs);
  if (status.armed) arm_ = false;
  links_.odometry.push(status.odometry);
  links_.motions.push(status);
}

std::optional<Goal> MotionTask::newest_goal(MonoTime now) {
  std::optional<Goal> newest;
  for (;;) {
    if (!on_its_way_) on_its_way_ = links_.goals.pop();
    if (!on_its_way_ || on_its_way_->stamp + latency_ > now) return newest;
    newest = on_its_way_;
    on_its_way_.reset();
  }
}

}  // namespace cgsr::tasks
