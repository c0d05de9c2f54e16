#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/lab/scenes/canvas.h"

namespace cgsr::lab {

/// A short film of one object that wanders through clutter, comes nearer and goes away, while the light changes continuously inside [0.6, 1]
/// per channel. For a while it is out of sight, and appears elsewhere. The truth is exact to a fraction of a pixel.
class MovingScene {
 public:
  /// \param absent  after image 0 the object never comes back.
  MovingScene(std::uint64_t seed, int images, bool absent = false);

  [[nodiscard]] int size() const { return static_cast<int>(truth_.size()); }

  /// \param i  0 .. size() - 1; image 0 shows the object under the light that Alg. 3.1 assumes.
  [[nodiscard]] Image image(int i) const;

  /// Empty while the object is out of sight.
  [[nodiscard]] const std::vector<std::optional<Box>>& truth() const { return truth_; }
  /// The light that multiplies the textures of image i.
  [[nodiscard]] const Light& light(int i) const { return lights_[static_cast<std::size_t>(i)]; }

 private:
  Random random_;
  Pattern pattern_;
  Canvas clutter_;
  std::vector<std::optional<Box>> truth_;
  std::vector<Light> lights_;
};

}  // namespace cgsr::lab
