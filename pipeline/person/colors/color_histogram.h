#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/imaging/color_code.h"
#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::person {

/// How often each of 64 x 64 x 64 colours was met (6.2.2). Old samples fade as new ones come, so its mass is bounded.
class ColorHistogram {
 public:
  static constexpr int kPerChannel = 64;

  void add(std::span<const imaging::Rgb> samples);
  void clear();
  [[nodiscard]] bool empty() const { return total_ == 0; }

  /// \return the share of the samples that have this colour or one at most `reach` bins away in each channel, in [0, 1].
  [[nodiscard]] double share(const imaging::Rgb& color, int reach = 1) const;
  /// For each colour, by bin(): whether share() is above 0. Empty where nothing was met.
  [[nodiscard]] std::vector<std::uint8_t> met_nearby(int reach = 1) const;
  /// \return the place of a colour in met_nearby().
  [[nodiscard]] static std::size_t bin(const imaging::Rgb& color);
  /// The brightest level of each channel that 2 % of the samples reach: what Alg. 3.1 takes the light from, with outliers left out.
  [[nodiscard]] imaging::Rgb bright_level() const;

 private:
  void fade();

  std::vector<std::uint16_t> counts_;  // allocated with the first sample
  std::uint32_t total_ = 0;
};

/// The colours of a region, a sample for each 2x2 pixels, as the decode stage sees them: the middle of their colour code.
/// \param image  YUYV.  \return empty outside of the image, or for another pixel format.
std::vector<imaging::Rgb> region_colors(const ImageView& image, const Box& region);

}  // namespace cgsr::person
