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

/// Width and height of what face_crop() cuts: a face of 128 px and a margin of 26 around it.
inline constexpr int kFaceCrop_px = 180;

/// A face that was enrolled: descriptors on the coarse grid, row by row. 10 kB; the face cannot be drawn from it, but it identifies a person.
using FaceView = std::array<std::uint8_t, kViewSide * kViewSide * kSiftSize>;

/// A face as it is seen: descriptors on the dense grid.
struct FaceDescriptor {
  std::vector<std::uint8_t> dense;  ///< kDenseSide^2 descriptors, row by row.
};

/// Where a face lies in its crop against an enrolled view: what is at (x, y) from the middle of the grid in the view is at
/// ((1 + a) x - b y + dx, b x + (1 + a) y + dy) in the crop [px of the crop]: a shift, turn and scale.
struct FaceAlignment {
  double a = 0.0, b = 0.0, dx_px = 0.0, dy_px = 0.0;

  /// \return whether descriptors on the grid allow for it as it is: within a step of the dense grid (4 px) everywhere in the face.
  [[nodiscard]] bool is_small() const;
  /// \param share  of `other`, 0..1: this one becomes the mean of both, so weighted.
  void move_towards(const FaceAlignment& other, double share);
};

/// Describes the face in a box: contrast made equal everywhere, then SIFT descriptors on a grid that moves and grows with the box. The
/// dissertation (6.2.1) finds SIFT points in the crop; on a grid there are as many in a dark face as in a bright one.
///
/// \param image  at the camera's full resolution.  \param face  as FaceDetector gives it.
/// \return nothing: the crop is empty or lies outside of the image.
/// Cost: 11 million instructions, allocates: for the trainer's thread, not for the frame path.
std::optional<FaceDescriptor> describe_face(const ImageView& image, const Box& face);

/// The pixels that describe_face() reads: the face and a margin around it, grey, kFaceCrop_px x kFaceCrop_px. To be described later, on another thread.
/// \return empty: the crop is empty or lies outside of the image.
GreyPatch face_crop(const ImageView& image, const Box& face);

/// Describes what face_crop() cut. \return nothing: it is no such crop. Cost: as describe_face().
std::optional<FaceDescriptor> describe_crop(const GreyPatch& crop);

/// \return the crop cut again so that its face lies as in the view; its border goes on beyond it. The crop itself where it is none.
GreyPatch aligned_crop(const GreyPatch& crop, const FaceAlignment& alignment);

/// \return what is kept of a face when it is enrolled.
FaceView view_of(const FaceDescriptor& face);

/// How alike a seen face and an enrolled one are with every point at its own place, larger for more alike: to choose whom to compare well.
/// Cost: 10 thousand instructions.
std::int64_t rough_likeness(const FaceDescriptor& face, const FaceView& view);

/// How far a seen face is from an enrolled one: for each of the view's points 1 - cosine to the best descriptor at most 3 steps (a tenth of the face)
/// from the same place, and farther the farther that one lies from where a shift, turn and scale of the whole face, fitted to all points, puts it: the
/// geometric check. Ours; Lowe (2004) fits such a similarity to matched points.
/// \param distances  out: per point; the caller takes the smallest over the views of a person.
/// \return that shift, turn and scale.
FaceAlignment view_distances(const FaceDescriptor& face, const FaceView& view,
                             std::array<double, kViewSide * kViewSide>& distances);

}  // namespace cgsr::person
