#pragma once

#include <array>
#include <cstdint>

#include "hal/sim/render/surfaces.h"
#include "hal/sim/render/tracer.h"
#include "hal/sim/scene/scene.h"

namespace cgsr::sim {

/// Up to eight rays of one camera and what they see. Lanes from `count` on are idle.
struct Bundle {
  int count = 0;
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  std::array<Eigen::Vector3f, kPacket> direction;
  std::array<std::uint32_t, kPacket> seed{};  ///< of the lane's pixel: turns its soft-shadow samples.
  float width = 0.0F;                         ///< footprint per metre of depth.

  std::array<Surfel, kPacket> surfel;  ///< part -1: nothing there.
  std::array<Rgb, kPacket> radiance;   ///< [cd/m^2] per channel.
};

/// Light and materials of one moment.
///
/// Matt part (Lambert): L = albedo / pi (E_ambient + sum over lamps I cos / d^2, where nothing hides the lamp). A ball-shaped lamp sends
/// I cos / d^2 too, times the share of its disc that is seen: exact while the whole lamp is above the surface's horizon.
/// Gloss: a GGX lobe for each lamp (Walter et al. 2007, doi 10.2312/EGWR/EGSR07/195-206), Schlick's Fresnel term, and a faint sheen
/// of the ambient light.
class Shader {
 public:
  Shader(const Scene& scene, const Tracer& tracer, const Surfaces& surfaces);

  /// Takes over the lamps of a moment; the tracer must stand at the same one.
  void set_state(const SceneState& state);

  /// Traces and shades. Threads: any number at once between two set_state().
  /// \param coherent  the rays start and go nearly alike: neighbouring pixels.
  void shade(Bundle& bundle, bool coherent) const;

  /// What is seen where there is nothing.
  [[nodiscard]] Rgb background() const { return ambient_lux_ * 0.3183099F; }

 private:
  struct ActiveLamp {
    Eigen::Vector3f p_WL;
    Rgb intensity_cd;
    float radius_m;
  };

  void add_lamp(const ActiveLamp& lamp, std::uint32_t salt, bool coherent, Bundle& bundle,
                const std::array<Rgb, kPacket>& albedo) const;

  const Scene& scene_;
  const Tracer& tracer_;
  const Surfaces& surfaces_;
  std::vector<ActiveLamp> lamps_;
  std::vector<Rgb> emission_of_part_;  // lamps that can be seen
  Rgb ambient_lux_ = Rgb::Zero();
};

}  // namespace cgsr::sim
