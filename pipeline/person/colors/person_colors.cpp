#include "pipeline/person/colors/person_colors.h"

#include <algorithm>
#include <utility>

namespace cgsr::person {
namespace {

// Samples and questions are divided by a light; what comes out above 1 is cut off by the histogram.
std::vector<imaging::Rgb> textures(std::span<const imaging::Rgb> recorded, const color::Light& light) {
  std::vector<imaging::Rgb> all;
  all.reserve(recorded.size());
  for (const imaging::Rgb& one : recorded) all.push_back(color::without_light(one, light));
  return all;
}

// Alg. 3.1, lines 9 to 11.
color::Light assumed_light(std::span<const imaging::Rgb> positive, double assumed) {
  ColorHistogram recorded;
  recorded.add(positive);
  const imaging::Rgb bright = recorded.bright_level();
  return {std::max(assumed, bright.r), std::max(assumed, bright.g), std::max(assumed, bright.b)};
}

// The codes of an image are about 3 bins apart, 0.046 of a texture in the light that is assumed at learning. Under that light they are the samples' own; under any other
// a texture is half a step from its sample's code then and half a step from its own now, and those steps are the larger the darker it is.
int reach_under(const color::Light& light, const color::Light& learned) {
  if (light.r == learned.r && light.g == learned.g && light.b == learned.b) return 1;
  constexpr double kHalfStep = 1.6;  // bins
  const double widest = std::max({learned.r / light.r, learned.g / light.g, learned.b / light.b});
  return std::clamp(static_cast<int>(kHalfStep + kHalfStep * widest), 3, 5);
}

/// The colours of all codes: made once, with the first map, of nobody, before the first image.
const std::vector<imaging::Rgb>& colors_of_codes() {
  static const std::vector<imaging::Rgb> kColors = [] {
    std::vector<imaging::Rgb> all;
    all.reserve(imaging::kColorCodes);
    for (int code = 0; code < imaging::kColorCodes; ++code)
      all.push_back(imaging::rgb_of_code(static_cast<std::uint16_t>(code)));
    return all;
  }();
  return kColors;
}

}  // namespace

SamplingRegions sampling_regions(const Box& face) {
  const auto beside = [&](double x) { return Box{x, face.y, face.width, face.height}; };
  return {{face.x, face.y + 1.5 * face.height, face.width, face.height},
          {beside(face.x - 1.5 * face.width), beside(face.x + 1.5 * face.width)}};
}

PersonColors::Person* PersonColors::find(Label person) {
  const auto found = std::ranges::find(people_, person, &Person::label);
  return found == people_.end() ? nullptr : &*found;
}

const PersonColors::Person* PersonColors::find(Label person) const {
  const auto found = std::ranges::find(people_, person, &Person::label);
  return found == people_.end() ? nullptr : &*found;
}

PersonColors::Person& PersonColors::room_for(Label person) {
  if (Person* known = find(person)) return *known;
  if (people_.size() < static_cast<std::size_t>(parameters_.max_people)) return people_.emplace_back();
  return *std::ranges::min_element(people_, {}, &Person::interest);
}

void PersonColors::put(Person& person, std::span<const imaging::Rgb> positive, std::span<const imaging::Rgb> negative,
                       const color::Light& light) {
  for (Codes& codes : person.codes) codes.light.reset();
  person.positive.add(textures(positive, light));
  person.negative.add(textures(negative, light));
}

void PersonColors::learn(Label person, std::span<const imaging::Rgb> positive, std::span<const imaging::Rgb> negative) {
  if (positive.empty()) return;
  Person& one = room_for(person);
  one.label = person;
  one.interest = ++interest_;
  one.positive.clear();
  one.negative.clear();
  one.light = assumed_light(positive, parameters_.light.assumed);
  put(one, positive, negative, one.light);
}

void PersonColors::add(Label person, std::span<const imaging::Rgb> positive, std::span<const imaging::Rgb> negative,
                       const std::optional<color::Light>& light) {
  if (Person* known = find(person)) {
    put(*known, positive, negative, light.value_or(known->light));
  } else {
    learn(person, positive, negative);
  }
}

void PersonColors::doubt(Label person, std::span<const imaging::Rgb> negative, const color::Light& light) {
  Person* known = find(person);
  if (known == nullptr) return;
  put(*known, {}, negative, light);
}

void PersonColors::forget(Label person) {
  std::erase_if(people_, [&](const Person& one) { return one.label == person; });
}

void PersonColors::prefer(Label person) {
  if (Person* known = find(person)) known->interest = ++interest_;
}

bool PersonColors::knows(Label person) const {
  return find(person) != nullptr;
}

double PersonColors::share(Label person, const imaging::Rgb& recorded, const color::Light& light) const {
  const Person* known = find(person);
  return known == nullptr
             ? 0.0
             : known->positive.share(color::without_light(recorded, light), reach_under(light, known->light));
}

std::optional<color::Light> PersonColors::learned_light(Label person) const {
  const Person* known = find(person);
  return known == nullptr ? std::nullopt : std::optional(known->light);
}

std::vector<Label> PersonColors::order() const {
  std::vector<Label> labels;
  for (const Person& one : people_) labels.push_back(one.label);
  return labels;
}

// A light that is taken back, or looked under in turns, costs nothing again.
const std::vector<std::uint16_t>& PersonColors::codes_under(const color::Light& light, Person& person) const {
  auto& [last, before] = person.codes;
  const auto is_of = [&light](const Codes& codes) {
    return codes.light && codes.light->r == light.r && codes.light->g == light.g && codes.light->b == light.b;
  };
  if (is_of(last)) return last.all;
  std::swap(last, before);
  if (is_of(last)) return last.all;
  last.light = light;
  find_codes(person, light, last.all);
  return last.all;
}

void PersonColors::find_codes(const Person& person, const color::Light& light,
                              std::vector<std::uint16_t>& codes) const {
  codes.clear();
  const int reach = reach_under(light, person.light);
  // By the colours looked at: those of cloth in one light lie along a line, from its folds to where it faces the lamp.
  const double min_share = parameters_.min_share * (2.0 * reach + 1.0) / 3.0;
  const std::vector<std::uint8_t> near = person.positive.met_nearby(reach);
  if (near.empty()) return;
  const std::vector<imaging::Rgb>& colors = colors_of_codes();
  for (int code = 0; code < imaging::kColorCodes; ++code) {
    const auto texture = color::without_light(colors[static_cast<std::size_t>(code)], light);
    if (near[ColorHistogram::bin(texture)] == 0) continue;
    const double share = person.positive.share(texture, reach);
    if (share < min_share || share < parameters_.min_ratio * person.negative.share(texture, reach)) continue;
    codes.push_back(static_cast<std::uint16_t>(code));
  }
}

void PersonColors::make_map(std::span<const color::Light> lights, imaging::LabelTable& map) {
  map.assign(imaging::kColorCodes, 0);
  if (people_.empty()) static_cast<void>(colors_of_codes());
  std::vector<std::size_t> by_interest(people_.size());
  for (std::size_t i = 0; i < by_interest.size(); ++i) by_interest[i] = i;
  std::ranges::sort(by_interest, {}, [&](std::size_t i) { return people_[i].interest; });  // the latest is written last
  for (const std::size_t i : by_interest) {
    Person& one = people_[i];
    const color::Light& light = i < lights.size() ? lights[i] : one.light;
    for (const std::uint16_t code : codes_under(light, one)) map[code] = static_cast<std::uint16_t>(i + 1);
  }
}

}  // namespace cgsr::person
