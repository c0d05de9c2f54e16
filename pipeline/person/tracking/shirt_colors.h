#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pipeline/imaging/color_code.h"
#include "pipeline/person/colors/part_light.h"
#include "platform/box.h"
#include "platform/image_view.h"

// The colours of pixels in and beside a shirt: what its light is told by, and what is learned of it. Ours (6.2.2 samples below a face alone).
namespace cgsr::person {

/// \return the mean colours of a shirt and of what is beside it; nothing: either is outside of the image.
std::optional<PartColors> part_colors(const ImageView& image, const Box& shirt);

/// \return the colours of the pixels of two regions.
std::vector<imaging::Rgb> colors_of_both(const ImageView& image, const std::array<Box, 2>& regions);

/// \return colours that are surely a trunk's own: of its middle, at most 800, without what is more frequent beside it.
std::vector<imaging::Rgb> trunk_colors(const ImageView& image, const Box& trunk);

}  // namespace cgsr::person
