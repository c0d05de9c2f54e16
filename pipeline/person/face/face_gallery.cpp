#include "pipeline/person/face/face_gallery.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cgsr::person {
namespace {

constexpr std::size_t kEnoughOthers = 4;

using PointDistances = std::array<double, kViewSide * kViewSide>;

/// How far a face is from a person.
struct Away {
  double distance = 1.0;
  FaceAlignment alignment;  // against the nearest view
};

// Hair, glasses and background, which match nobody, are left out.
double mean_of_nearest(PointDistances points) {
  constexpr double kCounted = 0.8;
  const auto counted = static_cast<std::ptrdiff_t>(kCounted * points.size());
  std::nth_element(points.begin(), points.begin() + counted, points.end());
  return std::accumulate(points.begin(), points.begin() + counted, 0.0) / static_cast<double>(counted);
}

Away from(const FaceDescriptor& face, const std::vector<FaceView>& views) {
  Away away;
  PointDistances nearest{}, one{};
  nearest.fill(1.0);
  double nearest_view = std::numeric_limits<double>::infinity();
  for (const FaceView& view : views) {
    const FaceAlignment alignment = view_distances(face, view, one);
    if (const double distance = mean_of_nearest(one); distance < nearest_view) {
      nearest_view = distance;
      away.alignment = alignment;
    }
    for (std::size_t i = 0; i < nearest.size(); ++i) nearest[i] = std::min(nearest[i], one[i]);
  }
  away.distance = mean_of_nearest(nearest);
  return away;
}

}  // namespace

void FaceGallery::enroll(Label person, const FaceView& view) {
  auto& views = people_[person];
  if (views.size() >= static_cast<std::size_t>(parameters_.max_views)) {
    views.erase(views.begin() + (views.size() > 1 ? 1 : 0));
  }
  views.push_back(view);
}

const std::vector<FaceView>* FaceGallery::views_of(Label person) const {
  const auto found = people_.find(person);
  return found == people_.end() ? nullptr : &found->second;
}

FaceMatch FaceGallery::identify(const FaceDescriptor& face, std::optional<Label> without) const {
  FaceMatch match;
  if (face.dense.empty()) return match;
  double second = 1.0;
  std::size_t compared = 0;
  for (const auto& [person, views] : people_) {
    if (person == without || views.size() < static_cast<std::size_t>(parameters_.min_views)) continue;
    ++compared;
    const Away away = from(face, views);
    match.alignment.move_towards(away.alignment, 1.0 / static_cast<double>(compared));
    if (away.distance < match.distance) {
      second = match.distance;
      match.distance = away.distance;
      match.nearest = person;
    } else {
      second = std::min(second, away.distance);
    }
  }
  if (compared <= kEnoughOthers) second = std::min(second, parameters_.typical_stranger);
  match.margin = match.nearest ? second - match.distance : -1.0;
  if (match.margin > parameters_.min_margin) match.label = match.nearest;
  const double scale = std::max(parameters_.min_margin, 1e-6);
  match.confidence = 1.0 - 0.5 * std::exp(-std::abs(match.margin - parameters_.min_margin) / scale);
  return match;
}

}  // namespace cgsr::person
