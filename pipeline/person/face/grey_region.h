#pragma once

#include <cstdint>
#include <vector>

#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::person {

/// A small grey picture that owns its pixels; rows are tight.
struct GreyPatch {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> pixels;
};

/// Cuts a region out of an image and scales it: the mean of the pixels where it shrinks, linear where it grows. Pixels outside of the image
/// are those of its border, so a face that is cut off keeps its place. The multi-resolution images of section 6.2 are such regions.
///
/// \param image  YUYV, grey or B G R.  \param region  in its pixels; rounded to whole ones.
/// \return empty where the image or the region is empty, or where they do not meet.
GreyPatch grey_region(const ImageView& image, const Box& region, int width_px, int height_px);

/// The same for finding faces: halved as often as it can be, then linear, which is cheaper and a little less smooth; a pixel at the right and lower edge may
/// be left out, and the rest is stretched over its place.
GreyPatch quick_grey_region(const ImageView& image, const Box& region, int width_px, int height_px);

/// OpenCV's cascades pass over every window whose grey values deviate by less than ten: a face in little light, or whose brows and hair are nearly as light
/// as its skin, in the values 16 to 235 of a camera. What they look at is stretched, by no more than noise allows.
inline constexpr double kMaxStretch = 3.0;

/// Spreads a patch's values over 0 to 255, but no farther than by a factor; a few in a thousand of the darkest and the brightest are cut off.
void stretch_contrast(GreyPatch& patch, double max_factor = kMaxStretch);

/// Contrast limited adaptive histogram equalisation (Zuiderveld, 1994), OpenCV's: stretching does not help a dark face before a bright wall.
/// \return a whole image, grey.
GreyPatch equalized_locally(const ImageView& image);

}  // namespace cgsr::person
