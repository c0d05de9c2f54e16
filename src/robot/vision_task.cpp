#include "src/robot/vision_task.h"

#include <utility>

namespace cgsr::robot {

bool VisionTask::step() {
  auto image = links_.images.pop_newest();
  if (!image) return false;
  const MonoTime started = clock_.now();
  while (const auto odometry = links_.odometry.pop()) loop_.heard(*odometry);
  while (const auto answer = links_.switch_answers.pop()) loop_.heard(*answer);
  runner_.begin_frame({image->stamp(), image->sequence(), true});
  const Decision decision = loop_.on_image(*image);
  // A goal that finds no room is lost: the newest one is what counts, and without any the dead-man stops the robot.
  static_cast<void>(
      links_.goals.push(Goal{{decision.goal.forward_mps, decision.goal.left_radps}, image->stamp(), decision.halt}));
  ask_for_switchings();
  in_time_.dealt_with(image->sequence(), started, clock_.now());
  links_.images_in_time.store(in_time_.enough(), std::memory_order_relaxed);
  report(decision, std::move(*image));
  return true;
}

// A request that finds no room gets no answer, and the line counts as silent.
void VisionTask::ask_for_switchings() {
  while (const auto request = loop_.next_switching()) {
    static_cast<void>(links_.switch_requests.push(SwitchRequest(*request)));
  }
}

void VisionTask::step_without_image(MonoTime now) {
  runner_.begin_frame({now, 0, false});
  in_time_.missed();
  links_.images_in_time.store(in_time_.enough(), std::memory_order_relaxed);
  links_.reports.push(VisionReport{{}, runner_.end_frame()});
}

void VisionTask::report(const Decision& decision, ImageLease image) {
  const auto& record = runner_.end_frame();
  links_.pictures.push(std::move(image));
  links_.reports.push(VisionReport{decision, record});
}

}  // namespace cgsr::robot
