#include "src/tasks/vision_task.h"

#include <utility>

namespace cgsr::tasks {

using stages::LampLine;

bool VisionTask::step() {
  auto image = links_.images.pop_newest();
  if (!image) return false;
  const MonoTime started = clock_.now();
  const stages::FrameInputs inputs = inputs_at(image->stamp());
  runner_.begin_frame({image->stamp(), image->sequence(), true});
  const stages::FrameResult& result = loop_.on_image(*image, inputs);
  const stages::Decision& decision = result.decision.value;
  // A goal that finds no room is lost: the newest one is what counts, and without any the dead-man stops the robot.
  static_cast<void>(
      links_.goals.push(Goal{{decision.goal.forward_mps, decision.goal.left_radps}, image->stamp(), decision.halt}));
  request_switching(decision.requests, image->stamp());
  in_time_.dealt_with(image->sequence(), started, clock_.now());
  links_.images_in_time.store(in_time_.enough(), std::memory_order_relaxed);
  report(result, std::move(*image));
  return true;
}

stages::FrameInputs VisionTask::inputs_at(MonoTime stamp) {
  while (const auto odometry = links_.odometry.pop()) surroundings_.odometry.add(*odometry);
  while (const auto answer = links_.switch_answers.pop()) surroundings_.switchboard.on_answer(*answer);
  stages::FrameInputs inputs;
  inputs.odometry = surroundings_.odometry.at(stamp);
  for (std::size_t i = 0; i < inputs.lamps.size(); ++i) {
    inputs.lamps[i] = surroundings_.switchboard.state(static_cast<LampLine>(i), stamp);
  }
  inputs.requests = loop_.requests();
  return inputs;
}

// A request that finds no room gets no answer, and the line counts as silent.
void VisionTask::request_switching(const stages::Requests& requests, MonoTime stamp) {
  for (std::size_t i = 0; i < requests.lamps.size(); ++i) {
    surroundings_.switchboard.want(static_cast<LampLine>(i), requests.lamps[i]);
  }
  while (const auto request = surroundings_.switchboard.next(stamp)) {
    static_cast<void>(links_.switch_requests.push(stages::SwitchRequest(*request)));
  }
}

void VisionTask::step_without_image(MonoTime now) {
  runner_.begin_frame({now, 0, false});
  in_time_.missed();
  links_.images_in_time.store(in_time_.enough(), std::memory_order_relaxed);
  sinks::VisionReport report;
  report.record = runner_.end_frame();
  links_.reports.push(std::move(report));
}

void VisionTask::report(const stages::FrameResult& result, ImageLease image) {
  const auto& record = runner_.end_frame();
  links_.pictures.push(sinks::Picture{std::move(image), result.shade.value.masks});
  sinks::VisionReport report{result, record};
  report.frame.view.value = {};
  report.frame.shade.value.masks = {};
  report.frame.shade.value.volumes = {};
  links_.reports.push(std::move(report));
}

}  // namespace cgsr::tasks
