#pragma once

#include "hal/sim/scene/material.h"

namespace cgsr::sim {

/// How the light of one image is measured.
///
///   value = radiance * exposure_s * gain         1.0 is the sensor's full well at gain 1; 60 cd/m^2 for 1/60 s make it
///   variance = value * gain / full_well_e + (read_noise_e * gain / full_well_e)^2          shot and read noise
///   encoded = sRGB(clip(value * white_balance))
struct SensorSettings {
  double exposure_s = 1.0 / 60.0;
  double gain = 1.0;
  Rgb white_balance = Rgb::Ones();  ///< multiplies the channels after the noise.
  bool noise = true;
  double full_well_e = 9000.0;  ///< electrons.
  double read_noise_e = 9.0;    ///< electrons, standard deviation.
};

}  // namespace cgsr::sim
