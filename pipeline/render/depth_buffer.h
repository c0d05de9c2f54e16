#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace cgsr::render {

/// 1/Z of a plane over the raster: linear, w(u, v) = du u + dv v + at_origin, with Z the depth along the camera's axis, metres.
struct DepthPlane {
  float du = 0.0F;
  float dv = 0.0F;
  float at_origin = 0.0F;

  [[nodiscard]] float at(float u, float v) const { return du * u + dv * v + at_origin; }
};

/// The nearest triangle in each cell of a raster, by inverse depth: its w = 1/Z [1/m], 0 where nothing is, and its name.
/// This is z-buffering (2.3) with inverse depth, which is linear over the raster. (u, v) are cells, 0 at the centre of the top-left one.
class DepthBuffer {
 public:
  static constexpr std::uint32_t kNothing = 0xFFFFFFFFU;

  DepthBuffer(int width, int height);

  void clear();

  /// Draws a triangle of a plane: cells whose centre it covers and where it is nearer than what is there.
  ///
  /// \param corners  cells, anywhere in the plane; either way round.
  void draw(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c, const DepthPlane& plane,
            std::uint32_t name);

  /// Sets bits in a mask of width() x height() bytes where a triangle of a plane is nearer than what is there; the buffer stays as it is.
  void mark(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c, const DepthPlane& plane,
            std::uint8_t bits, std::uint8_t* mask) const;

  /// Where a cell lies in memory, for names().
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * stride_ + static_cast<std::size_t>(x);
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] float inverse_depth(int x, int y) const { return w_[at(x, y)]; }
  [[nodiscard]] std::uint32_t name(int x, int y) const { return name_[at(x, y)]; }  ///< kNothing: nothing is.
  /// Of four cells: (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1).
  [[nodiscard]] std::array<std::uint32_t, 4> names(int x, int y) const { return names(at(x, y)); }
  [[nodiscard]] std::array<std::uint32_t, 4> names(std::size_t cell) const {
    const std::uint32_t* const first = &name_[cell];
    return {first[0], first[1], first[stride_], first[stride_ + 1]};
  }

 private:
  /// Calls span(y, first, last) for the rows of cells whose centres a triangle covers.
  template <class Span>
  void scan(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c, Span&& span) const;
  void fill(int y, int first, int last, const DepthPlane& plane, std::uint32_t name);

  int width_;
  int height_;
  std::size_t stride_;
  std::vector<float> w_;
  std::vector<std::uint32_t> name_;
};

}  // namespace cgsr::render
