#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/color/learn/color_model.h"
#include "platform/box.h"
#include "platform/image_lease.h"

namespace cgsr::tasks::testing {

/// Lends out YUYV images of 320x240: a two-coloured patch on textured ground, or the ground alone. Painted once, lent as often as wanted.
class PaintedCamera final : public ImageLender {
 public:
  static constexpr int kWidth_px = 320;
  static constexpr int kHeight_px = 240;
  static constexpr Duration kPeriod = seconds(1.0 / 30.0);

  PaintedCamera();

  /// \param number  of the image; its stamp follows from it. \param absent  without the patch.
  ImageLease image(std::uint64_t number, bool absent = false);

  /// Where the patch is in image `number`: it walks to and fro over 16 places.
  static Box patch(std::uint64_t number);

  /// What learning leaves of the patch.
  color::ColorModel learn();

  void give_back(int slot) noexcept override { static_cast<void>(slot); }

 private:
  static constexpr std::size_t kPlaces = 16;
  using Pixels = std::vector<std::uint8_t>;
  Pixels paint(const Box* patch) const;

  std::array<Pixels, kPlaces> with_patch_;
  Pixels without_;
};

}  // namespace cgsr::tasks::testing
