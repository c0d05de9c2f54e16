#pragma once

#include <cstdint>
#include <string_view>

#include "pipeline/color/ball/shade_mask.h"
#include "pipeline/imaging/reduce.h"
#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::color {

/// A rectangle of whole camera pixels that begins at an even column and row, so that its reduced pixels are the image's own.
/// What is searched or compared of an image in light and shade (5.3); the rectangles are ours.
struct ImagePart {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

/// \return whether the mask lies over the image as ShadeMaskView says: not finer than it, rows that do not overlap.
bool can_be_used(const ShadeMaskView& mask, const ImageView& image);

/// \return the part that covers what lies of a box [px] in the image, at least 32 px a side where the image has so much.
ImagePart part_around(const Box& box, const ImageView& image);

/// \return the part of the image that may lie in shade (5.2); width 0: nothing does.
ImagePart shaded_part(const ShadeMaskView& mask, const ImageView& image);

/// \return a view of the part; it owns nothing.
ImageView cut(const ImageView& image, const ImagePart& part);

/// Which labels stay.
enum class Kept : std::uint8_t { kShaded, kLit };
constexpr std::string_view to_string(Kept kept) {
  return kept == Kept::kShaded ? "shaded" : "lit";
}

/// Takes the labels away from what is not kept. \param labels  of the part, reduced.
void keep_only(Kept kept, const ShadeMaskView& mask, const ImageView& image, const ImagePart& part,
               imaging::ReducedImage& labels);

}  // namespace cgsr::color
