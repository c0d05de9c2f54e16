#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "pipeline/color/ball/ball_model.h"
#include "pipeline/color/ball/shade_mask.h"
#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::color {

/// A circle in the camera image. The pixel (x, y) has its middle at (x + 0.5, y + 0.5), as in a Box.
struct Circle {
  double x_px = 0.0;
  double y_px = 0.0;
  double radius_px = 0.0;
};

/// Diameters that the ball's image can have.
struct SizeRange {
  double min_px = 0.0;
  double most_px = 0.0;
};

/// Which pixels of an image have a colour of the ball: one of the bright ones, or a dark one where it may lie in shade
/// (5.3). `of_code` has one entry per colour code (BallModel::of_code).
struct BallPixels {
  ImageView image;  ///< YUYV.
  const std::uint8_t* of_code = nullptr;
  ShadeMaskView mask;                    ///< empty: there may be shade everywhere.
  std::uint8_t kinds = BallModel::kAny;  ///< of colours that count.

  [[nodiscard]] bool inside(int x, int y) const {
    return x >= 0 && y >= 0 && x < image.width_px && y < image.height_px;
  }
  /// \param x, y  inside the image.
  [[nodiscard]] bool shaded(int x, int y) const {
    if (mask.empty()) return true;
    return mask.cells[y * mask.height / image.height_px * mask.stride + x * mask.width / image.width_px] != 0;
  }
  [[nodiscard]] bool member(int x, int y) const;
};

/// How well a circle is the outline of the ball.
struct CircleFit {
  Circle circle;
  double agreement =
      0.0;  ///< share of its circumference (of what lies in the image) on which the image's edge lies and runs along it.
  double inside = 0.0;                   ///< share of the circle's area in the ball's colours.
  double around = 0.0;                   ///< share of the ring around it in these colours.
  std::uint8_t kinds = BallModel::kAny;  ///< BallPixels::kinds.

  [[nodiscard]] double score() const { return agreement * inside * (1.0 - around); }
};

/// Fits a circle to what has the ball's colours around a point: rays from there end where the ball's colours do, circles through three ends
/// each are tried against all ends, and the best one is drawn to the strongest edges near it, in luma and chroma, first roughly, then anew from its
/// own middle.
/// Ours: the dissertation (5.3) says only that shape matching is the secondary filter.
///
/// \param x_px, y_px  some place on the ball. \param sizes  diameters that can be.
/// \return agreement 0 where there is no circle.
CircleFit fit_circle(const BallPixels& pixels, double x_px, double y_px, const SizeRange& sizes);

/// \return the middle of the ball's colours within `radius_px` about a point; the point itself where there are none.
Circle middle_of_members(const BallPixels& pixels, const Circle& around);

/// \return the share of a circle inside the mask; 0 without one.
double shade_share(const BallPixels& pixels, const Circle& circle);

}  // namespace cgsr::color
