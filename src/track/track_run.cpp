#include "src/track/track_run.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "platform/count_marks.h"

namespace cgsr::app {
namespace {

std::string csv_row(std::uint64_t frame, const color::TrackedObject& object) {
  if (!object.found) return fmt::format("{},0,,,,,,,,", frame);
  return fmt::format("{},1,{:.2f},{:.2f},{:.2f},{:.2f},{:.5f},{:.3f},{:.3f},{:.3f}", frame, object.box.x, object.box.y,
                     object.box.width, object.box.height, object.divergence, object.light.r, object.light.g,
                     object.light.b);
}

}  // namespace

TrackRun::TrackRun(Session session, color::ColorModel model, color::Tracker tracker, std::uint64_t first_frame)
    : session_(std::move(session)),
      model_(std::move(model)),
      tracker_(std::move(tracker)),
      reduced_(session_.input->mode().width_px, session_.input->mode().height_px),
      frame_(first_frame) {}

Result<void> TrackRun::begin_with(const ImageLease& image, const Box& box) {
  const auto& view = image.view();
  const int factor = tracker_.reduction(view.width_px, view.height_px);
  if (imaging::reduce(view, factor, tracker_.labels(), reduced_)) tracker_.place(view, reduced_, box);
  color::TrackedObject known{true, box, 0.0, {}, {}};
  if (!model_.samples.empty()) known.light = model_.samples.front().light;
  return keep(image, known);
}

Result<void> TrackRun::track(const ImageLease& image) {
  const color::TrackedObject object = look(image.view());
  ++asked_;
  found_ += object.found ? 1 : 0;
  return keep(image, object);
}

Result<void> TrackRun::miss() {
  ++asked_;
  return write_row({});
}

Result<void> TrackRun::finish() {
  return session_.video ? session_.video->close() : Result<void>{};
}

std::optional<Score> TrackRun::score(std::uint64_t first_answer) const {
  if (!session_.truth) return std::nullopt;
  const std::size_t seen = std::min(session_.truth->size(), boxes_.size());
  return app::score(boxes_, Boxes(session_.truth->begin(), session_.truth->begin() + static_cast<std::ptrdiff_t>(seen)),
                    static_cast<int>(first_answer));
}

// The stages of an image, between the marks that tools/count counts by.
color::TrackedObject TrackRun::look(const ImageView& view) {
  count_stage_begin();
  const auto outcome =
      imaging::reduce(view, tracker_.reduction(view.width_px, view.height_px), tracker_.labels(), reduced_);
  count_stage_end("decode");
  color::TrackedObject object;
  if (outcome) {
    UnlimitedBudget unlimited;
    count_stage_begin();
    const color::SearchResult matches = tracker_.search(reduced_, unlimited);
    count_stage_end("search");
    count_stage_begin();
    object = tracker_.track(view, reduced_, matches, unlimited);
    count_stage_end("track");
  }
  count_image_end();
  return object;
}

Result<void> TrackRun::keep(const ImageLease& image, const color::TrackedObject& object) {
  const auto light = object.found ? std::optional(object.light) : std::nullopt;
  const auto plurality = history_.add(image.stamp(), light);
  if (session_.video) {
    if (auto drawn = draw(image, object, plurality); !drawn) return drawn;
  }
  return write_row(object);
}

Result<void> TrackRun::draw(const ImageLease& image, const color::TrackedObject& object,
                            const std::optional<color::Light>& light) {
  OverlayFacts facts;
  facts.image_number = frame_;
  if (object.found) facts.box = object.box;
  facts.light = light;
  facts.divergence = object.divergence;
  if (session_.truth && frame_ < session_.truth->size()) facts.truth = (*session_.truth)[frame_];
  return session_.video->add(session_.overlay->draw(image.view(), facts));
}

Result<void> TrackRun::write_row(const color::TrackedObject& object) {
  boxes_.resize(frame_ + 1);
  if (object.found) boxes_[frame_] = object.box;
  const std::string row = csv_row(frame_, object);
  ++frame_;
  return session_.csv ? session_.csv->add_line(row) : Result<void>{};
}

}  // namespace cgsr::app
