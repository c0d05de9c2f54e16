#include "pipeline/person/tracking/shirt_regions.h"

#include <algorithm>

#include "pipeline/person/colors/color_labels.h"

namespace cgsr::person {
namespace {

constexpr double kTrunkWidth = 2.2;  // in widths of the face

}  // namespace

SamplingRegions sampling_regions(const MarkerSighting& marker) {
  constexpr double kMargin = 0.3;  // below the black square, in sides of it: a white cell and some more
  constexpr double kHeight = 0.8;  // in widths of the face: the shirt does not go on much farther
  SamplingRegions regions = sampling_regions(marker.face);
  regions.shirt = {marker.face.x, marker.box.y + (1.0 + kMargin) * marker.box.height, marker.face.width,
                   kHeight * marker.face.width};
  return regions;
}

// From the upper edge that face_above() supposes down to the hips.
Box trunk_below(const Box& face) {
  constexpr double kFromFace = 1.2, kHeight = 3.2;  // in heights of the face
  const double width = kTrunkWidth * face.width;
  return {face.x + (face.width - width) / 2, face.y + kFromFace * face.height, width, kHeight * face.height};
}

double face_px_of_trunk(double width) {
  return width / kTrunkWidth;
}

std::array<Box, 2> beside_trunk(const Box& trunk) {
  constexpr double kGap = 0.1, kWidth = 0.5;  // in widths of the trunk
  const double gap = kGap * trunk.width, width = kWidth * trunk.width;
  return {Box{trunk.x - gap - width, trunk.y, width, trunk.height},
          Box{trunk.x + trunk.width + gap, trunk.y, width, trunk.height}};
}

Box shirt_window(const Box& head, int image_height_px) {
  constexpr double kBeside = 3.5, kFromChin = 0.5;  // in sides of the face
  const double middle = head.x + head.width / 2, top = head.y + (1.0 - kFromChin) * head.height;
  return {middle - kBeside * head.width, top, 2.0 * kBeside * head.width, std::max(0.0, image_height_px - top)};
}

// Blobs are found in pixels of ColorLabels::kFactor: the last ones may end before the border.
bool is_cut_in_height(const Box& blob, const ImageView& image) {
  return blob.y <= 0.0 || blob.y + blob.height > image.height_px - ColorLabels::kFactor;
}

bool is_cut_in_width(const Box& blob, const ImageView& image) {
  return blob.x <= 0.0 || blob.x + blob.width > image.width_px - ColorLabels::kFactor;
}

}  // namespace cgsr::person
