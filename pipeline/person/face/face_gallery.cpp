#include "pipeline/person/face/face_gallery.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace cgsr::person {
namespace {

constexpr std::size_t kEnoughOthers = 4, kHardlyAny = 2;

using PointDistances = std::array<double, kViewSide * kViewSide>;

// What matches nobody, as hair or a reflection in glasses, is left out.
double mean_of_nearest(PointDistances points) {
  constexpr double kCounted = 0.95;
  const auto counted = static_cast<std::ptrdiff_t>(kCounted * points.size());
  std::nth_element(points.begin(), points.begin() + counted, points.end());
  return std::accumulate(points.begin(), points.begin() + counted, 0.0) / static_cast<double>(counted);
}

/// How far a face is from a person.
struct Away {
  double distance = 1.0;
  FaceAlignment alignment;  // against the nearest view
};

Away from(const FaceDescriptor& face, std::span<const FaceView> enrolled, std::span<const FaceView> learned) {
  Away away;
  PointDistances nearest{}, one{};
  nearest.fill(1.0);
  double nearest_view = std::numeric_limits<double>::infinity();
  const auto compare = [&](const FaceView& view) {
    const FaceAlignment alignment = view_distances(face, view, one);
    if (const double distance = mean_of_nearest(one); distance < nearest_view) {
      nearest_view = distance;
      away.alignment = alignment;
    }
    for (std::size_t i = 0; i < nearest.size(); ++i) nearest[i] = std::min(nearest[i], one[i]);
  };
  std::ranges::for_each(enrolled, compare);
  std::ranges::for_each(learned, compare);
  away.distance = mean_of_nearest(nearest);
  return away;
}

}  // namespace

double FaceGallery::distance(const FaceDescriptor& face, const FaceView& view) {
  PointDistances points{};
  view_distances(face, view, points);
  return mean_of_nearest(points);
}

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

// Comparing all of a thousand people would take seconds.
std::vector<FaceGallery::People::const_iterator> FaceGallery::candidates(const FaceDescriptor& face,
                                                                         std::optional<Label> without,
                                                                         const LearnedViews& learned) const {
  constexpr std::size_t kMost = 16;
  std::vector<People::const_iterator> all;
  for (auto person = people_.begin(); person != people_.end(); ++person) {
    if (person->first == without || person->second.size() < static_cast<std::size_t>(parameters_.min_views)) continue;
    all.push_back(person);
  }
  if (all.size() <= kMost) return all;
  std::vector<std::pair<std::int64_t, People::const_iterator>> ranked;
  for (const auto& person : all) {
    std::int64_t most = 0;
    for (const FaceView& view : person->second) most = std::max(most, rough_likeness(face, view));
    if (person->first == learned.person)
      for (const FaceView& view : learned.views) most = std::max(most, rough_likeness(face, view));
    ranked.emplace_back(most, person);
  }
  std::ranges::stable_sort(ranked, std::ranges::greater(), [](const auto& one) { return one.first; });
  all.resize(kMost);
  for (std::size_t i = 0; i < kMost; ++i) all[i] = ranked[i].second;
  return all;
}

FaceMatch FaceGallery::identify(const FaceDescriptor& face, std::optional<Label> without,
                                const LearnedViews& learned) const {
  FaceMatch match;
  if (face.dense.empty()) return match;
  double second = 1.0;
  std::size_t compared = 0;
  for (const auto& candidate : candidates(face, without, learned)) {
    const auto& [person, views] = *candidate;
    ++compared;
    const Away away = from(face, views, person == learned.person ? learned.views : std::span<const FaceView>());
    match.alignment.move_towards(away.alignment, 1.0 / static_cast<double>(compared));
    if (away.distance < match.distance) {
      second = match.distance;
      match.distance = away.distance;
      match.nearest = person;
    } else {
      second = std::min(second, away.distance);
    }
  }
  const double lead = second - match.distance;
  if (compared <= kEnoughOthers) second = std::min(second, parameters_.typical_stranger);
  if (compared <= kHardlyAny) second = std::min(second, parameters_.nearest_stranger);
  match.margin = match.nearest ? second - match.distance : -1.0;
  if (match.margin > parameters_.min_margin) match.label = match.nearest;
  const double scale = std::max(parameters_.min_margin, 1e-6);
  match.confidence = 1.0 - 0.5 * std::exp(-std::abs(match.margin - parameters_.min_margin) / scale);
  // The margin of everybody else is below -lead.
  if (compared > 1) match.rules_out = 1.0 - 0.5 * std::exp(-(lead + parameters_.min_margin) / scale);
  return match;
}

}  // namespace cgsr::person
