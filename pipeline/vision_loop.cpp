#include "pipeline/vision_loop.h"

#include <utility>

namespace cgsr {

Decision VisionLoop::on_image(const ImageLease& image) {
  const auto& view = runner_.run(decode_, image);
  const auto& matches = runner_.run(search_, view);  // chapter 3, Alg. 3.2
  const auto& object = runner_.run(track_, image, view, matches);
  return runner_.run(decide_, image, object);
}

VisionLoop::VisionLoop(runtime::StageRunner& runner, color::Tracker tracker, behavior::Follow follow,
                       const Pinhole& camera, int max_width_px, int max_height_px)
    : runner_(runner),
      tracker_(std::move(tracker)),
      follow_(follow),
      camera_(camera),
      reduced_(max_width_px, max_height_px),
      decode_("decode", [this](const ImageLease& image) { return decode(image); }),
      search_("search", [this](WorkBudget& budget, const View& view) { return search(budget, view); }),
      track_("track", [this](WorkBudget& budget, const ImageLease& image, const View& view,
                             const color::SearchResult& matches) { return track(budget, image, view, matches); }),
      decide_("decide", [this](const ImageLease& image, const runtime::Aged<color::TrackedObject>& object) {
        return decide(image, object);
      }) {}

VisionLoop::View VisionLoop::decode(const ImageLease& image) {
  const ImageView& view = image.view();
  const int factor = tracker_.reduction(view.width_px, view.height_px);
  if (!imaging::reduce(view, factor, tracker_.labels(), reduced_)) return {};
  return {&reduced_};
}

color::SearchResult VisionLoop::search(WorkBudget& budget, const View& view) {
  if (view.reduced == nullptr) return {};
  return tracker_.search(*view.reduced, budget);
}

color::TrackedObject VisionLoop::track(WorkBudget& budget, const ImageLease& image, const View& view,
                                       const color::SearchResult& matches) {
  if (view.reduced == nullptr) return {};
  return tracker_.track(image.view(), *view.reduced, matches, budget);
}

Decision VisionLoop::decide(const ImageLease& image, const runtime::Aged<color::TrackedObject>& object) {
  const ImageView& view = image.view();
  const Duration elapsed = last_image_ == MonoTime{} ? Duration::zero() : image.stamp() - last_image_;
  last_image_ = image.stamp();
  const behavior::Sighting sighting{object.value.found, object.value.box, object.age,   view.width_px,
                                    view.height_px,     camera_.fx_px,    camera_.cx_px};
  return {follow_.decide(sighting, elapsed), object.value, object.age};
}

}  // namespace cgsr
