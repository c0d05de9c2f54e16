#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/person/face/grey_region.h"
#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::person {

/// Numbers of one SIFT descriptor: 4 x 4 cells of 8 directions (Lowe, 2004), each the square root of its share (Arandjelovic and Zisserman, 2012).
inline constexpr int kSiftSize = 128;
/// Points on the grid over a face at which a person's view is kept: 9 x 9, every third of the dense grid.
inline constexpr int kViewSide = 9;
/// Points of the dense grid with which a seen face is compared: 31 x 31, so that every point of a view may lie 3 steps off.
inline constexpr int kDenseSide = 31;

/// A face that was enrolled: descriptors on the coarse grid, row by row. 10 kB; the face cannot be drawn from it, but it identifies a person.
using FaceView = std::array<std::uint8_t, kViewSide * kViewSide * kSiftSize>;

/// A face as it is seen: descriptors on the dense grid.
struct FaceDescriptor {
  std::vector<std::uint8_t> dense;  ///< kDenseSide^2 descriptors, row by row.
};

/// Describes the face in a box: contrast made equal everywhere, then SIFT descriptors on a grid that moves and grows with the box. The
/// dissertation (6.2.1) finds SIFT points in the crop; on a grid there are as many in a dark face as in a bright one.
///
/// \param image  at the camera's full resolution.  \param face  as FaceDetector gives it.
/// \return nothing: the crop is empty or lies outside of the image.
/// Cost: 37 million instructions, allocates: for the trainer's thread, not for the frame path.
std::optional<FaceDescriptor> describe_face(const ImageView& image, const Box& face);

/// The pixels that describe_face() reads: the face and a margin around it, grey, 180 x 180. To be described later, on another thread.
/// \return empty: the crop is empty or lies outside of the image.
GreyPatch face_crop(const ImageView& image, const Box& face);

/// Describes what face_crop() cut. \return nothing: it is no such crop. Cost: as describe_face().
std::optional<FaceDescriptor> describe_crop(const GreyPatch& crop);

/// \return what is kept of a face when it is enrolled.
FaceView view_of(const FaceDescriptor& face);

/// How far a seen face is from an enrolled one: for each of the view's points 1 - cosine to the best descriptor at most 3 steps (a tenth of the face)
/// from the same place, and farther the farther that one lies from where a shift, turn and scale of the whole face, fitted to all points, puts it: the
/// geometric check. Ours; Lowe (2004) fits such a similarity to matched points.
/// \return per point, added to nothing: the caller takes the smallest over the views of a person.
void view_distances(const FaceDescriptor& face, const FaceView& view,
                    std::array<double, kViewSide * kViewSide>& distances);

}  // namespace cgsr::person
