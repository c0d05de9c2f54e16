#include "pipeline/vision_loop.h"

namespace cgsr {

using namespace stages;

const FrameResult& VisionLoop::on_image(const ImageLease& image, const FrameInputs& inputs) {
  const ImageView& pixels = image.view();
  frame_.odometry = inputs.odometry;
  frame_.view = run<DecodeStage>(pixels);
  frame_.pose = run<LocalizeStage>(pixels, frame_.view, inputs.odometry);              // chapter 4
  frame_.lamp = run<ProbesStage>(pixels, frame_.pose, inputs.lamps, inputs.requests);  // 5.1
  frame_.shade = run<ShadeStage>(frame_.pose, frame_.lamp);                            // 5.2
  frame_.matches = run<SearchStage>(frame_.view, frame_.objects);                      // chapter 3, Alg. 3.2
  frame_.objects = run<TrackStage>(pixels, frame_.view, frame_.matches, frame_.shade, inputs.requests);  // and 5.3
  frame_.people = run<IdentifyStage>(pixels, inputs.requests);                                           // chapter 6
  frame_.decision = run<DecideStage>(image, frame_);  // motion goal, and requests for the next image
  return frame_;
}

Requests VisionLoop::requests() {
  if (frame_.decision.ever()) return frame_.decision.value.requests;
  const DecideStage* const decide = worker<DecideStage>();
  return decide != nullptr ? decide->first_requests() : Requests{};
}

}  // namespace cgsr
