#include "hal/sim/render/shader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "hal/sim/render/visibility.h"
#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector3f;

constexpr float kOneOverPi = 0.31830988618F;

float schlick(float f0, float cosine) {
  const float m = std::clamp(1.0F - cosine, 0.0F, 1.0F);
  const float m2 = m * m;
  return f0 + (1.0F - f0) * m2 * m2 * m;
}

// GGX times Smith's masking over 4 (n.l) (n.v): radiance per illuminance.
float gloss(const Material& material, const Vector3f& n, const Vector3f& l, const Vector3f& v) {
  const Vector3f h = (l + v).normalized();
  const float nl = std::max(1e-3F, n.dot(l));
  const float nv = std::max(1e-3F, n.dot(v));
  const float nh = std::max(0.0F, n.dot(h));
  const float alpha = material.roughness * material.roughness;
  const float a2 = alpha * alpha;
  const float spread = nh * nh * (a2 - 1.0F) + 1.0F;
  const float distribution = a2 * kOneOverPi / (spread * spread);
  const float k = 0.5F * alpha;
  const float masking = 1.0F / (4.0F * (nl * (1.0F - k) + k) * (nv * (1.0F - k) + k));
  return schlick(material.specular, h.dot(v)) * distribution * masking;
}

}  // namespace

Shader::Shader(const Scene& scene, const Tracer& tracer, const Surfaces& surfaces)
    : scene_(scene), tracer_(tracer), surfaces_(surfaces) {}

void Shader::set_state(const SceneState& state) {
  lamps_.clear();
  for (std::size_t i = 0; i < state.lamps.size(); ++i) {
    if (!(state.lamps[i].intensity_cd.maxCoeff() > 0.0F)) continue;
    lamps_.push_back(
        {state.lamps[i].p_WL.cast<float>(), state.lamps[i].intensity_cd, static_cast<float>(scene_.lamps[i].radius_m)});
  }
  emission_of_part_.assign(scene_.parts.size(), Rgb::Zero());
  for (std::size_t i = 0; i < scene_.parts.size(); ++i) {
    const Part& part = scene_.parts[i];
    emission_of_part_[i] = scene_.materials[static_cast<std::size_t>(part.material)].emission_cd_m2;
    if (part.lamp < 0) continue;
    // A ball of intensity I shows the radiance I / (pi r^2).
    const auto lamp = static_cast<std::size_t>(part.lamp);
    const auto r = static_cast<float>(std::max(0.01, scene_.lamps[lamp].radius_m));
    emission_of_part_[i] = state.lamps[lamp].intensity_cd * (kOneOverPi / (r * r));
  }
  ambient_lux_ = state.ambient_lux;
}

void Shader::shade(Bundle& bundle, bool coherent) const {
  alignas(32) int valid[kPacket] = {};
  alignas(32) RTCRayHit8 rays{};
  for (int lane = 0; lane < bundle.count; ++lane) {
    const Vector3f& d = bundle.direction[static_cast<std::size_t>(lane)];
    valid[lane] = -1;
    rays.ray.org_x[lane] = bundle.origin.x();
    rays.ray.org_y[lane] = bundle.origin.y();
    rays.ray.org_z[lane] = bundle.origin.z();
    rays.ray.dir_x[lane] = d.x();
    rays.ray.dir_y[lane] = d.y();
    rays.ray.dir_z[lane] = d.z();
    rays.ray.tnear[lane] = 0.01F;
    rays.ray.tfar[lane] = kMaxDepth_m;
    rays.ray.mask[lane] = kSightRays;
    rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
  tracer_.nearest(valid, rays, coherent);

  std::array<Rgb, kPacket> albedo;
  for (int lane = 0; lane < bundle.count; ++lane) {
    const auto i = static_cast<std::size_t>(lane);
    const Met met = tracer_.met(rays, lane);
    Surfel& surfel = bundle.surfel[i];
    if (met.part < 0) {
      surfel = Surfel{};
      bundle.radiance[i] = background();
      continue;
    }
    surfel = surfaces_.at(tracer_, met, {bundle.origin, bundle.direction[i], bundle.width}, rays.ray.tfar[lane]);
    const Material& material =
        scene_.materials[static_cast<std::size_t>(scene_.parts[static_cast<std::size_t>(met.part)].material)];
    albedo[i] = albedo_at(material, scene_.textures, surfel.at);
    const auto from_below = static_cast<float>(scene_.ambient.from_below);
    const float sky = (from_below + 0.5F * (1.0F - from_below) * (1.0F + surfel.n_W.z())) * surfel.open;
    Rgb reflected = albedo[i];
    if (material.specular > 0.0F) {
      const float cosine = -surfel.n_W.dot(bundle.direction[i]) / bundle.direction[i].norm();
      reflected += Rgb::Constant(0.6F * schlick(material.specular, cosine) * (1.0F - 0.8F * material.roughness));
    }
    bundle.radiance[i] = emission_of_part_[static_cast<std::size_t>(met.part)] +
                         (kOneOverPi * sky) * ambient_lux_.cwiseProduct(reflected);
  }
  for (std::size_t i = 0; i < lamps_.size(); ++i) {
    add_lamp(lamps_[i], static_cast<std::uint32_t>(i), coherent, bundle, albedo);
  }
}

void Shader::add_lamp(const ActiveLamp& lamp, std::uint32_t salt, bool coherent, Bundle& bundle,
                      const std::array<Rgb, kPacket>& albedo) const {
  ShadowQuery query;
  std::array<float, kPacket> strength{};  // cos / d^2
  std::array<Vector3f, kPacket> towards;
  bool any = false;
  for (int lane = 0; lane < bundle.count; ++lane) {
    const auto i = static_cast<std::size_t>(lane);
    const Surfel& surfel = bundle.surfel[i];
    if (surfel.part < 0) continue;
    const Vector3f to_lamp = lamp.p_WL - surfel.p_W;
    const float d2 = to_lamp.squaredNorm();
    towards[i] = to_lamp / std::sqrt(d2);
    const float cosine = surfel.n_W.dot(towards[i]);
    if (cosine <= 0.0F) continue;
    strength[i] = cosine / d2;
    query.wanted[i] = true;
    query.from[i] = surfel.p_WShadow;
    query.seed[i] = mix(bundle.seed[i], salt);
    any = true;
  }
  if (!any) return;
  const auto share = visible_share(tracer_, query, lamp.p_WL, lamp.radius_m, coherent);
  for (int lane = 0; lane < bundle.count; ++lane) {
    const auto i = static_cast<std::size_t>(lane);
    if (share[i] <= 0.0F) continue;
    const Surfel& surfel = bundle.surfel[i];
    const Rgb illuminance = lamp.intensity_cd * (strength[i] * share[i]);
    const Material& material =
        scene_.materials[static_cast<std::size_t>(scene_.parts[static_cast<std::size_t>(surfel.part)].material)];
    bundle.radiance[i] += kOneOverPi * albedo[i].cwiseProduct(illuminance);
    if (material.specular > 0.0F) {
      const Vector3f v = -bundle.direction[i].normalized();
      bundle.radiance[i] += gloss(material, surfel.n_W, towards[i], v) * illuminance;
    }
  }
}

}  // namespace cgsr::sim
