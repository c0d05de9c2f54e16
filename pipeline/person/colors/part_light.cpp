#include "pipeline/person/colors/part_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace cgsr::person {
namespace {

bool differs(const color::Light& a, const color::Light& b, double share) {
  const auto far = [share](double one, double other) { return std::abs(one - other) > share * other; };
  return far(a.r, b.r) || far(a.g, b.g) || far(a.b, b.b);
}

constexpr double kDarkest = 0.02;  // of a channel: below, a ratio says nothing

color::Light change_of(const imaging::Rgb& now, const imaging::Rgb& then) {
  const auto ratio = [](double a, double b) { return std::max(a, kDarkest) / std::max(b, kDarkest); };
  return {ratio(now.r, then.r), ratio(now.g, then.g), ratio(now.b, then.b)};
}

constexpr color::Light kNoChange{1.0, 1.0, 1.0};
constexpr double kMeasured = 0.04;  // how well two means are alike where nothing changes

/// One channel of a part and of what is beside it: by how much it has changed.
struct Channel {
  double change = 1.0, beside = 1.0;
  bool tells =
      false;  // what a part hardly reflects does not: its coding is coarser than a change, and other channels leak into it
};
using Channels = std::array<Channel, 3>;

Channels channels_of(const PartColors& then, const PartColors& now) {
  constexpr double kDim = 0.15;
  const color::Light change = change_of(now.part, then.part), beside = change_of(now.beside, then.beside);
  return {{{change.r, beside.r, then.part.r >= kDim},
           {change.g, beside.g, then.part.g >= kDim},
           {change.b, beside.b, then.part.b >= kDim}}};
}

/// The change of each channel: what is beside the part says that of one that does not tell, as far as a lamp's colour may differ from the others' change.
/// \return nothing: no channel tells.
std::optional<color::Light> change_by(const Channels& channels) {
  constexpr double kTint = 1.25;
  double least = 0.0, most = 0.0;
  for (const Channel& one : channels) {
    if (!one.tells) continue;
    least = least > 0.0 ? std::min(least, one.change) : one.change;
    most = std::max(most, one.change);
  }
  if (most <= 0.0) return std::nullopt;
  const auto of = [&](const Channel& one) {
    return one.tells ? one.change : std::clamp(one.beside, least / kTint, most * kTint);
  };
  return color::Light{of(channels[0]), of(channels[1]), of(channels[2])};
}

}  // namespace

PartLight::Part* PartLight::find(Label person) {
  const auto found = std::ranges::find(parts_, person, &Part::person);
  return found == parts_.end() ? nullptr : &*found;
}

void PartLight::learn(Label person, const color::Light& assumed) {
  forget(person);
  parts_.push_back({.person = person, .assumed = assumed, .used = assumed});
}

void PartLight::forget(Label person) {
  std::erase_if(parts_, [person](const Part& part) { return part.person == person; });
}

void PartLight::keep(std::span<const Label> people) {
  std::erase_if(parts_, [people](const Part& part) { return std::ranges::find(people, part.person) == people.end(); });
}

// Nothing: no light, or none that changed both alike, explains what is seen; or nothing has changed.
std::optional<color::Light> PartLight::light_by(const Part& part, const PartColors& now) const {
  const Channels channels = channels_of(*part.colors, now);
  const auto change = change_by(channels);
  if (!change) return std::nullopt;
  double largest = 0.0, apart = 0.0;
  for (const Channel& one : channels) {
    if (!one.tells) continue;
    largest = std::max(largest, std::abs(std::log(one.change)));
    apart = std::max(apart, std::abs(std::log(one.change / one.beside)));
  }
  if (largest < parameters_.min_change || apart > std::max(kMeasured, parameters_.agreement * largest))
    return std::nullopt;
  const color::Light light = color::lit(part.used, *change);
  const color::Light gain = change_of(light, part.assumed);
  const auto [least, most] = std::minmax({gain.r, gain.g, gain.b});
  const bool plausible =
      most <= parameters_.max_gain && least >= 1.0 / parameters_.max_gain && most <= parameters_.max_tint * least;
  return plausible ? std::optional(light) : std::nullopt;
}

// While the shirt looks as it did the light is the same, whatever it stands before by now. What has changed slowly with the shirt is the light, which is known
// when it has changed enough.
bool PartLight::found(Label person, const PartColors& colors) {
  Part* part = find(person);
  if (part == nullptr) return false;
  if (!part->colors || part->before || part->other) part->colors = colors;
  part->before.reset();
  part->other.reset();
  part->tried.reset();
  if (const auto light = light_by(*part, colors)) {
    part->last = std::exchange(part->used, *light);
    part->colors = colors;
    return true;
  }
  const Channels channels = channels_of(*part->colors, colors);
  const auto all = [&channels](const auto& holds) {
    return std::ranges::all_of(channels, [&](const Channel& one) { return !one.tells || holds(one); });
  };
  const bool looks_alike =
      all([&](const Channel& one) { return std::abs(one.change - 1.0) <= parameters_.min_change / 2; });
  const bool stands_elsewhere =
      !all([](const Channel& one) { return std::abs(one.beside - one.change) <= kMeasured * one.change; });
  if (looks_alike && stands_elsewhere) {
    const auto change = change_by(channels);
    part->colors->beside = color::without_light(colors.beside, change.value_or(kNoChange));
  }
  return false;
}

void PartLight::undo(Label person) {
  Part* part = find(person);
  if (part == nullptr || !part->last) return;
  part->used = *part->last;
  part->last.reset();
  part->before.reset();
  part->other.reset();
}

void PartLight::confirm(Label person) {
  if (Part* part = find(person)) part->last.reset();
}

bool PartLight::suppose(Label person, const PartColors& now) {
  Part* part = find(person);
  if (part == nullptr || !part->colors) return false;
  const auto light = light_by(*part, now);
  if (!light || (part->tried && !differs(*light, *part->tried, parameters_.min_change / 2))) return false;
  part->before = part->used;
  part->used = part->tried.emplace(*light);
  return true;
}

void PartLight::take_back(Label person) {
  Part* part = find(person);
  if (part == nullptr || !part->before) return;
  part->used = *part->before;
  part->before.reset();
}

bool PartLight::turn(Label person) {
  Part* part = find(person);
  if (part == nullptr || (!part->other && !differs(part->assumed, part->used, parameters_.min_change / 2)))
    return false;
  if (!part->other) part->other = part->assumed;
  std::swap(part->used, *part->other);
  return true;
}

std::optional<color::Light> PartLight::of(Label person) const {
  const auto found = std::ranges::find(parts_, person, &Part::person);
  return found == parts_.end() ? std::nullopt : std::optional(found->used);
}

std::optional<imaging::Rgb> mean_color(const ImageView& image, const Box& region) {
  constexpr int kDark = 30, kWhite = 230;  // of luma, as the camera codes it
  constexpr int kLeast = 12;
  constexpr int kStep = 4;
  if (image.empty() || image.format != PixelFormat::kYuyv) return std::nullopt;
  const Box inside = intersection(region, {0.0, 0.0, double(image.width_px), double(image.height_px)});
  double sum_y = 0.0, sum_u = 0.0, sum_v = 0.0;
  int count = 0;
  for (int y = static_cast<int>(inside.y); y < static_cast<int>(inside.y + inside.height); y += kStep) {
    for (int x = static_cast<int>(inside.x) & ~1; x < static_cast<int>(inside.x + inside.width); x += kStep) {
      const std::uint8_t* pixel = image.row(y) + std::ptrdiff_t{2} * x;
      if (pixel[0] < kDark || pixel[0] > kWhite) continue;
      sum_y += pixel[0], sum_u += pixel[1], sum_v += pixel[3];
      ++count;
    }
  }
  if (count < kLeast) return std::nullopt;
  return imaging::rgb_of_yuv(sum_y / count, sum_u / count, sum_v / count);
}

}  // namespace cgsr::person
