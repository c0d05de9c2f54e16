#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "pipeline/imaging/color_code.h"
#include "platform/image_view.h"

namespace cgsr::imaging {

/// What each 16-bit colour code is called: a label of the user's choice, kColorCodes of them.
using LabelTable = std::vector<std::uint16_t>;

/// What the chapters need of a camera image instead of a BGR picture: its grey and a label per pixel. Both planes are tight
/// (row stride = width_px). A pixel of it stands for factor x factor pixels of the camera image.
struct ReducedImage {
  /// Reserves for camera images up to this size at factor 1, so that reduce() never allocates.
  ReducedImage(int max_width_px, int max_height_px);

  int factor = 2;
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> grey;
  std::vector<std::uint16_t> labels;
};

/// Why an image was not reduced.
enum class ReduceFailure : std::uint8_t {
  kNotYuyv,    ///< the image is of another pixel format.
  kBadSize,    ///< smaller than 16x16, an odd width, or larger than the ReducedImage was made for.
  kBadFactor,  ///< neither 1 nor 2.
  kBadTable,   ///< the label table has not kColorCodes entries.
};
std::string_view to_string(ReduceFailure failure);

/// One pass over a YUYV image: factor 2 averages 2x2 pixels (rounded half up), factor 1 keeps every pixel and shares its pair's
/// chroma. An odd last row is left out at factor 2. grey is the mean luma as the camera coded it, labels is table[colour code].
/// Ours: the dissertation (3.2.2) counts the pixels of the camera's RGB image.
///
/// Cost at 640x480 and factor 2: about 0.6 million instructions (SSE2). No allocation.
tl::expected<void, ReduceFailure> reduce(const ImageView& image, int factor, const LabelTable& table,
                                         ReducedImage& out);

/// \return 2, or 1 where that would leave too little: for small images (shorter side below 200 px) and for objects whose shorter
///         side is below 24 px in images of at most 400 px height.
int reduction_for(int width_px, int height_px, double object_shorter_side_px);

}  // namespace cgsr::imaging
