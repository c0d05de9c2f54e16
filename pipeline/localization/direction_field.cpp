#include "pipeline/localization/direction_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::localization {
namespace {

constexpr float kSigma_px = 8.0F;
constexpr float kSample_px = 8.0F;
constexpr float kFill_px = 3.0F;
constexpr int kStraight = 3;  // chamfer distances of 3 and 4
constexpr int kDiagonal = 4;

}  // namespace

DirectionField::DirectionField(int width_px, int height_px)
    : width_((width_px + kCell_px - 1) / kCell_px),
      height_((height_px + kCell_px - 1) / kCell_px),
      stride_(static_cast<std::size_t>(width_) + 2),
      plane_size_(stride_ * (static_cast<std::size_t>(height_) + 2)),
      distance_(plane_size_ * kBins, 255) {
  for (std::size_t i = 0; i < value_.size(); ++i) {
    const float distance_px = static_cast<float>(i) / kStraight * kCell_px;
    value_[i] = std::exp(-0.5F * distance_px * distance_px / (kSigma_px * kSigma_px));
  }
}

void DirectionField::spread(std::uint8_t* plane) const {
  const auto relax = [](std::uint8_t& cell, int through) {
    cell = static_cast<std::uint8_t>(std::min<int>(cell, through));
  };
  for (int y = 1; y <= height_; ++y) {
    std::uint8_t* row = plane + static_cast<std::size_t>(y) * stride_;
    const std::uint8_t* above = row - stride_;
    for (int x = 1; x <= width_; ++x) {
      const int straight = std::min(row[x - 1], above[x]) + kStraight;
      const int diagonal = std::min(above[x - 1], above[x + 1]) + kDiagonal;
      relax(row[x], std::min(straight, diagonal));
    }
  }
  for (int y = height_; y >= 1; --y) {
    std::uint8_t* row = plane + static_cast<std::size_t>(y) * stride_;
    const std::uint8_t* below = row + stride_;
    for (int x = width_; x >= 1; --x) {
      const int straight = std::min(row[x + 1], below[x]) + kStraight;
      const int diagonal = std::min(below[x - 1], below[x + 1]) + kDiagonal;
      relax(row[x], std::min(straight, diagonal));
    }
  }
}

void DirectionField::build(const SegmentTable& perceived) {
  perceived_px_ = perceived.whole_length();
  std::fill(distance_.begin(), distance_.end(), std::uint8_t{255});
  for (const PerceivedEdge& edge : perceived.edges()) {
    // The two bins that lie nearest: an edge between them is in both.
    const float turn = std::atan2(edge.direction.y(), edge.direction.x()) / (2.0F * std::numbers::pi_v<float>);
    const int lower = static_cast<int>(std::floor(turn * kBins - 0.5F)) + kBins;
    for (float t = -edge.half_length; t <= edge.half_length; t += kFill_px) {
      const Eigen::Vector2f p = edge.middle + t * edge.direction;
      const int x = static_cast<int>(std::lround(p.x())) / kCell_px;
      const int y = static_cast<int>(std::lround(p.y())) / kCell_px;
      if (p.x() < 0.0F || p.y() < 0.0F || x >= width_ || y >= height_) continue;
      const std::size_t cell = (static_cast<std::size_t>(y) + 1) * stride_ + static_cast<std::size_t>(x) + 1;
      plane(lower % kBins)[cell] = 0;
      plane((lower + 1) % kBins)[cell] = 0;
    }
  }
  for (int bin = 0; bin < kBins; ++bin) spread(plane(bin));
}

float DirectionField::score(std::span<const ProjectedPiece> expected) const {
  float sum = 0.0F;
  float covered_px = 0.0F;
  float whole = 0.0F;
  for (const ProjectedPiece& piece : expected) {
    const float turn = std::atan2(piece.direction.y(), piece.direction.x()) / (2.0F * std::numbers::pi_v<float>);
    const int same = (static_cast<int>(std::floor(turn * kBins)) + kBins) % kBins;
    const int opposite = (same + kBins / 2) % kBins;
    const std::uint8_t* first =
        distance_.data() + static_cast<std::size_t>(piece.bright_side < 0 ? opposite : same) * plane_size_;
    const std::uint8_t* second =
        distance_.data() + static_cast<std::size_t>(piece.bright_side > 0 ? same : opposite) * plane_size_;
    const int samples = std::max(1, static_cast<int>(2.0F * piece.half_length / kSample_px));
    const float step = 2.0F * piece.half_length / static_cast<float>(samples);
    const float weight = step * piece.weight;
    for (int i = 0; i < samples; ++i) {
      const float along = (static_cast<float>(i) + 0.5F) * step - piece.half_length;
      const Eigen::Vector2f p = piece.middle + along * piece.direction;
      const int x = std::clamp(static_cast<int>(std::lround(p.x())) / kCell_px, 0, width_ - 1);
      const int y = std::clamp(static_cast<int>(std::lround(p.y())) / kCell_px, 0, height_ - 1);
      const std::size_t cell = (static_cast<std::size_t>(y) + 1) * stride_ + static_cast<std::size_t>(x) + 1;
      const float value = value_[std::min(first[cell], second[cell])];
      sum += weight * value;
      covered_px += step * value;
      whole += weight;
    }
  }
  // Several expected edges may lie near the same perceived one: it is covered once.
  return whole > 0.0F ? (sum + std::min(covered_px, perceived_px_)) / (whole + perceived_px_) : 0.0F;
}

}  // namespace cgsr::localization
