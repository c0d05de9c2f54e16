#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "pipeline/imaging/color_code.h"
#include "platform/parameters.h"

namespace cgsr::imaging {

enum class ColorSpace : std::uint8_t { kRgb, kHsv, kYuv };

inline constexpr std::array kColorSpaceNames{
    Named<ColorSpace>{"rgb", ColorSpace::kRgb},
    Named<ColorSpace>{"hsv", ColorSpace::kHsv},
    Named<ColorSpace>{"yuv", ColorSpace::kYuv},
};
constexpr std::string_view to_string(ColorSpace space) {
  return word_in(kColorSpaceNames, space);
}

/// How a colour histogram divides colours: a colour space cut into per_channel^3 bins of equal width (Alg. 3.1, line 21; 8 x 8 x 8
/// of RGB in section 3.3.1).
struct ColorBins {
  ColorSpace space = ColorSpace::kRgb;
  int per_channel = 8;

  [[nodiscard]] int count() const { return per_channel * per_channel * per_channel; }
  friend bool operator==(const ColorBins&, const ColorBins&) = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("space", self.space, kColorSpaceNames, "The colour space of the histograms.");
    visit.number("per_channel", self.per_channel, Range{2, 16}, "", "The number of bins per channel.");
  }
};

/// \return the bin of a colour, in 0..bins.count() - 1; the first channel (R, H or Y) counts most. A channel that is exactly 1
///         belongs to the last bin. Hue is cyclic and a grey has hue 0.
///         Neutral U and V lie in the middle of a bin: on the border between two, every grey would flicker. Channels outside [0, 1] are cut off first.
int bin_of(const ColorBins& bins, const Rgb& rgb);

}  // namespace cgsr::imaging
