#include "pipeline/color/learn/light.h"

namespace cgsr::color {

bool is_plausible(const Light& light, const LightParameters& parameters) {
  return light.g - (light.r + light.b) / 2.0 <= parameters.max_green_excess;
}

std::vector<Light> light_grid(const LightParameters& parameters) {
  std::vector<Light> lights;
  if (!(parameters.min_level <= parameters.max_level)) return lights;
  const int steps = parameters.steps;
  const auto level = [&](int i) {
    const double share = steps > 1 ? static_cast<double>(i) / (steps - 1) : 0.5;
    return parameters.min_level + share * (parameters.max_level - parameters.min_level);
  };
  for (int r = 0; r < steps; ++r) {
    for (int g = 0; g < steps; ++g) {
      for (int b = 0; b < steps; ++b) {
        const Light light{level(r), level(g), level(b)};
        if (is_plausible(light, parameters)) lights.push_back(light);
      }
    }
  }
  return lights;
}

}  // namespace cgsr::color
