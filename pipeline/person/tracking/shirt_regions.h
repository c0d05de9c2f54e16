#pragma once

#include <array>
#include <optional>

#include "pipeline/person/colors/person_colors.h"
#include "pipeline/person/marker/marker_tracks.h"
#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::person {

/// Where colours are sampled around a marker on a shirt: below its white margin, nearly as large as a face; the background beside the face as for a face
/// (Fig. 6.3), where neither shirt nor arms are.
SamplingRegions sampling_regions(const MarkerSighting& marker);

/// \return the trunk below a face, as wide and high as a shirt without its sleeves is. Ours.
Box trunk_below(const Box& face);
/// \return the width of the face above a trunk of such a width.
double face_px_of_trunk(double width);
/// \return what is to the left and right of a trunk, and surely not it.
std::array<Box, 2> beside_trunk(const Box& trunk);

/// \return where below a head (a face's box) the shirt of the same person may be, down to the image's lower border: what has its colours beside, above or far
///     below is something else. Generous: a head is turned, a shirt partly covered. Ours (6.3.1, relative position).
Box shirt_window(const Box& head, int image_height_px);

/// Whether a blob of the labels' image ends at the image's upper or lower border, or at its left or right one: it may go on beyond.
bool is_cut_in_height(const Box& blob, const ImageView& image);
bool is_cut_in_width(const Box& blob, const ImageView& image);

/// \return where a shirt is that was at `before` and whose blob is at `now`.
Box settled(const Box& before, const Box& now);

/// Whether a shirt that was found is the one under a marker.
bool lies_under(const Box& shirt, const MarkerSighting& marker);

/// Whether enough of where a shirt is expected is within the image.
bool is_in_view(const Box& shirt, const ImageView& image);

/// How many times as large a blob is as it was: by the side that has changed less, 1 where one has grown and the other has not; nothing where something else was
/// joined or torn off. Of one that the image cuts in height the width says that it is nearer.
std::optional<double> growth_of(const Box& before, const Box& now, const ImageView& image);

}  // namespace cgsr::person
