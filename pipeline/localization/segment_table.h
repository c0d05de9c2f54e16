#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace cgsr::localization {

/// A perceived straight edge with the lens taken out: pixels of the working image, as a pinhole would show them
/// (Alg. 4.1, line 3).
struct PerceivedEdge {
  Eigen::Vector2f middle = Eigen::Vector2f::Zero();
  Eigen::Vector2f direction = Eigen::Vector2f::UnitX();  ///< unit; (-y, x) of it points to the brighter side.
  float half_length = 0.0F;
  float contrast = 0.0F;  ///< grey levels.
  float sigma_px = 0.1F;  ///< of the line, across.
  float weight =
      1.0F;  ///< how sure it is to be an edge of things, not of their light, 0..1; from the contrast, by SegmentTable.
  float information_weight =
      1.0F;  ///< how much it says for a pose that expects it, or against one that does not, 0..1; likewise.

  [[nodiscard]] Eigen::Vector2f normal() const { return {-direction.y(), direction.x()}; }
};

/// Perceived edges in the order of their direction, so that those that lie like an expected one are a run, or two. What the first test of a
/// pair reads lies in plain arrays for that test's sake.
class SegmentTable {
 public:
  static constexpr int kBins = 72;  ///< of 5 degrees over the whole turn.

  explicit SegmentTable(std::size_t capacity);

  void clear();
  /// Ignored when full.
  void add(const PerceivedEdge& edge);
  /// Sorts; between add() and the rest.
  void finish();

  [[nodiscard]] std::span<const PerceivedEdge> edges() const { return sorted_; }
  [[nodiscard]] std::size_t size() const { return sorted_.size(); }

  /// Index of the first edge whose bin is `bin`; kBins: size().
  [[nodiscard]] std::size_t first_of(int bin) const { return first_[static_cast<std::size_t>(bin)]; }
  /// Of all edges together, each by its weight, pixels.
  [[nodiscard]] float whole_length() const { return whole_length_; }
  /// Likewise, each by how much it tells.
  [[nodiscard]] float weighted_length() const { return weighted_length_; }
  static int bin_of(const Eigen::Vector2f& direction);

  [[nodiscard]] const float* x() const { return x_.data(); }
  [[nodiscard]] const float* y() const { return y_.data(); }
  [[nodiscard]] const float* half_length() const { return half_length_.data(); }

 private:
  /// \return how many edges run beside one, close by and along half of it: slats, folds, the backs of books. At most kMostBeside.
  [[nodiscard]] int beside(std::size_t index) const;

  static constexpr int kMostBeside = 10;

  std::size_t capacity_;
  std::vector<PerceivedEdge> added_;
  std::vector<PerceivedEdge> sorted_;
  std::vector<float> x_;
  std::vector<float> y_;
  std::vector<float> half_length_;
  float whole_length_ = 0.0F;
  float weighted_length_ = 0.0F;
  std::array<std::size_t, kBins + 1> first_{};
};

}  // namespace cgsr::localization
