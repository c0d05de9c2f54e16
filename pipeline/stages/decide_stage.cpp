#include "pipeline/stages/decide_stage.h"

#include <utility>

namespace cgsr::stages {

Decision DecideStage::update(const ImageLease& image, const FrameResult& frame) {
  const MonoTime before = std::exchange(last_image_, image.stamp());
  const Duration elapsed = before == MonoTime{} ? Duration::zero() : image.stamp() - before;
  Decision decision = task_->decide(frame, image.view(), elapsed);
  if (frame.lamp.ever()) {
    decision.requests.lamps[static_cast<std::size_t>(LampLine::kProbeLamp)] = frame.lamp.value.requests_probe_lamp;
    decision.requests.lamps[static_cast<std::size_t>(LampLine::kRoomLamp)] = frame.lamp.value.requests_room_lamp;
  }
  return decision;
}

}  // namespace cgsr::stages
