#include "pipeline/person/tracking/shirt_classifier.h"

#include <cstddef>
#include <utility>

namespace cgsr::person {
namespace {

constexpr int kFactor = 2;  // shirts are sought at 320x240 (6.2.2)

// A marker that is turned away teaches nothing: beside a narrow shirt there is background where the shirt is expected.
bool is_facing(const MarkerSighting& marker) {
  constexpr double kMinWidth = 0.7;  // of its height: turned by less than 45 degrees
  return marker.box.width >= kMinWidth * marker.box.height;
}

// Colours that are found beside the marker, or in a part of the shirt alone, are no longer those of the shirt (relative position and size may issue a
// re-training, 6.3.1).
bool lies_under(const Box& shirt, const MarkerSighting& marker) {
  constexpr double kMinShare = 0.5;  // of where it would be sampled
  const Box expected = sampling_regions(marker).shirt;
  return intersection(shirt, expected).area() >= kMinShare * expected.area();
}

}  // namespace

SamplingRegions sampling_regions(const MarkerSighting& marker) {
  constexpr double kMargin = 0.3;  // below the black square, in sides of it: a white cell and some more
  constexpr double kHeight = 0.8;  // in widths of the face: the shirt does not go on much farther
  SamplingRegions regions = sampling_regions(marker.face);
  regions.shirt = {marker.face.x, marker.box.y + (1.0 + kMargin) * marker.box.height, marker.face.width,
                   kHeight * marker.face.width};
  return regions;
}

ShirtClassifier::ShirtClassifier(const ShirtParameters& parameters)
    : parameters_(parameters),
      colors_(parameters.colors),
      map_(imaging::kColorCodes, 0),
      reduced_(parameters.max_width_px, parameters.max_height_px) {
  colors_.make_map({}, map_);
}

bool ShirtClassifier::is_plausible(const Box& shirt, double area_px2) const {
  if (!last_face_) return false;
  return area_px2 >= parameters_.min_area * last_face_->area() &&
         shirt.width <= parameters_.max_width * last_face_->width;
}

std::optional<Classification> ShirtClassifier::classify(const PersonImage& input) {
  last_ = input;
  box_ = {};
  // Not in the image in which something was learned: there faces were looked for as well.
  if (map_is_due_) colors_.make_map({}, map_);
  map_is_due_ = false;
  if (colors_.people() == 0 || !imaging::reduce(input.image, kFactor, map_, reduced_)) return std::nullopt;
  const auto order = colors_.order();
  const auto pixels = static_cast<std::size_t>(reduced_.width_px) * static_cast<std::size_t>(reduced_.height_px);
  const auto found = blobs_.largest({reduced_.labels.data(), pixels}, reduced_.width_px, reduced_.height_px,
                                    static_cast<std::uint16_t>(order.size()));
  const Blob* largest = nullptr;
  for (const Blob& blob : found) {
    const Box box{blob.box.x * kFactor, blob.box.y * kFactor, blob.box.width * kFactor, blob.box.height * kFactor};
    if (!is_plausible(box, double(blob.area_px) * kFactor * kFactor)) continue;
    const auto rank = [&](const Blob& one) {
      return std::pair(input.interest && order[one.label - std::size_t{1}] == *input.interest, one.area_px);
    };
    if (largest != nullptr && rank(blob) <= rank(*largest)) continue;
    largest = &blob;
    box_ = box;
  }
  if (largest == nullptr) return std::nullopt;
  const Label person = order[largest->label - std::size_t{1}];
  const auto& marker = input.marker;
  if (marker && marker->person == person && is_facing(*marker) && !lies_under(box_, *marker)) return std::nullopt;
  return Classification{person, parameters_.confidence};
}

// The person's marker before a face; of two strangers either will do.
std::optional<ShirtClassifier::Teacher> ShirtClassifier::teacher_of(const PersonImage& input) {
  const auto& [image, face, interest, marker] = input;
  if (marker && is_facing(*marker) && (marker->person || !face))
    return Teacher{marker->person, marker->face, sampling_regions(*marker)};
  if (face) return Teacher{face->match.label, face->box, sampling_regions(face->box)};
  return std::nullopt;
}

void ShirtClassifier::learn(const PersonImage& input, const Teacher& teacher) {
  const SamplingRegions& regions = teacher.regions;
  auto background = region_colors(input.image, regions.background[0]);
  const auto right = region_colors(input.image, regions.background[1]);
  background.insert(background.end(), right.begin(), right.end());
  colors_.learn(*teacher.person, region_colors(input.image, regions.shirt), background);
  map_is_due_ = true;
}

void ShirtClassifier::train(Label label, std::optional<Label>) {
  const auto teacher = teacher_of(last_);
  if (teacher && teacher->person == label && colors_.knows(label)) learn(last_, *teacher);
}

void ShirtClassifier::observe(const PersonImage& input) {
  const auto teacher = teacher_of(input);
  if (!teacher) return;
  seen_images_ = teacher->person && teacher->person == seen_ ? seen_images_ + 1 : 1;
  seen_ = teacher->person;
  if (!seen_) return;
  last_face_ = teacher->face;
  if (!colors_.knows(*seen_) && seen_images_ >= parameters_.images_to_learn) learn(input, *teacher);
}

void ShirtClassifier::forget(Label person) {
  colors_.forget(person);
  map_is_due_ = true;
  if (seen_ == person) seen_.reset();
}

}  // namespace cgsr::person
