#include "pipeline/world/weld.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "pipeline/world/map.h"

namespace cgsr::world {
namespace {

using Cell = std::array<std::int64_t, 3>;

std::uint64_t hash_of(const Cell& cell) {
  std::uint64_t h = 0x9E3779B97F4A7C15ULL;
  for (const std::int64_t c : cell) {
    h ^= static_cast<std::uint64_t>(c);
    h *= 0xBF58476D1CE4E5B9ULL;
    h ^= h >> 29U;
  }
  return h;
}

// A grid of cells four tolerances wide, kept as chains of points from a hash of the cell.
class Grid {
 public:
  Grid(std::size_t points, double tolerance_m)
      : tolerance_m_(tolerance_m), cell_m_(4.0 * tolerance_m), heads_(std::bit_ceil(2 * points + 1), kNone) {
    next_.reserve(points);
  }

  [[nodiscard]] std::uint32_t find(const Eigen::Vector3f& p, const std::vector<Eigen::Vector3f>& kept) const {
    Cell low{};
    Cell high{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = static_cast<double>(p[static_cast<Eigen::Index>(i)]);
      low[i] = std::llround(std::floor((x - tolerance_m_) / cell_m_));
      high[i] = std::llround(std::floor((x + tolerance_m_) / cell_m_));
    }
    std::uint32_t first = kNone;
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) first = std::min(first, in_cell({x, y, z}, p, kept));
      }
    }
    return first;
  }

  void add(const Eigen::Vector3f& p) {
    Cell cell{};
    for (std::size_t i = 0; i < 3; ++i)
      cell[i] = std::llround(std::floor(static_cast<double>(p[static_cast<Eigen::Index>(i)]) / cell_m_));
    std::uint32_t& head = heads_[hash_of(cell) & (heads_.size() - 1)];
    next_.push_back(head);
    head = static_cast<std::uint32_t>(next_.size() - 1);
  }

 private:
  [[nodiscard]] std::uint32_t in_cell(const Cell& cell, const Eigen::Vector3f& p,
                                      const std::vector<Eigen::Vector3f>& kept) const {
    std::uint32_t first = kNone;
    for (std::uint32_t i = heads_[hash_of(cell) & (heads_.size() - 1)]; i != kNone; i = next_[i]) {
      if ((kept[i] - p).cast<double>().norm() <= tolerance_m_) first = std::min(first, i);
    }
    return first;
  }

  double tolerance_m_;
  double cell_m_;
  std::vector<std::uint32_t> heads_;
  std::vector<std::uint32_t> next_;
};

}  // namespace

std::vector<std::uint32_t> weld(std::span<const Eigen::Vector3f> points, double tolerance_m,
                                std::vector<Eigen::Vector3f>& kept) {
  kept.clear();
  kept.reserve(points.size());
  Grid grid(points.size(), tolerance_m);
  std::vector<std::uint32_t> became;
  became.reserve(points.size());
  for (const Eigen::Vector3f& p : points) {
    std::uint32_t same = grid.find(p, kept);
    if (same == kNone) {
      same = static_cast<std::uint32_t>(kept.size());
      kept.push_back(p);
      grid.add(p);
    }
    became.push_back(same);
  }
  return became;
}

}  // namespace cgsr::world
