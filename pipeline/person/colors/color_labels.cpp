#include "pipeline/person/colors/color_labels.h"

namespace cgsr::person {
namespace {

constexpr int kBitsPerPart = 8;

constexpr int shift_of(ColorPart part) {
  return part == ColorPart::kShirt ? 0 : kBitsPerPart;
}

}  // namespace

std::string_view to_string(ColorPart part) {
  switch (part) {
    case ColorPart::kShirt:
      return "shirt";
    case ColorPart::kHead:
      return "head";
  }
  return "";
}

ColorLabels::ColorLabels(int max_width_px, int max_height_px)
    : table_(imaging::kColorCodes, 0), reduced_(max_width_px, max_height_px) {}

void ColorLabels::set(ColorPart part, const imaging::LabelTable& map) {
  const int shift = shift_of(part);
  const int others = ~(kMaxPeople << shift);
  for (std::size_t code = 0; code < table_.size(); ++code)
    table_[code] = static_cast<std::uint16_t>((table_[code] & others) | (map[code] << shift));
}

bool ColorLabels::look(const ImageView& image) {
  if (imaging::reduce(image, kFactor, table_, reduced_)) return true;
  reduced_.width_px = reduced_.height_px = 0;
  return false;
}

LabelImage ColorLabels::of(ColorPart part) const {
  return {reduced_.labels.data(), reduced_.width_px, reduced_.height_px, reduced_.width_px, shift_of(part), kMaxPeople};
}

}  // namespace cgsr::person
