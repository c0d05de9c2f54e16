#include "src/output/terminal_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

namespace cgsr::app {
namespace {

struct Rgb {
  int r = 0, g = 0, b = 0;
};

/// BT.601, limited range.
Rgb rgb_at(const ImageView& image, int x, int y) {
  const std::uint8_t* pair = image.row(y) + 4 * static_cast<std::ptrdiff_t>(x / 2);
  const double luma = 1.164 * (pair[2 * (x % 2)] - 16);
  const double u = pair[1] - 128.0;
  const double v = pair[3] - 128.0;
  const auto byte = [](double value) { return static_cast<int>(std::lround(std::clamp(value, 0.0, 255.0))); };
  return {byte(luma + 1.596 * v), byte(luma - 0.392 * u - 0.813 * v), byte(luma + 2.017 * u)};
}

}  // namespace

std::string terminal_picture(const ImageView& image, int columns, bool colors) {
  constexpr std::string_view kRamp = " .:-=+*#%@";
  columns = std::clamp(columns, 8, 400);
  // A character is about twice as high as it is wide; with colours it shows two pixels, one above the other.
  const int pixel_rows = std::max(2, columns * image.height_px / image.width_px / (colors ? 1 : 2)) & ~1;
  const auto pixel = [&](int column, int row) {
    return rgb_at(image, std::min(image.width_px - 1, (2 * column + 1) * image.width_px / (2 * columns)),
                  std::min(image.height_px - 1, (2 * row + 1) * image.height_px / (2 * pixel_rows)));
  };
  std::string text;
  for (int row = 0; row < pixel_rows; row += colors ? 2 : 1) {
    for (int column = 0; column < columns; ++column) {
      const Rgb upper = pixel(column, row);
      if (!colors) {
        const int grey = (299 * upper.r + 587 * upper.g + 114 * upper.b) / 1000;
        text += kRamp[static_cast<std::size_t>(grey) * kRamp.size() / 256];
        continue;
      }
      const Rgb lower = pixel(column, row + 1);
      text +=
          fmt::format("\x1b[38;2;{};{};{};48;2;{};{};{}m\u2580", upper.r, upper.g, upper.b, lower.r, lower.g, lower.b);
    }
    text += colors ? "\x1b[0m\n" : "\n";
  }
  return text;
}

std::string bar_chart(std::span<const Bar> bars, int columns) {
  double largest = 0.0;
  std::size_t label_width = 0;
  for (const Bar& bar : bars) {
    largest = std::max(largest, bar.value);
    label_width = std::max(label_width, bar.label.size());
  }
  std::string text;
  for (const Bar& bar : bars) {
    const int length = largest > 0.0 ? static_cast<int>(std::lround(columns * bar.value / largest)) : 0;
    text += fmt::format("{:>{}} |{:<{}}| {}\n", bar.label, label_width,
                        std::string(static_cast<std::size_t>(length), '#'), columns, bar.text);
  }
  return text;
}

}  // namespace cgsr::app
