#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace cgsr::imaging {

/// One pixel of an edge: where the image's slope is steepest along the axis that lies nearer to the slope's direction.
struct EdgePixel {
  std::int16_t x = 0;
  std::int16_t y = 0;
  std::int16_t gx = 0;  ///< slope to the right; a sharp step of one grey level has EdgeDetector::kStepGain.
  std::int16_t gy = 0;  ///< slope downwards. (gx, gy) points to the brighter side.
  float offset = 0.0F;  ///< where the steepest point lies along that axis, from the pixel's centre: -0.5 to 0.5.

  /// Whether the edge was looked for along its row (it is rather upright) and not along its column.
  [[nodiscard]] bool across_row() const { return std::abs(gx) >= std::abs(gy); }
  [[nodiscard]] float exact_x() const { return static_cast<float>(x) + (across_row() ? offset : 0.0F); }
  [[nodiscard]] float exact_y() const { return static_cast<float>(y) + (across_row() ? 0.0F : offset); }
};

/// What makes an edge: Canny's two thresholds.
struct EdgeParameters {
  double min_contrast = 5.0;
  double min_strong_contrast = 10.0;
  double noise_factor = 3.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("min_contrast", self.min_contrast, {1.0, 100.0}, "levels",
                 "grey levels across a sharp step that make an edge where it goes on from a stronger one");
    visit.number("min_strong_contrast", self.min_strong_contrast, {1.0, 200.0}, "levels",
                 "with this an edge stands on its own");
    visit.number(
        "noise_factor", self.noise_factor, {0.0, 20.0}, "",
        "the least slope is at least so many standard deviations of its noise, which is measured in the image");
  }
};

/// Canny's edges, made for a grey image of about 320x240: binomial blur, Sobel's gradient, only the steepest pixels across the edge kept
/// (along the row or the column), and of those the ones that hang together with a strong one. The cost follows the edge pixels.
/// The perception module of section 4.1 (Canny 1986).
///
/// No edges within kBorder_px of the image's border. Nothing is allocated after construction.
class EdgeDetector {
 public:
  static constexpr int kBorder_px = 3;
  static constexpr int kLeastSide_px = 16;
  /// Slope of a sharp step of one grey level along an axis.
  static constexpr int kStepGain = 48;

  /// \param max_width_px, max_height_px  of the largest image.
  EdgeDetector(const EdgeParameters& parameters, int max_width_px, int max_height_px);

  /// \param grey    rows of width_px bytes, `stride` bytes apart.
  /// \param mask    tight, of the image's size; pixels that are not 0 are left out (widen what covers the robot by 3 px: its outline is an
  ///                edge too). nullptr: none.
  /// \return row by row, each row from the left; good until the next call. Empty for images smaller than 16x16 or larger than made for.
  ///         A quarter of the image's pixels at most: what comes after that, below, is left out.
  std::span<const EdgePixel> find(const std::uint8_t* grey, int width_px, int height_px, std::ptrdiff_t stride,
                                  const std::uint8_t* mask = nullptr);

  /// Of the last image.
  [[nodiscard]] std::span<const EdgePixel> edges() const { return {edges_.data(), count_}; }

  /// Which pixel belongs to which edge pixel: its number + 1, 0 is none. Rows of map_width() entries, tight.
  [[nodiscard]] const std::uint32_t* map() const { return map_.data(); }
  [[nodiscard]] int map_width() const { return width_; }
  [[nodiscard]] int width_px() const { return width_; }
  [[nodiscard]] int height_px() const { return height_; }

  /// Standard deviation of the last image's noise, grey levels (Immerkaer 1996).
  [[nodiscard]] double noise() const { return noise_; }

  [[nodiscard]] std::size_t capacity() const { return edges_.size(); }

 private:
  static constexpr int kRing = 3;
  static constexpr int kPad = 16;

  void measure_noise(const std::uint8_t* grey, std::ptrdiff_t stride);
  void slopes_of_row(const std::uint8_t* grey, std::ptrdiff_t stride, int y);
  void thin_row(int y, const std::uint8_t* mask);
  void add(int x, int y);
  void join(std::uint32_t one, std::uint32_t other);
  std::uint32_t root_of(std::uint32_t candidate);
  void keep_strong();

  [[nodiscard]] std::int16_t* ring(std::vector<std::int16_t>& rows, int y) const {
    return rows.data() + static_cast<std::ptrdiff_t>(y % kRing) * row_;
  }

  EdgeParameters parameters_;
  int max_width_;
  int max_height_;
  int width_ = 0;
  int height_ = 0;
  std::ptrdiff_t row_;
  std::int16_t least_ = 0;
  std::int16_t strong_ = 0;
  double noise_ = 0.0;
  std::size_t count_ = 0;

  std::vector<std::int16_t> smoothed_;  // one row: down the columns 1 4 6 4 1
  std::vector<std::int16_t> rising_;    // one row: down the columns -1 -2 0 2 1
  std::vector<std::int16_t> gx_;
  std::vector<std::int16_t> gy_;
  std::vector<std::int16_t> steepness_;
  std::vector<EdgePixel> edges_;
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> has_strong_;
  std::vector<std::uint32_t> map_;
};

}  // namespace cgsr::imaging
