#include "src/commands/track_run.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "platform/count_marks.h"

namespace cgsr::app {
namespace {

std::string csv_row(std::uint64_t frame, const color::TrackedObject& object) {
  if (!object.found) return fmt::format("{},0,,,,,,,,,", frame);
  return fmt::format("{},1,{:.2f},{:.2f},{:.2f},{:.2f},{:.5f},{:.3f},{:.3f},{:.3f},{}", frame, object.box.x,
                     object.box.y, object.box.width, object.box.height, object.divergence, object.exact_light.r,
                     object.exact_light.g, object.exact_light.b,
                     object.confidence > 0.0 ? fmt::format("{:.3f}", object.confidence) : "");
}

}  // namespace

TrackRun::TrackRun(Session session, color::ColorModel model, stages::ColorLoop loop, std::uint64_t first_frame)
    : session_(std::move(session)), model_(std::move(model)), loop_(std::move(loop)), frame_(first_frame) {}

Result<void> TrackRun::begin_with(const ImageLease& image, const Box& box) {
  loop_.place(image.view(), box);
  color::TrackedObject known{true, box, 0.0, {}, {}, 0.0};
  if (!model_.samples.empty()) known.light = model_.samples.front().light;
  return keep(image, known);
}

Result<void> TrackRun::track(const ImageLease& image) {
  const color::TrackedObject object = loop_.track(image.view());
  count_image_end();
  ++asked_;
  found_ += object.found ? 1 : 0;
  return keep(image, object);
}

Result<void> TrackRun::miss() {
  ++asked_;
  note_change(false);
  return write_row({});
}

Result<void> TrackRun::finish() {
  return session_.video ? session_.video->close() : Result<void>{};
}

Result<void> TrackRun::check_truth(const std::string& path) const {
  return session_.truth ? check_length(path, *session_.truth, frame_) : Result<void>{};
}

std::optional<Score> TrackRun::score(std::uint64_t first_answer) const {
  if (!session_.truth) return std::nullopt;
  const std::size_t seen = std::min(session_.truth->size(), boxes_.size());
  return app::score(boxes_, Boxes(session_.truth->begin(), session_.truth->begin() + static_cast<std::ptrdiff_t>(seen)),
                    static_cast<int>(first_answer));
}

void TrackRun::note_change(bool found) {
  if (seen_ && found != found_last_) (found ? reacquisitions_ : losses_).push_back(frame_);
  seen_ = seen_ || found;
  found_last_ = found;
}

Result<void> TrackRun::keep(const ImageLease& image, const color::TrackedObject& object) {
  note_change(object.found);
  const auto light = object.found ? std::optional(object.light) : std::nullopt;
  const auto plurality = history_.add(image.stamp(), light);
  if (session_.video) {
    if (auto drawn = draw(image, object, plurality); !drawn) return drawn;
  }
  return write_row(object);
}

Result<void> TrackRun::draw(const ImageLease& image, const color::TrackedObject& object,
                            const std::optional<color::Light>& plurality) {
  OverlayFacts facts;
  facts.image_number = frame_;
  if (object.found) {
    facts.box = object.box;
    facts.light = object.exact_light;
  }
  facts.plurality = plurality;
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
