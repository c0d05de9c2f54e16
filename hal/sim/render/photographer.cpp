#include "hal/sim/render/photographer.h"

#include <cstddef>
#include <utility>

namespace cgsr::sim {

Result<std::unique_ptr<Photographer>> Photographer::make(const Scene& scene, const CameraModel& camera,
                                                         const RenderOptions& options) {
  auto renderer = Renderer::make(scene, camera, options);
  if (!renderer) return tl::unexpected(renderer.error());
  return std::unique_ptr<Photographer>(new Photographer(std::move(*renderer)));
}

double Photographer::take(const std::vector<Moment>& moments, const SensorSettings& settings,
                          const ImageIdentity& identity, const YuyvBuffer& buffer) {
  const auto share = 1.0F / static_cast<float>(moments.size());
  for (std::size_t i = 0; i < moments.size(); ++i) {
    if (i == 0) {
      renderer_->draw(moments[0].state, moments[0].X_WC, light_);
      if (moments.size() == 1) break;
      for (float& value : light_.rgb) value *= share;
    } else {
      renderer_->draw(moments[i].state, moments[i].X_WC, moment_);
      for (std::size_t k = 0; k < light_.rgb.size(); ++k) light_.rgb[k] += share * moment_.rgb[k];
    }
  }
  return sensor_.measure(light_, settings, identity.seed, identity.number, buffer, renderer_->workers());
}

}  // namespace cgsr::sim
