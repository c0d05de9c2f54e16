#include "tools/lab/ours.h"

#include <array>
#include <optional>

#include "pipeline/stages/color_stages.h"

namespace cgsr::lab {
namespace {

/// A tracker of ours without a calibrated confidence is sure of what it finds.
template <class Object>
double confidence_of(const Object& object) {
  if constexpr (requires { object.confidence; }) {
    return object.confidence;
  } else {
    return object.found ? 1.0 : 0.0;
  }
}

class OurTracker final : public BoxTracker {
 public:
  OurTracker(const config::Color& configuration, Start start) : configuration_(configuration), start_(start) {}

  Result<LearnedObject> learn(const Image& image, const Box& box) override {
    const std::array samples{color::Sample{image.view(), box}};
    const auto learned = color::learn(samples, configuration_.learn);
    if (!learned) return tl::unexpected(learned.error());
    auto loop = stages::ColorLoop::make(learned->model, configuration_.track, image.bgr.cols, image.bgr.rows);
    if (!loop) return tl::unexpected(loop.error());
    loop_ = std::move(*loop);
    const LearnedObject object{learned->model.samples.front().light, learned->model.distinctiveness};
    if (start_ == Start::kAnywhere) return object;
    if (!loop_->place(image.view(), box)) return fail("the image is none that can be reduced");
    return object;
  }

  Sighting track(const Image& image) override {
    const color::TrackedObject object = loop_->track(image.view());
    if (!object.found) return {{}, {}, {}, 0.0, confidence_of(object)};
    return {object.box, object.light, object.exact_light, object.divergence, confidence_of(object)};
  }

 private:
  config::Color configuration_;
  Start start_;
  std::optional<stages::ColorLoop> loop_;
};

}  // namespace

std::unique_ptr<BoxTracker> make_ours(const config::Color& configuration, Start start) {
  return std::make_unique<OurTracker>(configuration, start);
}

std::unique_ptr<BoxTracker> make_plain(const config::Color& configuration, Start start) {
  config::Color plain = configuration;
  plain.track.mode = color::TrackMode::kPlain;
  return std::make_unique<OurTracker>(plain, start);
}

}  // namespace cgsr::lab
