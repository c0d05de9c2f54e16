#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace cgsr::world {

/// An axis-aligned box; empty until something was added.
struct Bounds {
  Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::max());
  Eigen::Array3f high = Eigen::Array3f::Constant(std::numeric_limits<float>::lowest());

  void add(const Eigen::Vector3f& p) {
    low = low.min(p.array());
    high = high.max(p.array());
  }
  void add(const Bounds& other) {
    low = low.min(other.low);
    high = high.max(other.high);
  }
  [[nodiscard]] float half_area() const {
    const Eigen::Array3f size = (high - low).max(0.0F);
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

/// A hierarchy of boxes over items, split by the surface-area heuristic in 16 bins (Wald 2007) (the median where that finds nothing). The items of every
/// node lie side by side in `order`, so that a node that is wanted as a whole is a range.
class Tree {
 public:
  struct Node {
    Eigen::Array3f low;
    Eigen::Array3f high;
    std::uint32_t first = 0;  ///< items: order[first .. end).
    std::uint32_t end = 0;
    std::uint32_t right = 0;  ///< the left child is the next node; 0: a leaf.
    std::uint32_t axis = 0;   ///< that its children lie along, left below right.
  };
  static constexpr int kDeepest = 96;  ///< a stack of so many nodes is enough for every walk.

  Tree() = default;
  Tree(std::span<const Bounds> items, std::uint32_t leaf);

  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }
  [[nodiscard]] std::size_t bytes() const { return nodes_.size() * sizeof(Node) + order_.size() * sizeof(order_[0]); }

  /// Calls found(item) for all whose node's box meets the given one.
  template <class Found>
  void touching(const Bounds& box, const Found& found) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, kDeepest> stack;
    std::size_t waiting = 0;
    std::uint32_t at = 0;
    for (;;) {
      const Node& node = nodes_[at];
      const bool meets = (node.low <= box.high).all() && (node.high >= box.low).all();
      if (meets && node.right != 0) {
        stack[waiting++] = node.right;
        ++at;
        continue;
      }
      if (meets) {
        for (std::uint32_t i = node.first; i < node.end; ++i) found(order_[i]);
      }
      if (waiting == 0) return;
      at = stack[--waiting];
    }
  }

 private:
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace cgsr::world
