#pragma once

#include <cstdint>
#include <span>

#include "pipeline/imaging/pyramid.h"

namespace cgsr::color {

inline constexpr int kOrientations = 9;

/// Histograms of gradient orientations over square cells (HOG, Dalal and Triggs 2005; per cell the sum of the four block-normalised
/// and clipped vectors, as Felzenszwalb et al. 2010 have it, without the signed orientations). They keep shape and forget light.
///
/// Each pixel's gradient magnitude is shared out bilinearly to the four nearest cells and linearly to the two nearest of nine unsigned
/// orientations.
/// \param luma  patch of `size`, whose sides are multiples of `cell_px`. \param cell_px  2 or 4.
/// \param out  kOrientations planes of (width / cell) x (height / cell) values in [0, 0.4], one after the other.
void orientation_histograms(std::span<const std::uint8_t> luma, imaging::PatchSize size, int cell_px,
                            std::span<float> out);

/// Largest patch: 64x64 pixels in cells of 2.
inline constexpr int kMaxHistogramCells = 32 * 32;

}  // namespace cgsr::color
