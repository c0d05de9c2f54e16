#include "pipeline/stages/decide_stage.h"

#include <utility>

#include "pipeline/stages/tasks.h"

namespace cgsr::stages {

Decision DecideStage::update(const ImageLease& image, const FrameResult& frame) {
  const MonoTime before = std::exchange(last_image_, image.stamp());
  const Duration elapsed = before == MonoTime{} ? Duration::zero() : image.stamp() - before;
  Decision decision = task_->decide(frame, image.view(), elapsed);
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
