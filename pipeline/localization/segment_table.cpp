#include "pipeline/localization/segment_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::localization {
namespace {

// Shadows, reflections and noise make weak edges; the things in a map mostly make strong ones.
constexpr float kSureContrast = 30.0F;  // grey levels
constexpr float kLeastWeight = 0.25F;
// What is printed on a sheet, or woven, is in no map: many short edges. A long one is rather a thing's.
constexpr float kFullWeight_px = 60.0F;  // this long, it says all it can

// A pattern, of slats, folds or books, is many edges side by side and in no map: all of it says hardly more than some of them.
constexpr float kPatternReach_px = 25.0F;
constexpr float kLeastBeside_px = 1.0F;  // nearer it is one edge, found twice
constexpr int kNoPattern = 2;            // a thing's own borders
constexpr int kMostLookedAt = 100;       // bounds the work where all edges are of one direction

}  // namespace

SegmentTable::SegmentTable(std::size_t capacity) : capacity_(capacity) {
  added_.reserve(capacity);
  sorted_.reserve(capacity);
  x_.reserve(capacity);
  y_.reserve(capacity);
  half_length_.reserve(capacity);
}

void SegmentTable::clear() {
  added_.clear();
  sorted_.clear();
  first_.fill(0);
}

void SegmentTable::add(const PerceivedEdge& edge) {
  if (added_.size() < capacity_) added_.push_back(edge);
}

int SegmentTable::bin_of(const Eigen::Vector2f& direction) {
  const float turn = std::atan2(direction.y(), direction.x()) / (2.0F * std::numbers::pi_v<float>);  // -0.5 .. 0.5
  const int bin = static_cast<int>(std::floor(turn * kBins)) + kBins;
  return bin % kBins;
}

int SegmentTable::beside(std::size_t index) const {
  const PerceivedEdge& edge = sorted_[index];
  const Eigen::Vector2f normal = edge.normal();
  const int own = bin_of(edge.direction);
  int count = 0;
  int looked_at = 0;
  for (int turn = 0; turn < 2; ++turn) {  // the other border of a slat is dark on the other side
    for (int step = -1; step <= 1; ++step) {
      const int bin = (own + turn * kBins / 2 + step + kBins) % kBins;
      for (std::size_t i = first_of(bin); i < first_of(bin + 1); ++i) {
        if (count == kMostBeside || ++looked_at > kMostLookedAt) return count;
        const Eigen::Vector2f offset(x_[i] - edge.middle.x(), y_[i] - edge.middle.y());
        const float across = std::abs(offset.dot(normal));
        if (across < kLeastBeside_px || across > kPatternReach_px) continue;
        const float along = std::abs(offset.dot(edge.direction));
        if (edge.half_length + half_length_[i] - along > edge.half_length && half_length_[i] > 0.5F * edge.half_length)
          ++count;
      }
    }
  }
  return count;
}

void SegmentTable::finish() {
  // By counting: the edges of a bin keep their order.
  std::array<std::size_t, kBins> next{};
  for (const PerceivedEdge& edge : added_) ++next[static_cast<std::size_t>(bin_of(edge.direction))];
  std::size_t sum = 0;
  for (std::size_t bin = 0; bin < next.size(); ++bin) {
    first_[bin] = sum;
    sum += next[bin];
    next[bin] = first_[bin];
  }
  first_[kBins] = sum;
  sorted_.resize(sum);
  x_.resize(sum);
  y_.resize(sum);
  half_length_.resize(sum);
  whole_length_ = 0.0F;
  weighted_length_ = 0.0F;
  for (const PerceivedEdge& edge : added_) {
    const std::size_t i = next[static_cast<std::size_t>(bin_of(edge.direction))]++;
    sorted_[i] = edge;
    sorted_[i].weight = std::clamp(edge.contrast / kSureContrast, kLeastWeight, 1.0F);
    x_[i] = edge.middle.x();
    y_[i] = edge.middle.y();
    half_length_[i] = edge.half_length;
    const float length = 2.0F * edge.half_length;
    sorted_[i].information_weight = sorted_[i].weight * std::min(1.0F, length / kFullWeight_px);
    whole_length_ += length * sorted_[i].weight;
  }
  for (std::size_t i = 0; i < sum; ++i) {
    sorted_[i].information_weight /= static_cast<float>(1 + std::max(0, beside(i) - kNoPattern));
    weighted_length_ += 2.0F * sorted_[i].half_length * sorted_[i].information_weight;
  }
}

}  // namespace cgsr::localization
