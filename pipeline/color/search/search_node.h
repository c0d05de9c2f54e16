#pragma once

#include <array>
#include <cstdint>

namespace cgsr::color {

/// A level of the tree of windows: squares of neighbouring positions, of all sizes together or of one size.
/// The tree is that of a best-first branch and bound over sets of windows (Lampert et al. 2008); its levels are ours.
struct SearchLevel {
  int positions = 1;  ///< per side of the square.
  bool all_sizes = false;
  bool exact = false;    ///< bounded by exactly the pixels its windows reach, or by whole blocks around them.
  bool refined = false;  ///< bounded by what all its windows share as well.
};

/// From squares of 8 x 8 positions of all sizes down to the windows themselves. Found by counting instructions on real images:
/// neither fewer levels nor splitting the sizes sooner or later does better.
inline constexpr std::array<SearchLevel, 5> kSearchTree{{
    {8, true, false, false},
    {4, true, false, false},
    {4, false, false, true},
    {2, false, true, true},
    {1, false, true, false},
}};
inline constexpr int kWindowLevel = static_cast<int>(kSearchTree.size()) - 1;

/// A node of the tree as one number that sorts as the search visits: higher rank first; of equal ranks inner nodes before windows, so that a
/// window comes up only when nothing unexplored could equal it; of equal windows the lower size, light, y, x.
class SearchNode {
 public:
  /// \param rank  -32768..32767, of an inner node a bound. \param x, y  position of its first window, 0..32767.
  SearchNode(int rank, int level, int size, int light, int y, int x)
      : key_(put(kRank, rank + kRankOffset) | put(kLevel, kWindowLevel - level) | put(kSize, kSize.most() - size) |
             put(kLight, kLight.most() - light) | put(kY, kY.most() - y) | put(kX, kX.most() - x)) {}

  [[nodiscard]] int rank() const { return get(kRank) - kRankOffset; }
  [[nodiscard]] int level() const { return kWindowLevel - get(kLevel); }
  [[nodiscard]] int size() const { return kSize.most() - get(kSize); }
  [[nodiscard]] int light() const { return kLight.most() - get(kLight); }
  [[nodiscard]] int y() const { return kY.most() - get(kY); }
  [[nodiscard]] int x() const { return kX.most() - get(kX); }
  friend bool operator<(const SearchNode& a, const SearchNode& b) { return a.key_ < b.key_; }

 private:
  struct Field {
    int shift;
    int bits;
    [[nodiscard]] constexpr int most() const { return (1 << bits) - 1; }
  };
  static constexpr Field kX{0, 15};
  static constexpr Field kY{15, 15};
  static constexpr Field kLight{30, 7};
  static constexpr Field kSize{37, 3};
  static constexpr Field kLevel{40, 3};
  static constexpr Field kRank{43, 16};
  static constexpr int kRankOffset = 1 << 15;

  static std::uint64_t put(Field field, int value) { return static_cast<std::uint64_t>(value) << field.shift; }
  [[nodiscard]] int get(Field field) const { return static_cast<int>(key_ >> field.shift) & field.most(); }
  std::uint64_t key_;
};

}  // namespace cgsr::color
