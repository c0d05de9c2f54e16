#include "pipeline/person/context.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <optional>

namespace cgsr::person {
namespace {

constexpr int kAcross = 16;
using Spread = std::array<imaging::Rgb, std::size_t{kAcross} * kAcross>;

// Pixels that are spread over what of the region is within the image. Nothing: none is.
std::optional<Spread> spread_over(const ImageView& image, const Box& region) {
  const Box part = intersection(region, {0, 0, double(image.width_px), double(image.height_px)});
  if (image.empty() || image.format != PixelFormat::kYuyv || part.empty()) return std::nullopt;
  Spread colors{};
  for (int i = 0; i < kAcross; ++i) {
    const auto y = std::min(image.height_px - 1, static_cast<int>(part.y + (i + 0.5) * part.height / kAcross));
    for (int j = 0; j < kAcross; ++j) {
      const auto x = std::min(image.width_px - 1, static_cast<int>(part.x + (j + 0.5) * part.width / kAcross));
      const std::uint8_t* pair = image.row(y) + std::ptrdiff_t{4} * (x / 2);  // Y0 U Y1 V
      colors[static_cast<std::size_t>(i * kAcross + j)] = imaging::rgb_of_yuv(pair[x % 2 * 2], pair[1], pair[3]);
    }
  }
  return colors;
}

}  // namespace

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
  constexpr double kSharp = 0.75, kNoEdge = 0.95;  // of blur_of()
  const auto colors = spread_over(image, region);
  if (!colors) return {};
  ImageContext context = context_of(*colors);
  context.blurred = std::clamp((blur_of(image, region) - kSharp) / (kNoEdge - kSharp), 0.0, 1.0);
  return context;
}

double mean_luma(const ImageView& image, const Box& region) {
  const auto colors = spread_over(image, region);
  if (!colors) return 1.0;
  double sum = 0.0;
  for (const imaging::Rgb& color : *colors) sum += imaging::yuv_of_rgb(color).y / 255.0;
  return sum / static_cast<double>(colors->size());
}

double blur_of(const ImageView& image, const Box& region) {
  constexpr int kRows = 16, kReach = 4, kMinWidth = 16;  // blurred over 2 kReach + 1 pixels
  const Box part = intersection(region, {0, 0, double(image.width_px), double(image.height_px)});
  const int left = static_cast<int>(part.x), right = static_cast<int>(part.x + part.width);
  if (image.empty() || image.format != PixelFormat::kYuyv || right - left < kMinWidth) return 0.0;
  std::int64_t differences = 0, lost = 0;  // of 2 kReach + 1 times the grey values
  for (int i = 0; i < kRows; ++i) {
    const auto y = std::min(image.height_px - 1, static_cast<int>(part.y + (i + 0.5) * part.height / kRows));
    const std::uint8_t* const row = image.row(y);
    const auto grey = [&](int x) { return int{row[std::ptrdiff_t{2} * std::clamp(x, left, right - 1)]}; };
    for (int x = left + 1; x < right; ++x) {
      const int sharp = (2 * kReach + 1) * std::abs(grey(x) - grey(x - 1));
      const int blurred = std::abs(
          grey(x + kReach) - grey(x - 1 - kReach));  // the difference of two sums that share all but one pixel each
      differences += sharp;
      lost += std::max(0, sharp - blurred);
    }
  }
  return differences > 0 ? 1.0 - static_cast<double>(lost) / static_cast<double>(differences) : 0.0;
}

double signal_to_noise(const ImageView& image, const Box& region) {
  constexpr int kMinWidth = 16;
  constexpr double kRounding = 0.29;  // the standard deviation of what is rounded to whole grey values
  const Box part = intersection(region, {1, 1, double(image.width_px - 2), double(image.height_px - 2)});
  if (image.empty() || image.format != PixelFormat::kYuyv || std::min(part.width, part.height) < kMinWidth)
    return kNoNoise;
  double sum = 0.0, squares = 0.0, masked = 0.0;
  for (int i = 0; i < kAcross; ++i) {
    const int y = static_cast<int>(part.y + (i + 0.5) * part.height / kAcross);
    const std::array rows{image.row(y - 1), image.row(y), image.row(y + 1)};
    for (int j = 0; j < kAcross; ++j) {
      const int x = static_cast<int>(part.x + (j + 0.5) * part.width / kAcross);
      const auto at = [&](std::size_t row, int dx) { return int{rows[row][std::ptrdiff_t{2} * (x + dx)]}; };
      const int corners = at(0, -1) + at(0, 1) + at(2, -1) + at(2, 1);
      const int sides = at(0, 0) + at(1, -1) + at(1, 1) + at(2, 0);
      const double mean = (corners + sides + at(1, 0)) / 9.0;
      sum += mean;
      squares += mean * mean;
      masked += std::abs(corners - 2 * sides + 4 * at(1, 0));
    }
  }
  constexpr double kPlaces = kAcross * kAcross;
  const double noise = std::max(kRounding, std::sqrt(std::numbers::pi / 2.0) / 6.0 * masked / kPlaces);
  const double deviation2 = squares / kPlaces - sum * sum / (kPlaces * kPlaces);
  return std::sqrt(std::max(0.0, deviation2 - noise * noise / 9.0)) /
         noise;  // of the noise a mean of nine keeps a third
}

double reliability(Cue cue, const ImageContext& context, const ContextParameters& parameters) {
  const bool color = cue == Cue::kColor;
  const auto kept = [](double share, double loss) { return 1.0 - std::clamp(share, 0.0, 1.0) * loss; };
  return kept(context.dark, color ? parameters.dark_color : parameters.dark_grey) *
         kept(context.saturated, color ? parameters.saturated_color : parameters.saturated_grey) *
         kept(context.blurred, color ? parameters.blurred_color : parameters.blurred_grey);
}

}  // namespace cgsr::person
