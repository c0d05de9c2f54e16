#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace cgsr::illumination {

/// Four samples at a time.
using Lane = Eigen::Array4f;
inline constexpr int kLane = 4;

/// The normal equations of Gauss and Newton over N unknowns, in single precision while they grow. Ours, for the fits that
/// stand in for the lines of Alg. 5.1.
template <int N>
class LaneSums {
 public:
  static constexpr std::size_t kResidual = N;
  /// The derivatives by the unknowns and, at kResidual, the residual.
  using Row = std::array<Lane, N + 1>;

  LaneSums() {
    for (Row& row : table_) row.fill(Lane::Zero());
  }

  /// \param weight  0 for a sample that is not there.
  void add(const Row& j, const Lane& weight) {
    for (std::size_t a = 0; a < N; ++a) {
      const Lane weighted = weight * j[a];
      for (std::size_t b = a; b <= kResidual; ++b) table_[a][b] += weighted * j[b];
    }
    squares_ += weight * j[kResidual] * j[kResidual];
    weights_ += weight;
  }

  /// \param sums  its members H, g, squares and weights are set.
  template <class Sums>
  void put_into(Sums& sums) const {
    for (int a = 0; a < N; ++a) {
      const Row& row = table_[static_cast<std::size_t>(a)];
      for (int b = a; b < N; ++b) {
        sums.H(a, b) = sums.H(b, a) = static_cast<double>(row[static_cast<std::size_t>(b)].sum());
      }
      sums.g[a] = static_cast<double>(row[kResidual].sum());
    }
    sums.squares = static_cast<double>(squares_.sum());
    sums.weights = static_cast<double>(weights_.sum());
  }

 private:
  std::array<Row, N> table_;
  Lane squares_ = Lane::Zero();
  Lane weights_ = Lane::Zero();
};

}  // namespace cgsr::illumination
