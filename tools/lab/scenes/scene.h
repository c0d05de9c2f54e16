#pragma once

#include <cstdint>
#include <optional>

#include "tools/lab/scenes/canvas.h"

namespace cgsr::lab {

inline constexpr int kSceneWidthPx = 640;
inline constexpr int kSceneHeightPx = 480;
inline constexpr double kSharedHues = 1.0 / 3.0;  ///< share of the background that has the object's hues
/// Learning happens under this light, and Alg. 3.1 assumes it (or more, where noise makes a pixel brighter).
inline constexpr double kLearningLight = 0.8;

/// What a camera may do to an image besides the light; drawn anew for each image.
struct Wear {
  int most_blur_passes = 2;
  double min_noise = 1.0;   ///< 1/255
  double most_noise = 4.0;  ///< 1/255
};

/// One object, never seen before, its picture to learn from, and any number of other scenes to find it in.
/// The same seed gives the same bytes.
class ObjectWorld {
 public:
  explicit ObjectWorld(std::uint64_t seed);

  /// The object in clutter under kLearningLight.
  [[nodiscard]] const Image& learning_image() const { return learning_image_; }
  [[nodiscard]] const Box& learning_box() const { return learning_box_; }
  [[nodiscard]] const Pattern& pattern() const { return pattern_; }

  /// The light that line 9-11 of Alg. 3.1 finds in the learning image: max(channel maximum in the box, 0.8).
  [[nodiscard]] const Light& assumed_light() const { return assumed_light_; }

  /// Another scene: other clutter, the object (scaled by `scale`, or absent) anywhere that it fits, seen under `light`.
  /// \param light  relative to what Alg. 3.1 assumed: the light that a perfect tracker would name.
  /// \param truth  gets the object's box; empty when it is absent.
  [[nodiscard]] Image scene(std::uint64_t number, const Light& light, bool present, double scale,
                            std::optional<Box>& truth) const;

 private:
  Random random_;
  Pattern pattern_;
  Box learning_box_;
  Image learning_image_;
  Light assumed_light_;
};

/// \return the light that multiplies the textures when `light` is what a learner would call it that assumed `assumed`.
Light absolute_light(const Light& light, const Light& assumed);

/// A box of the given sides somewhere inside the image, on whole pixels.
Box random_place(double width_px, double height_px, Random& random);

/// Blur, noise and light of one image.
Exposure random_exposure(const Light& light, const Wear& wear, Random& random);

/// max(channel maximum in the box, 0.8) of a YUYV image, as line 3-11 of Alg. 3.1 has it.
Light assumed_light(const ImageView& yuyv, const Box& box);

}  // namespace cgsr::lab
