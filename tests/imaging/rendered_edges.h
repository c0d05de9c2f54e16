#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>

namespace cgsr::imaging::drawn {

/// Grey images of which the truth is known, drawn with real values until they are cut to bytes.
struct Canvas {
  Canvas(int width, int height, double level)
      : width_px(width), height_px(height), values(static_cast<std::size_t>(width * height), level) {}

  /// Adds a ribbon: `change` grey levels within half of `ribbon_width_px` of the line through `middle` along `direction` (unit), as long as
  /// `length_px`, its borders blurred with the deviation `blur_px`.
  void add_ribbon(const Eigen::Vector2d& middle, const Eigen::Vector2d& direction, double length_px,
                  double ribbon_width_px, double change, double blur_px) {
    const auto step = [blur_px](double inside) { return 0.5 * (1.0 + std::erf(inside / (blur_px * std::sqrt(2.0)))); };
    for (int y = 0; y < height_px; ++y) {
      for (int x = 0; x < width_px; ++x) {
        const Eigen::Vector2d from = Eigen::Vector2d(x, y) - middle;
        const double along = std::abs(direction.dot(from));
        const double across = direction.x() * from.y() - direction.y() * from.x();
        if (along > 0.5 * length_px + 5.0 * blur_px) continue;
        const double half = 0.5 * ribbon_width_px;
        at(x, y) += change * step(0.5 * length_px - along) * (step(across + half) - step(across - half));
      }
    }
  }

  /// Adds a half-plane: `change` grey levels on the side of `normal` (unit) of the line through `point`.
  void add_side(const Eigen::Vector2d& point, const Eigen::Vector2d& normal, double change, double blur_px) {
    for (int y = 0; y < height_px; ++y)
      for (int x = 0; x < width_px; ++x)
        at(x, y) +=
            change * 0.5 * (1.0 + std::erf(normal.dot(Eigen::Vector2d(x, y) - point) / (blur_px * std::sqrt(2.0))));
  }

  /// \param deviation  of the noise in grey levels.
  [[nodiscard]] std::vector<std::uint8_t> bytes(std::mt19937& random, double deviation) const {
    std::vector<std::uint8_t> out(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      double normal = -6.0;  // twelve uniform numbers: a normal one
      for (int k = 0; k < 12; ++k) normal += static_cast<double>(random()) / 4294967296.0;
      out[i] = static_cast<std::uint8_t>(std::clamp(std::lround(values[i] + deviation * normal), 0L, 255L));
    }
    return out;
  }

  double& at(int x, int y) { return values[static_cast<std::size_t>(y * width_px + x)]; }

  int width_px;
  int height_px;
  std::vector<double> values;
};

inline double uniform(std::mt19937& random, double from, double to) {
  return from + (to - from) * static_cast<double>(random()) / 4294967296.0;
}

inline Eigen::Vector2d direction_of(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

/// Ribbons and half-planes of all kinds, such as a room has them.
inline Canvas cluttered(std::mt19937& random, int width, int height, int ribbons) {
  Canvas canvas(width, height, uniform(random, 90.0, 150.0));
  for (int i = 0; i < ribbons; ++i) {
    const Eigen::Vector2d middle(uniform(random, 0.0, width), uniform(random, 0.0, height));
    canvas.add_ribbon(middle, direction_of(uniform(random, 0.0, 3.1416)), uniform(random, 30.0, 200.0),
                      uniform(random, 3.0, 60.0), uniform(random, 15.0, 60.0) * (random() % 2 == 0 ? 1.0 : -1.0),
                      uniform(random, 0.4, 0.8));
  }
  return canvas;
}

}  // namespace cgsr::imaging::drawn
