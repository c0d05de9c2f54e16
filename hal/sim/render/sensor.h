#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/sim/render/renderer.h"
#include "hal/sim/render/sensor_settings.h"
#include "hal/sim/render/workers.h"

namespace cgsr::sim {

/// Where the pixels go: YUYV, BT.601 limited range, as a driver's buffer.
struct YuyvBuffer {
  std::uint8_t* data = nullptr;
  int width_px = 0;  ///< even.
  int height_px = 0;
  std::ptrdiff_t stride_bytes = 0;  ///< >= 2 * width.
};

/// Turns light into the bytes that a webcam delivers.
class Sensor {
 public:
  Sensor();

  /// Measures `image` into `buffer`, which has the same size. Noise depends on seed, image number and pixel alone.
  /// \return the mean of encoded luma, 0..1: what automatic exposure looks at.
  double measure(const RadianceImage& image, const SensorSettings& settings, std::uint32_t seed,
                 std::uint64_t image_number, const YuyvBuffer& buffer, Workers& workers) const;

  /// sRGB of a linear value, as 0..65535: what measure() uses. Within 0.1 of an 8-bit step of the exact curve.
  [[nodiscard]] std::uint16_t encode(float linear) const;

 private:
  std::vector<std::uint16_t> srgb_;  // 65536 entries over 0..1
  std::vector<float> normal_;        // quantiles of the standard normal distribution
};

/// A webcam's automatic exposure: each image moves towards the one that would have had the goal's mean luma, exposure first, then gain.
struct AutoExposure {
  double goal_luma = 0.45;
  double speed = 0.35;  ///< share of the way, in stops, per image.
  double longest_exposure_s = 1.0 / 30.0;
  double shortest_exposure_s = 1.0 / 8000.0;
  double most_gain = 8.0;

  /// \param mean_luma  of the image taken with `settings`. \return the settings for the next one.
  [[nodiscard]] SensorSettings next(const SensorSettings& settings, double mean_luma) const;
};

}  // namespace cgsr::sim
