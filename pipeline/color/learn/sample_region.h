#pragma once

#include <vector>

#include "pipeline/color/learn/color_model.h"
#include "pipeline/imaging/reduce.h"
#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::color {

/// A rectangle of whole pixels of a reduced image: the region of interest of Alg. 3.1, line 2.
struct PixelRect {
  int left = 0;
  int top = 0;
  int right = 0;   ///< exclusive
  int bottom = 0;  ///< exclusive

  [[nodiscard]] int width() const { return right - left; }
  [[nodiscard]] int height() const { return bottom - top; }
  [[nodiscard]] bool contains(int x, int y) const { return x >= left && x < right && y >= top && y < bottom; }
};

/// \return the box grown by `share` of its sides on each side, on whole pixels of an image reduced by `factor`, cut off at its edges.
///         For widening (3.1.2), and for the ring whose colours are negatives (after 6.2.2).
PixelRect grown(const Box& box, double share, const imaging::ReducedImage& image);

/// \param coded  an image reduced with the colour codes themselves as labels.
/// \return the colours inside `rect`, or those inside `rect` but outside `hole`.
std::vector<imaging::Rgb> colors_in(const imaging::ReducedImage& coded, const PixelRect& rect);
std::vector<imaging::Rgb> colors_around(const imaging::ReducedImage& coded, const PixelRect& rect,
                                        const PixelRect& hole);

/// Cuts the window and half its size around it out of a YUYV image and makes it small (area means, never enlarged): at most kMaxPatchSide.
SamplePatch cut_patch(const ImageView& image, const Box& window, const Light& light);

}  // namespace cgsr::color
