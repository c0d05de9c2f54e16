#include "pipeline/person/tracking/shirt_regions.h"

#include <algorithm>
#include <cmath>

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

// In a light that changes a blob loses its darker sides first: the shirt is as large as it was, and gets smaller slowly. It is not elsewhere for that: it moves
// as far as what is seen of it leads out of where it was.
Box settled(const Box& before, const Box& now) {
  constexpr double kShrinks = 0.998;  // in an image
  const double width = std::max(now.width, kShrinks * before.width);
  const double height = std::max(now.height, kShrinks * before.height);
  const double x = before.x + (before.width - width) / 2, y = before.y + (before.height - height) / 2;
  return {std::clamp(x, now.x - (width - now.width), now.x), std::clamp(y, now.y - (height - now.height), now.y), width,
          height};
}

// Colours that are found beside the marker, or in a part of the shirt alone, are no longer those of the shirt (relative position and size may issue a
// re-training, 6.3.1).
bool lies_under(const Box& shirt, const MarkerSighting& marker) {
  constexpr double kMinShare = 0.5;  // of where it would be sampled
  const Box expected = sampling_regions(marker).shirt;
  return intersection(shirt, expected).area() >= kMinShare * expected.area();
}

// Of a face low in the image, or at its side, the shirt is out of view: a few pixels of it teach neither its colours nor the light on it.
bool is_in_view(const Box& shirt, const ImageView& image) {
  constexpr double kMinInView = 0.5;  // of its area
  return intersection(shirt, {0.0, 0.0, double(image.width_px), double(image.height_px)}).area() >=
         kMinInView * shirt.area();
}

std::optional<double> growth_of(const Box& before, const Box& now, const ImageView& image) {
  constexpr double kLargest = 0.08;
  const bool is_high = is_cut_in_height(before, image) || is_cut_in_height(now, image);
  if (before.empty() || is_cut_in_width(before, image) || is_cut_in_width(now, image)) return std::nullopt;
  const double wider = now.width / before.width, higher = is_high ? std::max(1.0, wider) : now.height / before.height;
  if (std::abs(wider - 1.0) > kLargest || std::abs(higher - 1.0) > kLargest) return std::nullopt;
  return higher >= 1.0 ? std::min(higher, std::max(1.0, wider)) : std::max(higher, std::min(1.0, wider));
}

}  // namespace cgsr::person
