#include "pipeline/world/tree.h"

#include <cstddef>

namespace cgsr::world {
namespace {

constexpr int kBins = 16;

struct Entry {
  Bounds bounds;
  std::uint32_t item = 0;

  [[nodiscard]] float centre(int axis) const { return 0.5F * (bounds.low[axis] + bounds.high[axis]); }
};

// Cuts entries [first, end) in two; both sides get something.
class Cut {
 public:
  Cut(std::vector<Entry>& entries, std::uint32_t first, std::uint32_t end)
      : entries_(entries), first_(first), end_(end) {
    for (std::uint32_t i = first; i < end; ++i) {
      centres_.add(Eigen::Vector3f((0.5F * (entries[i].bounds.low + entries[i].bounds.high)).matrix()));
    }
    (centres_.high - centres_.low).maxCoeff(&axis_);
  }

  [[nodiscard]] int axis() const { return axis_; }

  std::uint32_t make(int depth) {
    std::uint32_t middle = first_;
    // Far down something is odd about the input: halving ends soon.
    if (depth < Tree::kDeepest / 2) middle = by_area();
    if (middle == first_ || middle == end_) {
      middle = first_ + (end_ - first_) / 2;
      const int axis = axis_;
      std::nth_element(at(first_), at(middle), at(end_), [axis](const Entry& a, const Entry& b) {
        const float ca = a.centre(axis);
        const float cb = b.centre(axis);
        return ca != cb ? ca < cb : a.item < b.item;
      });
    }
    return middle;
  }

 private:
  [[nodiscard]] std::vector<Entry>::iterator at(std::uint32_t i) const { return entries_.begin() + i; }

  [[nodiscard]] int bin_of(const Entry& entry) const {
    const float low = centres_.low[axis_];
    const float size = centres_.high[axis_] - low;
    return std::min(kBins - 1, static_cast<int>(static_cast<float>(kBins) * ((entry.centre(axis_) - low) / size)));
  }

  std::uint32_t by_area() {
    if (!(centres_.high[axis_] > centres_.low[axis_])) return first_;
    std::array<Bounds, kBins> box;
    std::array<std::uint32_t, kBins> count{};
    for (std::uint32_t i = first_; i < end_; ++i) {
      const auto bin = static_cast<std::size_t>(bin_of(entries_[i]));
      box[bin].add(entries_[i].bounds);
      ++count[bin];
    }
    std::array<float, kBins> from_right{};
    Bounds grown;
    std::uint32_t seen = 0;
    for (std::size_t i = kBins - 1; i > 0; --i) {
      grown.add(box[i]);
      seen += count[i];
      from_right[i] = seen == 0 ? 0.0F : grown.half_area() * static_cast<float>(seen);
    }
    grown = {};
    seen = 0;
    float best = std::numeric_limits<float>::max();
    int cut = 0;
    for (int i = 1; i < kBins; ++i) {
      const auto left = static_cast<std::size_t>(i - 1);
      grown.add(box[left]);
      seen += count[left];
      if (seen == 0 || seen == end_ - first_) continue;
      const float cost = grown.half_area() * static_cast<float>(seen) + from_right[left + 1];
      if (cost < best) {
        best = cost;
        cut = i;
      }
    }
    if (cut == 0) return first_;
    const auto middle = std::partition(at(first_), at(end_), [&](const Entry& e) { return bin_of(e) < cut; });
    return first_ + static_cast<std::uint32_t>(middle - at(first_));
  }

  std::vector<Entry>& entries_;
  std::uint32_t first_;
  std::uint32_t end_;
  Bounds centres_;
  int axis_ = 0;
};

}  // namespace

Tree::Tree(std::span<const Bounds> items, std::uint32_t leaf) {
  if (items.empty()) return;
  std::vector<Entry> entries(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) entries[i] = {items[i], static_cast<std::uint32_t>(i)};

  struct Task {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
    std::uint32_t parent = 0;  // whose right child it is; 0 for left children, which follow their parents.
    int depth = 0;
  };
  std::vector<Task> tasks{{0, static_cast<std::uint32_t>(items.size()), 0, 0}};
  nodes_.reserve(4 * (items.size() / std::max(1U, leaf)) + 1);
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    if (task.parent != 0) nodes_[task.parent - 1].right = at;
    Bounds box;
    for (std::uint32_t i = task.first; i < task.end; ++i) box.add(entries[i].bounds);
    nodes_.push_back({box.low, box.high, task.first, task.end, 0, 0});
    if (task.end - task.first <= leaf) continue;
    Cut cut(entries, task.first, task.end);
    const std::uint32_t middle = cut.make(task.depth);
    nodes_[at].axis = static_cast<std::uint32_t>(cut.axis());
    tasks.push_back({middle, task.end, at + 1, task.depth + 1});
    tasks.push_back({task.first, middle, 0, task.depth + 1});
  }
  nodes_.shrink_to_fit();
  order_.reserve(entries.size());
  for (const Entry& entry : entries) order_.push_back(entry.item);
}

}  // namespace cgsr::world
