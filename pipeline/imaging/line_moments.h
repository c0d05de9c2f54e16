#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace cgsr::imaging {

/// Sums over points from which a line of least squares across it (total least squares) follows. Sums of disjoint sets of points add, those of
/// a stretch of a chain are the difference of two running sums. Points are counted from an origin near them.
/// The fit is Pearson's (Pearson 1901), for the edge segments of section 4.1.
struct LineMoments {
  double n = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;

  void add(double px, double py) {
    n += 1.0;
    x += px;
    y += py;
    xx += px * px;
    xy += px * py;
    yy += py * py;
  }

  friend LineMoments operator-(const LineMoments& a, const LineMoments& b) {
    return {a.n - b.n, a.x - b.x, a.y - b.y, a.xx - b.xx, a.xy - b.xy, a.yy - b.yy};
  }
  friend LineMoments operator+(const LineMoments& a, const LineMoments& b) {
    return {a.n + b.n, a.x + b.x, a.y + b.y, a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
  }

  /// The same points counted from an origin that lies at (-dx, -dy) of the present one.
  [[nodiscard]] LineMoments moved(double dx, double dy) const {
    return {n,
            x + n * dx,
            y + n * dy,
            xx + 2.0 * dx * x + n * dx * dx,
            xy + dx * y + dy * x + n * dx * dy,
            yy + 2.0 * dy * y + n * dy * dy};
  }
};

/// A line through points: their mean, unit direction, and the root mean square of their distances.
struct FittedLine {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
  double rms = 0.0;

  [[nodiscard]] double along(const Eigen::Vector2d& point) const { return direction.dot(point - middle); }
  [[nodiscard]] double across(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d from_middle = point - middle;
    return direction.x() * from_middle.y() - direction.y() * from_middle.x();
  }
};

/// \param like  the fitted direction's sense is this one's.
inline FittedLine fit_line(const LineMoments& sums, const Eigen::Vector2d& like) {
  FittedLine line;
  const double n = std::max(sums.n, 1.0);
  line.middle = {sums.x / n, sums.y / n};
  const double xx = sums.xx / n - line.middle.x() * line.middle.x();
  const double xy = sums.xy / n - line.middle.x() * line.middle.y();
  const double yy = sums.yy / n - line.middle.y() * line.middle.y();
  const double half_difference = 0.5 * (xx - yy);
  const double root = std::sqrt(half_difference * half_difference + xy * xy);
  // The eigenvector of the greater eigenvalue, from the row of the matrix that does not cancel.
  const Eigen::Vector2d direction = half_difference >= 0.0 ? Eigen::Vector2d(half_difference + root, xy)
                                                           : Eigen::Vector2d(xy, root - half_difference);
  const double length = direction.norm();
  if (length > 0.0) line.direction = direction / length;
  if (line.direction.dot(like) < 0.0) line.direction = -line.direction;
  line.rms = std::sqrt(std::max(0.0, 0.5 * (xx + yy) - root));
  return line;
}

}  // namespace cgsr::imaging
