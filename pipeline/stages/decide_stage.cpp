#include "pipeline/stages/decide_stage.h"

#include <utility>

#include "pipeline/stages/tasks.h"

namespace cgsr::stages {

namespace {

/// Nothing but the turn on the spot that the search of the whole map for the pose asks for; without a fresh one the robot stands.
Decision seek_pose(const runtime::Aged<PoseEstimate>& pose, const Requests& requests) {
  Decision decision;
  const PoseEstimate* const now = pose.within(kMaxPoseAge);
  decision.goal.left_radps = now != nullptr ? now->turn_radps : 0.0;
  decision.state = pose.value.anew ? "seek_new_pose" : "seek_first_pose";
  decision.requests = requests;
  return decision;
}

}  // namespace

Decision DecideStage::update(const ImageLease& image, const FrameResult& frame) {
  const MonoTime before = std::exchange(last_image_, image.stamp());
  const Duration elapsed = before == MonoTime{} ? Duration::zero() : image.stamp() - before;
  Decision decision = frame.pose.value.seeks_pose() ? seek_pose(frame.pose, task_->first_requests())
                                                    : task_->decide(frame, image.view(), elapsed);
  // A check whose stage faults does not hold a lamp for ever.
  if (const LampReport* const report = frame.lamp.within(kMaxLampReportAge)) {
    decision.requests.lamps[static_cast<std::size_t>(LampLine::kProbeLamp)] = report->requests_probe_lamp;
    decision.requests.lamps[static_cast<std::size_t>(LampLine::kRoomLamp)] = report->requests_room_lamp;
  }
  if (decision.state != state_) decision.events.add({"task", decision.state, decision.reason});
  state_ = decision.state;
  return decision;
}

}  // namespace cgsr::stages
