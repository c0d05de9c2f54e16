#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "hal/sim/render/photographer.h"
#include "hal/sim/worlds/world.h"
#include "platform/box.h"
#include "platform/error.h"
#include "tools/lab/box_tracker.h"
#include "tools/lab/image.h"

namespace cgsr::lab {

/// The film of Figure 3.3: somebody in a red and near-white shirt walks out of a corridor in lamp light through a door into daylight,
/// drawn by the simulator (config/worlds/corridor.toml) with its lens and noise, exposure and white balance locked.
///
/// A seed is a take of its own: who walks, how tall, where exactly he and the camera behind him go, how the camera is tilted, and the noise.
/// What the experiment states is the same in all: shirt, house, light and exposure.
class CorridorFilm {
 public:
  static constexpr double kRate_hz = 25.0;
  static constexpr int kSeconds = 40;
  static constexpr int kImages = 1000;

  /// \return why the world's file cannot be used.
  static Result<std::unique_ptr<CorridorFilm>> make(std::uint64_t seed);

  /// What is true of an image, as the simulator knows it.
  struct Truth {
    std::optional<Box> shirt;  ///< around its visible pixels, without the sleeves; nothing: hidden or out of view.
    Light light;               ///< that falls on it, linear, relative to image 0.
  };

  struct Shot {
    Image image;
    Truth truth;
  };

  /// Draws an image, 0 .. kImages - 1, in any order.
  Shot shoot(int number);

  /// How the last image meets what the experiment demands of its scene.
  struct Scene {
    double background_of_its_hues = 0.0;  ///< share of the pixels that are neither walker nor robot.
    double near_white = 0.0;              ///< the encoded value that a tenth of the shirt's pixels reach in a channel.
    double mean_luma = 0.0;
  };
  [[nodiscard]] Scene scene_of(const Shot& shot) const;

  /// The light of the world's script, linear, as the file states it.
  [[nodiscard]] Light scripted_light(double at_s) const;

 private:
  CorridorFilm(sim::World world, std::uint64_t seed) : world_(std::move(world)), seed_(seed) {}

  [[nodiscard]] Light shirt_radiance() const;
  [[nodiscard]] bool is_shirt(std::int32_t part) const { return part == shirt_; }

  sim::World world_;
  std::uint64_t seed_;
  std::unique_ptr<sim::Photographer> photographer_;
  int shirt_ = -1;   // part
  int walker_ = -1;  // figure
  Light first_radiance_;
};

}  // namespace cgsr::lab
