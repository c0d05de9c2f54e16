#include "pipeline/person/tracking/shirt_classifier.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "pipeline/person/colors/color_histogram.h"
#include "pipeline/person/tracking/shirt_colors.h"

namespace cgsr::person {
namespace {

constexpr int kFactor = ColorLabels::kFactor;
constexpr double kSamePlace = 0.4;  // intersection over union
constexpr double kSameSize = 0.6;   // the same, where a blob is the trunk and little else
constexpr int kLongLoss = 15;       // images

Box in_camera(const Blob& blob, int left = 0, int top = 0) {
  return {(blob.box.x + left) * kFactor, (blob.box.y + top) * kFactor, blob.box.width * kFactor,
          blob.box.height * kFactor};
}

Box in_labels(const Box& box) {
  return {box.x / kFactor, box.y / kFactor, box.width / kFactor, box.height / kFactor};
}

double camera_area(const Blob& blob) {
  return double(blob.area_px) * kFactor * kFactor;
}

// A marker that is turned away teaches nothing: beside a narrow shirt there is background where the shirt is expected.
bool is_facing(const MarkerSighting& marker) {
  constexpr double kMinWidth = 0.7;  // of its height: turned by less than 45 degrees
  return marker.box.width >= kMinWidth * marker.box.height;
}

}  // namespace

ShirtClassifier::ShirtClassifier(ColorLabels& labels, const ShirtParameters& parameters)
    : parameters_(parameters),
      labels_(labels),
      colors_(parameters.colors),
      light_(parameters.light),
      map_(imaging::kColorCodes, 0),
      followed_(parameters.place) {
  last_faces_.reserve(static_cast<std::size_t>(parameters.colors.max_people) + 1);
  prepare();
}

bool ShirtClassifier::prepare() {
  if (!map_is_due_) return false;
  std::vector<color::Light> lights;
  for (const Label person : colors_.order()) lights.push_back(light_.of(person).value_or(color::Light{1.0, 1.0, 1.0}));
  colors_.make_map(lights, map_);
  order_ = colors_.order();
  labels_.set(ColorPart::kShirt, map_);
  map_is_due_ = false;
  return true;
}

// By the person's own face: somebody else may be farther away, or smaller.
bool ShirtClassifier::is_plausible(Label person, const Box& shirt, double area_px2) const {
  const auto last = std::ranges::find(last_faces_, person, &PersonHead::person);
  if (last == last_faces_.end()) return false;
  return area_px2 >= parameters_.min_area * last->box.area() && shirt.width <= parameters_.max_width * last->box.width;
}

void ShirtClassifier::remember_face(Label person, const Box& face) {
  const auto last = std::ranges::find(last_faces_, person, &PersonHead::person);
  if (last != last_faces_.end()) {
    last->box = face;
    return;
  }
  std::erase_if(last_faces_, [this](const PersonHead& one) { return !colors_.knows(one.person); });
  last_faces_.push_back({person, face});
}

// The largest below the head is the shirt; sleeves and what a light has torn off are smaller.
bool ShirtClassifier::find_below(const PersonHead& head, int image_height_px) {
  constexpr double kLowest = 1.6;  // of the shirt's upper edge below the chin, in sides of the face
  const LabelImage image = labels_.of(ColorPart::kShirt);
  const Box small = in_labels(shirt_window(head.box, image_height_px));
  const auto [left, top] = image.corner_of(small);
  for (const Blob& blob : blobs_.largest(image.within(small), static_cast<std::uint16_t>(order_.size()))) {
    if (order_[blob.label - std::size_t{1}] != head.person) continue;
    const Box box = in_camera(blob, left, top);
    const bool hangs = box.y <= head.box.y + (1.0 + kLowest) * head.box.height;
    if (!hangs || !is_plausible(head.person, box, camera_area(blob))) return false;
    box_ = box;
    return true;
  }
  return false;
}

std::optional<Label> ShirtClassifier::find(const PersonImage& input) {
  const LabelImage image = labels_.of(ColorPart::kShirt);
  if (colors_.people() == 0 || image.empty()) return std::nullopt;
  const bool head = input.head && colors_.knows(input.head->person);
  if (head && find_below(*input.head, input.image.height_px)) return input.head->person;
  const Blob* largest = nullptr;
  for (const Blob& blob : blobs_.largest(image, static_cast<std::uint16_t>(order_.size()))) {
    const Box box = in_camera(blob);
    const Label person = order_[blob.label - std::size_t{1}];
    if (!colors_.knows(person) || !is_plausible(person, box, camera_area(blob))) continue;
    if (head && person == input.head->person) {
      elsewhere_ = box;
      continue;
    }
    const auto rank = [&](const Blob& one) {
      return std::pair(input.interest && order_[one.label - std::size_t{1}] == *input.interest, one.area_px);
    };
    if (largest != nullptr && rank(blob) <= rank(*largest)) continue;
    largest = &blob;
    box_ = box;
  }
  if (largest == nullptr) return std::nullopt;
  return order_[largest->label - std::size_t{1}];
}

std::uint16_t ShirtClassifier::label_of(Label person) const {
  return static_cast<std::uint16_t>(std::ranges::find(order_, person) - order_.begin() + 1);
}

// A shirt that was lost lately is not so much smaller at another place at once: something else has its colours there (relative size and motion, 6.3.1).
bool ShirtClassifier::is_scrap_elsewhere(const PersonImage& input, Label person) const {
  constexpr int kLately = 90;      // images
  constexpr double kSmall = 0.25;  // of the area that it had
  if (person != person_ || missed_ == 0 || missed_ > kLately) return false;
  const auto teacher = teacher_of(input);
  if (teacher && teacher->person == person) return false;
  return box_.area() < kSmall * place_.area() && intersection(box_, place_).empty();
}

// Who comes nearer looks larger, and so does the blob that holds the trunk, whatever else is in it. It is compared with how it was when it changed last, for in
// an image it changes by less than a pixel.
void ShirtClassifier::follow_size(const ImageView& image, std::optional<Label> by_blob) {
  constexpr double kHolds = 0.8;  // of the trunk
  const auto& place = followed_.place();
  const bool holds = by_blob && by_blob == followed_person_ && place &&
                     intersection(in_labels(box_), *place).area() >= kHolds * place->area();
  const auto growth = holds ? growth_of(holder_, box_, image) : std::nullopt;
  if (growth) followed_.resize(*growth);
  if (growth != 1.0) holder_ = holds ? box_ : Box{};
}

// Where a face or a marker is seen it says where the shirt is. What is left of a covered shirt, or has grown together with something else, does not say how
// far away it is; how large it was where it was followed does. Beside a passer-by it is followed on; where the head of somebody else is known, that one is
// named.
std::optional<Label> ShirtClassifier::find_at_place(const PersonImage& input, std::optional<Label> by_blob) {
  const auto teacher = teacher_of(input);
  if ((teacher && !is_passer_by(*teacher)) || !followed_person_) return by_blob;
  if (!colors_.knows(*followed_person_) || (input.interest && input.interest != followed_person_)) {
    followed_.end();
    return by_blob;
  }
  follow_size(input.image, by_blob);
  const auto place = followed_.follow(labels_.of(ColorPart::kShirt), label_of(*followed_person_));
  if (input.head && input.head->person != followed_person_) return by_blob;
  if (!place) {
    is_sized_by_place_ = followed_.place() && by_blob == followed_person_;
    return by_blob;
  }
  const Box trunk{place->x * kFactor, place->y * kFactor, place->width * kFactor, place->height * kFactor};
  if (!is_plausible(*followed_person_, trunk, trunk.area())) return by_blob;
  const bool supposed = supposed_ && followed_person_ == person_;
  if (supposed && intersection_over_union(trunk, place_) < kSamePlace) return by_blob;
  if (!supposed) learn_at_place(input, trunk);
  if (by_blob == followed_person_ && intersection_over_union(box_, trunk) >= kSameSize) return by_blob;
  box_ = trunk;
  is_sized_by_place_ = true;
  return followed_person_;
}

// The light and the sides of a shirt change while its person turns and walks: what is surely its own is added to its colours.
void ShirtClassifier::learn_at_place(const PersonImage& input, const Box& trunk) {
  constexpr double kMinContrast = 0.3;  // or it is partly covered, or before something of its colours
  if (++since_place_learned_ < parameters_.images_between || followed_.contrast() < kMinContrast) return;
  colors_.add(*followed_person_, trunk_colors(input.image, trunk), {}, light_.of(*followed_person_));
  since_place_learned_ = 0;
  map_is_due_ = true;
}

// Somebody else, who does not stand where the shirt is followed.
bool ShirtClassifier::is_passer_by(const Teacher& teacher) const {
  constexpr double kCovers = 0.5;  // of the place
  const auto& place = followed_.place();
  if (!place || teacher.person == followed_person_) return false;
  return intersection(in_labels(trunk_below(teacher.face)), *place).area() <= kCovers * place->area();
}

void ShirtClassifier::follow_from(const Teacher& teacher) {
  if (is_passer_by(teacher)) return;
  followed_.end();
  holder_ = {};
  followed_person_ = teacher.person;
  since_place_learned_ = 0;
  if (!followed_person_ || !colors_.knows(*followed_person_)) return;
  followed_.begin(labels_.of(ColorPart::kShirt), label_of(*followed_person_), in_labels(trunk_below(teacher.face)));
}

std::optional<double> ShirtClassifier::face_px() const {
  if (!is_sized_by_place_ || !followed_.place()) return std::nullopt;
  return face_px_of_trunk(kFactor * followed_.place()->width);
}

// Equal shirts go to the latest person of interest (6.2.2), also where somebody else's was learned since.
void ShirtClassifier::prefer(Label person) {
  if (person == preferred_) return;
  preferred_ = person;
  colors_.prefer(person);
  map_is_due_ = true;
}

std::optional<Classification> ShirtClassifier::classify(const PersonImage& input) {
  last_ = input;
  if (!parameters_.enabled) return std::nullopt;
  check_light();
  if (input.interest) prefer(*input.interest);
  box_ = elsewhere_ = {};
  is_sized_by_place_ = false;
  if (since_trained_ > 0) ++since_trained_;
  if (since_negative_ > 0) ++since_negative_;
  if (since_shared_ > 0) ++since_shared_;
  auto person = find(input);
  // In a light that is only supposed something else may have the shirt's colours: it has to be where the shirt was.
  if (supposed_ && person == person_ && intersection_over_union(box_, place_) < kSamePlace) person.reset();
  if (person && is_scrap_elsewhere(input, *person)) person.reset();
  const auto& marker = input.marker;
  if (person && marker && marker->person == person && is_facing(*marker) && !lies_under(box_, *marker)) person.reset();
  person = find_at_place(input, person);
  if (person) {
    found(input, *person);
    return Classification{*person, parameters_.confidence};
  }
  box_ = {};
  lost(input);
  return std::nullopt;
}

// After a loss its person may be nearer or farther away: how large the shirt was says nothing any longer. A light that changes loses it for a few images.
void ShirtClassifier::found(const PersonImage& input, Label person) {
  if (person != person_) before_light_.reset(), take_back_supposed();
  place_ = person == person_ && missed_ < kLongLoss ? settled(place_, box_) : box_;
  person_ = person;
  missed_ = since_trained_ = 0;
  supposed_ = false;
  const auto colors = part_colors(input.image, place_);
  if (!colors || !light_.found(person, *colors)) return;
  constexpr double kRoom = 0.5;  // of its sides, to each side
  const Box window{place_.x - kRoom * place_.width, place_.y - kRoom * place_.height,
                   (1.0 + 2.0 * kRoom) * place_.width, (1.0 + 2.0 * kRoom) * place_.height};
  before_light_ = {window, pixels_in(window)};
  map_is_due_ = true;
}

// Somebody else is seen meanwhile.
void ShirtClassifier::take_back_supposed() {
  if (!supposed_ || !person_) return;
  light_.take_back(*person_);
  map_is_due_ = true;
}

int ShirtClassifier::pixels_in(const Box& window) const {
  const LabelImage part = labels_.of(ColorPart::kShirt).within(in_labels(window));
  const std::uint16_t label = label_of(*person_);
  int pixels = 0;
  for (int y = 0; y < part.height_px; ++y)
    for (int x = 0; x < part.width_px; ++x) pixels += part.at(x, y) == label ? 1 : 0;
  return pixels;
}

// A shirt that comes into view from another side, or goes behind something, can look as if the light had changed. Under the right light no less of it is seen.
void ShirtClassifier::check_light() {
  constexpr double kNoLess = 0.7;
  if (!before_light_ || map_is_due_) return;  // the map of that light is not made yet
  const Before before = *std::exchange(before_light_, std::nullopt);
  if (!person_) return;
  if (pixels_in(before.window) >= kNoLess * before.pixels) {
    light_.confirm(*person_);
    return;
  }
  light_.undo(*person_);
  map_is_due_ = true;
}

// The light may have changed at once, or go on changing: then the place where the shirt was has, in the new light, the shirt's colours. This is supposed for
// each light once. After a long loss the light of its last place may not be that of where it comes back: it is looked for under that of learning in turns.
void ShirtClassifier::lost(const PersonImage& input) {
  if (!person_) return;
  if (supposed_ && !map_is_due_) {  // it was looked for in that light
    supposed_ = false;
    light_.take_back(*person_);
    map_is_due_ = true;
  }
  constexpr int kTurn = 2;  // images
  if (++missed_ >= kLongLoss && missed_ % kTurn == 0 && !supposed_ && light_.turn(*person_)) map_is_due_ = true;
  if (missed_ >= kLongLoss || map_is_due_) return;
  const auto now = part_colors(input.image, place_);
  if (!now || !light_.suppose(*person_, *now)) return;
  before_light_.reset();
  supposed_ = map_is_due_ = true;
}

// The person's marker before a face; of two strangers either will do.
std::optional<ShirtClassifier::Teacher> ShirtClassifier::teacher_of(const PersonImage& input) {
  const auto& face = input.face;
  const auto& marker = input.marker;
  if (marker && is_facing(*marker) && (marker->person || !face))
    return Teacher{marker->person, marker->face, sampling_regions(*marker)};
  if (face) return Teacher{face->match.label, face->box, sampling_regions(face->box)};
  return std::nullopt;
}

void ShirtClassifier::learn(const PersonImage& input, const Teacher& teacher) {
  const SamplingRegions& regions = teacher.regions;
  auto background = colors_of_both(input.image, regions.background);
  // Where a shirt's place ends there are other colours: without them it would grow into a road or a wall of its own.
  const auto beside = colors_of_both(input.image, beside_trunk(trunk_below(teacher.face)));
  background.insert(background.end(), beside.begin(), beside.end());
  const Label person = *teacher.person;
  if (person != person_) take_back_supposed();
  colors_.learn(person, region_colors(input.image, regions.shirt), background);
  if (preferred_) colors_.prefer(*preferred_);
  if (const auto light = colors_.learned_light(person)) light_.learn(person, *light);
  light_.keep(colors_.order());
  supposed_ = false;
  map_is_due_ = true;
}

void ShirtClassifier::train(Label label, std::optional<Label> mistaken_for) {
  const auto teacher = teacher_of(last_);
  if (!teacher || teacher->person != label || !colors_.knows(label)) return;
  if (!is_in_view(teacher->regions.shirt, last_.image)) return;
  const bool in_vain = since_trained_ > 0 && since_trained_ <= parameters_.images_between;
  if (in_vain && !mistaken_for) return;
  // Where both wear the same the shirt is taken for the preferred person's again, however often it is learned.
  const bool shared = mistaken_for && mistaken_for == preferred_;
  if (shared && since_shared_ > 0 && since_shared_ <= parameters_.images_between) return;
  if (shared) since_shared_ = 1;
  learn(last_, *teacher);
  since_trained_ = 1;
  since_negative_ = 0;
  learn_negative();
}

void ShirtClassifier::learn_negative() {
  const bool lately = since_negative_ > 0 && since_negative_ <= parameters_.images_between;
  if (!last_.head || elsewhere_.empty() || lately) return;
  const auto light = light_.of(last_.head->person);
  if (!light) return;
  colors_.doubt(last_.head->person, region_colors(last_.image, elsewhere_), *light);
  since_negative_ = 1;
  map_is_due_ = true;
}

void ShirtClassifier::observe(const PersonImage& input) {
  const auto teacher = teacher_of(input);
  if (!teacher || !parameters_.enabled) return;
  seen_images_ = teacher->person && teacher->person == seen_ ? seen_images_ + 1 : 1;
  seen_ = teacher->person;
  follow_from(*teacher);
  if (!seen_) return;
  remember_face(*seen_, teacher->face);
  const bool learns = !colors_.knows(*seen_) && seen_images_ >= parameters_.images_to_learn;
  if (learns && is_in_view(teacher->regions.shirt, input.image)) learn(input, *teacher);
}

void ShirtClassifier::forget(Label person) {
  colors_.forget(person);
  light_.forget(person);
  std::erase_if(last_faces_, [person](const PersonHead& one) { return one.person == person; });
  map_is_due_ = true;
  if (seen_ == person) seen_.reset();
  if (person_ == person) person_.reset(), before_light_.reset();
  if (preferred_ == person) preferred_.reset();
  if (followed_person_ == person) followed_.end(), holder_ = {};
}

}  // namespace cgsr::person
