#include "pipeline/person/context.h"

#include <algorithm>

namespace cgsr::person {

std::string_view to_string(Cue cue) {
  switch (cue) {
    case Cue::kColor:
      return "color";
    case Cue::kGrey:
      return "grey";
  }
  return "";
}

ImageContext context_of(std::span<const imaging::Rgb> colors) {
  constexpr double kDark = 0.08, kCutOff = 0.97;
  if (colors.empty()) return {};
  std::size_t dark = 0, saturated = 0;
  for (const imaging::Rgb& color : colors) {
    const double most = std::max({color.r, color.g, color.b});
    dark += most < kDark ? 1 : 0;
    saturated += most > kCutOff ? 1 : 0;
  }
  const auto count = static_cast<double>(colors.size());
  return {static_cast<double>(dark) / count, static_cast<double>(saturated) / count, 0.0};
}

double reliability(Cue cue, const ImageContext& context, const ContextParameters& parameters) {
  const bool color = cue == Cue::kColor;
  const auto kept = [](double share, double loss) { return 1.0 - std::clamp(share, 0.0, 1.0) * loss; };
  return kept(context.dark, color ? parameters.dark_color : parameters.dark_grey) *
         kept(context.saturated, color ? parameters.saturated_color : parameters.saturated_grey) *
         kept(context.blurred, color ? parameters.blurred_color : parameters.blurred_grey);
}

}  // namespace cgsr::person
