#include "pipeline/person/tracking/face_color_classifier.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cgsr::person {
namespace {

constexpr int kFactor = ColorLabels::kFactor;
constexpr int kMaxUnseen = 3;  // images

// The detector's box holds eyes, nose and mouth; the hair is above it.
Box with_hair(const Box& face) {
  constexpr double kHair = 0.3;  // of the box's height
  return {face.x, face.y - kHair * face.height, face.width, (1.0 + kHair) * face.height};
}

// What is surely the head's: the middle of the face, and of the hair above it. In the corners of both boxes is background.
std::vector<imaging::Rgb> head_colors(const ImageView& image, const Box& face) {
  auto colors = region_colors(
      image, {face.x + 0.2 * face.width, face.y + 0.1 * face.height, 0.6 * face.width, 0.8 * face.height});
  const auto hair = region_colors(
      image, {face.x + 0.3 * face.width, face.y - 0.15 * face.height, 0.4 * face.width, 0.2 * face.height});
  colors.insert(colors.end(), hair.begin(), hair.end());
  return colors;
}

// What is surely not: shirt, and what is beside and above the head.
std::vector<imaging::Rgb> other_colors(const ImageView& image, const Box& face) {
  const SamplingRegions regions = sampling_regions(face);
  const Box above{face.x - 0.5 * face.width, face.y - 1.1 * face.height, 2.0 * face.width, 0.5 * face.height};
  std::vector<imaging::Rgb> all;
  for (const Box& region : {regions.shirt, regions.background[0], regions.background[1], above}) {
    const auto colors = region_colors(image, region);
    all.insert(all.end(), colors.begin(), colors.end());
  }
  return all;
}

}  // namespace

FaceColorClassifier::FaceColorClassifier(ColorLabels& labels, const FaceColorParameters& parameters)
    : parameters_(parameters), labels_(labels), colors_(parameters.colors), map_(imaging::kColorCodes, 0) {
  prepare();
}

bool FaceColorClassifier::prepare() {
  if (!map_is_due_) return false;
  colors_.make_map({}, map_);
  labels_.set(ColorPart::kHead, map_);
  map_is_due_ = false;
  return true;
}

std::optional<PersonHead> FaceColorClassifier::head() const {
  return head_ && unseen_ <= kMaxUnseen ? head_ : std::nullopt;
}

std::optional<Classification> FaceColorClassifier::classify(const PersonImage& input) {
  last_ = input;
  ++unseen_, ++unconfirmed_;
  if (since_trained_ > 0) ++since_trained_;
  const LabelImage image = labels_.of(ColorPart::kHead);
  const bool old = !head_ || unconfirmed_ > parameters_.max_images || unseen_ > kMaxUnseen + 1;
  if (!parameters_.enabled || old || image.empty() || !colors_.knows(head_->person)) return std::nullopt;

  const Box expected = with_hair(head_->box);
  const double reach = parameters_.reach * expected.width * unseen_;
  const Box window{(expected.x - reach) / kFactor, (expected.y - reach) / kFactor,
                   (expected.width + 2.0 * reach) / kFactor, (expected.height + 2.0 * reach) / kFactor};
  const auto [left, top] = image.corner_of(window);
  const LabelImage part = image.within(window);
  const auto order = colors_.order();
  const auto label = static_cast<std::uint16_t>(std::ranges::find(order, head_->person) - order.begin() + 1);
  const auto found = blobs_.largest(part, static_cast<std::uint16_t>(order.size()));
  const auto blob = std::ranges::find(found, label, &Blob::label);
  if (blob == found.end()) return std::nullopt;
  // As large as a head to all sides: a wall or a door of the same colours is larger.
  constexpr double kLargest = 1.5;  // of the head's sides
  const double area = double(blob->area_px) * kFactor * kFactor / head_->box.area();
  const bool wall =
      blob->box.width * kFactor > kLargest * expected.width || blob->box.height * kFactor > kLargest * expected.height;
  if (area < parameters_.min_area || area > parameters_.max_area || wall) return std::nullopt;
  const double x = (left + blob->box.x + blob->box.width / 2) * kFactor;
  const double y = (top + blob->box.y + blob->box.height / 2) * kFactor;
  // Skin of the neck hangs below, hair above: the middle of both is a little off the face's, so it follows with half the step.
  const double dx = x - (expected.x + expected.width / 2), dy = y - (expected.y + expected.height / 2);
  head_->box.x += dx / 2;
  head_->box.y += dy / 2;
  unseen_ = 0;
  return Classification{head_->person, parameters_.confidence};
}

void FaceColorClassifier::confirm(Label person, const Box& head) {
  if (preferred_ != person && colors_.knows(person)) {
    colors_.prefer(person);
    preferred_ = person;
    map_is_due_ = true;
  }
  head_ = PersonHead{person, head};
  unseen_ = unconfirmed_ = 0;
}

void FaceColorClassifier::learn(const PersonImage& input, const FaceSighting& face) {
  colors_.learn(*face.match.label, head_colors(input.image, face.box), other_colors(input.image, face.box));
  preferred_ = face.match.label;
  map_is_due_ = true;
  since_trained_ = 1;
}

void FaceColorClassifier::train(Label label, std::optional<Label>) {
  const bool lately = since_trained_ > 0 && since_trained_ <= parameters_.images_between;
  if (!parameters_.enabled || lately || !last_.face || last_.face->match.label != label || !colors_.knows(label))
    return;
  learn(last_, *last_.face);
}

void FaceColorClassifier::observe_face(const PersonImage& input, const FaceSighting& face) {
  seen_images_ = face.match.label && face.match.label == seen_ ? seen_images_ + 1 : 1;
  seen_ = face.match.label;
  if (!seen_ || !parameters_.enabled) return;
  // An image after the shirt: each map is made in an image of its own.
  if (!colors_.knows(*seen_) && seen_images_ > parameters_.images_to_learn) learn(input, face);
}

void FaceColorClassifier::forget(Label person) {
  colors_.forget(person);
  map_is_due_ = true;
  if (seen_ == person) seen_.reset();
  if (preferred_ == person) preferred_.reset();
  if (head_ && head_->person == person) head_.reset();
}

}  // namespace cgsr::person
