#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/localization/expected.h"
#include "pipeline/localization/segment_table.h"

namespace cgsr::localization {

/// How near the next perceived edge of a direction is, everywhere in the image: scores a pose without matching anything.
/// Ours: Alg. 4.1 has one start and needs no score. Within each range of directions the distance is the chamfer 3-4 (Borgefors 1986).
/// Pixels are those of the working image without lens.
class DirectionField {
 public:
  DirectionField(int width_px, int height_px);

  /// Costs about 1.5 million instructions at 320x240.
  void build(const SegmentTable& perceived);

  /// \return 0..1, as Estimate::agreement: what has an edge of its direction near by, nearer counting more, of the length expected and
  ///         perceived.
  [[nodiscard]] float score(std::span<const ProjectedPiece> expected) const;

 private:
  static constexpr int kBins = 16;  // over the whole turn
  static constexpr int kCell_px = 4;
  [[nodiscard]] std::uint8_t* plane(int bin) { return distance_.data() + static_cast<std::size_t>(bin) * plane_size_; }
  void spread(std::uint8_t* plane) const;

  int width_;
  int height_;
  std::size_t stride_;
  std::size_t plane_size_;
  float perceived_px_ = 0.0F;
  std::vector<std::uint8_t> distance_;  // thirds of a cell, by bin, with a border of one cell
  std::array<float, 256> value_{};
};

}  // namespace cgsr::localization
