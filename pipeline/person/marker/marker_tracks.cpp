#include "pipeline/person/marker/marker_tracks.h"

#include <algorithm>
#include <cmath>

namespace cgsr::person {
namespace {

// From the middle of a marker on a chest to that of the face above it, in widths of the face.
constexpr double kFaceAbove = 2.2;

bool same_place(const Box& a, const Box& b) {
  const double dx = a.x + a.width / 2 - b.x - b.width / 2, dy = a.y + a.height / 2 - b.y - b.height / 2;
  return std::hypot(dx, dy) < 2.0 * std::max(a.width, b.width);
}

}  // namespace

MarkerTracks::MarkerTracks(const MarkerParameters& parameters)
    : parameters_(parameters), detector_(parameters.min_side_px, parameters.region) {}

// A marker that was not where it was expected is expected where its motion led to in the meantime, within the image.
void MarkerTracks::follow(Track& track, const ImageView& image, WorkBudget& budget) {
  if (track.reads == 0 || !budget.grant()) return;
  Box expected = track.last.box;
  expected.x = std::clamp(expected.x + track.right_px * (track.missed + 1), 0.0, double(image.width_px));
  expected.y = std::clamp(expected.y + track.down_px * (track.missed + 1), 0.0, double(image.height_px));
  if (const auto seen = detector_.find_near(image, expected, track.last.id)) {
    note(track, *seen);
  } else if (++track.missed >= parameters_.max_missed) {
    track = {};
  }
}

void MarkerTracks::note(Track& track, const SeenMarker& marker) const {
  const bool again = track.reads > 0 && track.last.id == marker.id && same_place(track.last.box, marker.box);
  const double images = track.missed + 1;
  track.right_px = again ? (marker.box.x - track.last.box.x) / images : 0.0;
  track.down_px = again ? (marker.box.y - track.last.box.y) / images : 0.0;
  track.reads = again ? std::min(track.reads + 1, parameters_.min_reads) : 1;
  track.missed = 0;
  track.last = marker;
  track.seen = true;
}

void MarkerTracks::look(const ImageView& image, WorkBudget& budget) {
  person_.seen = other_.seen = false;
  follow(person_, image, budget);
  if (person_.seen) {
    other_ = {};
    return;
  }
  follow(other_, image, budget);
  if (!budget.grant()) return;
  detector_.search(image, found_);
  for (const SeenMarker& marker : found_) {
    Track& track = marker.id == parameters_.id ? person_ : other_;
    if (!track.seen) note(track, marker);
  }
}

const MarkerTracks::Track* MarkerTracks::shown() const {
  const auto counts = [this](const Track& track) { return track.seen && track.reads >= parameters_.min_reads; };
  return counts(person_) ? &person_ : counts(other_) ? &other_ : nullptr;
}

std::optional<SeenMarker> MarkerTracks::seen() const {
  const Track* track = shown();
  return track == nullptr ? std::nullopt : std::optional(track->last);
}

std::optional<MarkerSighting> MarkerTracks::sighting() const {
  const Track* track = shown();
  if (track == nullptr) return std::nullopt;
  const Box& box = track->last.box;
  // Turned away the square is narrower, not lower.
  const double face_px = std::max(box.width, box.height) / parameters_.side_per_face;
  const double x = box.x + box.width / 2, y = box.y + box.height / 2 - kFaceAbove * face_px;
  MarkerSighting sighting{
      box, {x - face_px / 2, y - face_px / 2, face_px, face_px}, std::nullopt, track->last.confidence};
  if (track == &person_) sighting.person = parameters_.number;
  return sighting;
}

}  // namespace cgsr::person
