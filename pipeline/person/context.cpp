#include "pipeline/person/context.h"

#include <algorithm>
#include <array>

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

ImageContext context_of(const ImageView& image, const Box& region) {
  constexpr int kSide = 16;
  const Box part = intersection(region, {0, 0, double(image.width_px), double(image.height_px)});
  if (image.empty() || image.format != PixelFormat::kYuyv || part.empty()) return {};
  std::array<imaging::Rgb, std::size_t{kSide} * kSide> colors{};
  for (int i = 0; i < kSide; ++i) {
    const auto y = std::min(image.height_px - 1, static_cast<int>(part.y + (i + 0.5) * part.height / kSide));
    for (int j = 0; j < kSide; ++j) {
      const auto x = std::min(image.width_px - 1, static_cast<int>(part.x + (j + 0.5) * part.width / kSide));
      const std::uint8_t* pair = image.row(y) + std::ptrdiff_t{4} * (x / 2);  // Y0 U Y1 V
      colors[static_cast<std::size_t>(i * kSide + j)] = imaging::rgb_of_yuv(pair[x % 2 * 2], pair[1], pair[3]);
    }
  }
  return context_of(colors);
}

double reliability(Cue cue, const ImageContext& context, const ContextParameters& parameters) {
  const bool color = cue == Cue::kColor;
  const auto kept = [](double share, double loss) { return 1.0 - std::clamp(share, 0.0, 1.0) * loss; };
  return kept(context.dark, color ? parameters.dark_color : parameters.dark_grey) *
         kept(context.saturated, color ? parameters.saturated_color : parameters.saturated_grey) *
         kept(context.blurred, color ? parameters.blurred_color : parameters.blurred_grey);
}

}  // namespace cgsr::person
