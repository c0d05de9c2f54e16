#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::imaging {

/// One 8-bit plane that lies elsewhere; neighbouring pixels are `pixel_stride` bytes apart.
struct Plane {
  const std::uint8_t* data = nullptr;
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride_bytes = 0;
  int pixel_stride = 1;
};

/// Size of a patch in pixels.
struct PatchSize {
  int width_px = 0;
  int height_px = 0;
  [[nodiscard]] std::size_t area() const {
    return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  }
};

/// A YUYV image at falling resolutions, each level the 2x2 means of the one before, so that patches of any part of it can be taken at
/// any size without aliasing (mip maps, Williams 1983). Level 0 has luma only and is read in place; from level 1 on there is chroma too.
class Pyramid {
 public:
  static constexpr int kLevels = 5;

  /// Reserves for images up to this size; build() then never allocates.
  Pyramid(int max_width_px, int max_height_px);

  /// Takes over an image. \param image  kYuyv, not larger than reserved for; it must live as long as patches are taken.
  void build(const ImageView& image);

  /// Resamples a part of the image, bilinearly at the level that is next finer than wanted. Beyond the border the border repeats.
  /// \param region  in camera pixels, of any place and size. \param size  of the patch. \param out  size.area() values, row by row.
  void sample_luma(const Box& region, PatchSize size, std::span<std::uint8_t> out) const;
  void sample_chroma(const Box& region, PatchSize size, std::span<std::uint8_t> u, std::span<std::uint8_t> v) const;

  [[nodiscard]] int width_px() const { return luma_[0].width_px; }
  [[nodiscard]] int height_px() const { return luma_[0].height_px; }

  /// Mean luma and chroma of the whole image, from the coarsest level.
  struct Mean {
    double y = 0.0;
    double u = 128.0;
    double v = 128.0;
  };
  [[nodiscard]] Mean mean() const;

  /// How often build() was called: tells one image's patches from another's.
  [[nodiscard]] std::uint64_t builds() const { return builds_; }

  [[nodiscard]] int levels() const { return levels_; }
  [[nodiscard]] const Plane& luma(int level) const { return luma_[level]; }
  [[nodiscard]] const Plane& chroma_u(int level) const { return u_[level]; }  ///< level >= 1
  [[nodiscard]] const Plane& chroma_v(int level) const { return v_[level]; }  ///< level >= 1

 private:
  struct Storage {
    std::vector<std::uint8_t> y, u, v;
  };
  [[nodiscard]] int level_for(const Box& region, PatchSize size) const;

  Storage storage_[kLevels];
  Plane luma_[kLevels];
  Plane u_[kLevels];
  Plane v_[kLevels];
  int levels_ = 0;
  std::uint64_t builds_ = 0;
};

}  // namespace cgsr::imaging
