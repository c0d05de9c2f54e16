#include "pipeline/person/tracking/shirt_classifier.h"

#include <cstddef>
#include <utility>

namespace cgsr::person {
namespace {

constexpr int kFactor = 2;  // shirts are sought at 320x240 (6.2.2)

}  // namespace

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
  return Classification{order[largest->label - std::size_t{1}], parameters_.confidence};
}

void ShirtClassifier::learn(const PersonImage& input, const FaceSighting& face) {
  const SamplingRegions regions = sampling_regions(face.box);
  auto background = region_colors(input.image, regions.background[0]);
  const auto right = region_colors(input.image, regions.background[1]);
  background.insert(background.end(), right.begin(), right.end());
  colors_.learn(*face.match.label, region_colors(input.image, regions.shirt), background);
  map_is_due_ = true;
}

void ShirtClassifier::train(Label label, std::optional<Label>) {
  if (!last_.face || last_.face->match.label != label || !colors_.knows(label)) return;
  learn(last_, *last_.face);
}

void ShirtClassifier::observe_face(const PersonImage& input, const FaceSighting& face) {
  seen_images_ = face.match.label && face.match.label == seen_ ? seen_images_ + 1 : 1;
  seen_ = face.match.label;
  if (!seen_) return;
  last_face_ = face.box;
  if (!colors_.knows(*seen_) && seen_images_ >= parameters_.images_to_learn) learn(input, face);
}

void ShirtClassifier::forget(Label person) {
  colors_.forget(person);
  map_is_due_ = true;
  if (seen_ == person) seen_.reset();
}

}  // namespace cgsr::person
