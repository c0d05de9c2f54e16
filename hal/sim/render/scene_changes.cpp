#include "hal/sim/render/scene_changes.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace cgsr::sim {
namespace {

using Eigen::AlignedBox3f;
using Eigen::Vector3f;

// What a ray's end may be off by: rounding, and the lift of shadow rays.
constexpr float kMargin_m = 0.02F;

// The same bytes, not only equal: the sign of a zero is part of a ray.
template <typename Matrix>
bool same_bits(const Matrix& a, const Matrix& b) {
  return std::memcmp(a.data(), b.data(), sizeof(typename Matrix::Scalar) * static_cast<std::size_t>(a.size())) == 0;
}

bool same_placement(const Tracer::Placement& a, const Tracer::Placement& b) {
  return same_bits(a.R, b.R) && same_bits(a.p, b.p);
}

// Keeps of first..last where f0 + t (f1 - f0) <= 0. What is not a number cuts nothing off.
bool clip(float f0, float f1, float& first, float& last) {
  if (f0 > 0.0F && f1 > 0.0F) return false;
  if (f0 > 0.0F) first = std::max(first, f0 / (f0 - f1));
  if (f1 > 0.0F) last = std::min(last, f0 / (f0 - f1));
  return first <= last;
}

// Does the convex hull of two boxes meet the box c? It is the union of the boxes (1 - t) a + t b for t in 0..1.
bool hull_meets(const AlignedBox3f& a, const AlignedBox3f& b, const AlignedBox3f& c) {
  float first = 0.0F;
  float last = 1.0F;
  for (int axis = 0; axis < 3; ++axis) {
    if (!clip(a.min()[axis] - c.max()[axis], b.min()[axis] - c.max()[axis], first, last) ||
        !clip(c.min()[axis] - a.max()[axis], c.min()[axis] - b.max()[axis], first, last)) {
      return false;
    }
  }
  return true;
}

}  // namespace

void RayBounds::extend(const Ray& ray, const Surfel& surfel) {
  if (surfel.part < 0) {
    ends.extend(Vector3f(ray.origin + kMaxDepth_m * ray.direction));
    return;
  }
  ends.extend(surfel.p_W);
  shadow_origins.extend(surfel.p_WShadow);
}

SceneChanges::SceneChanges(const Scene& scene) : scene_(&scene) {
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (scene.parts[i].figure >= 0) moving_.push_back(static_cast<int>(i));
  }
  states_.resize(moving_.size());
}

void SceneChanges::update(const SceneState& state, const Tracer& tracer, const Pose& X_WC) {
  const bool first = camera_.isEmpty();
  const bool new_view = take_view(X_WC);
  const bool new_light = take_light(state);
  everything_ = first || new_view || new_light;
  boxes_.clear();
  around_.setEmpty();
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const PartState before = states_[i];
    PartState& now = states_[i];
    now.present = is_present(scene_->parts[static_cast<std::size_t>(moving_[i])], state);
    if (now.present) now.X_WP = tracer.placement(moving_[i]);
    const bool changed = now.present != before.present || (now.present && !same_placement(now.X_WP, before.X_WP));
    if (everything_ || !changed) continue;
    add_box(moving_[i], before);
    add_box(moving_[i], now);
  }
}

bool SceneChanges::take_view(const Pose& X_WC) {
  const Eigen::Matrix3f R_WC = X_WC.linear().cast<float>();
  const Vector3f p_WC = X_WC.translation().cast<float>();
  const bool same = same_bits(R_WC, R_WC_) && same_bits(p_WC, p_WC_);
  R_WC_ = R_WC;
  p_WC_ = p_WC;
  camera_ = AlignedBox3f(p_WC);
  return !same;
}

bool SceneChanges::take_light(const SceneState& state) {
  bool same = lamps_.size() == state.lamps.size() && same_bits(ambient_lux_, state.ambient_lux);
  for (std::size_t i = 0; same && i < lamps_.size(); ++i) {
    same = same_bits(lamps_[i].p_WL, state.lamps[i].p_WL) &&
           same_bits(lamps_[i].intensity_cd, state.lamps[i].intensity_cd);
  }
  if (same) return false;
  ambient_lux_ = state.ambient_lux;
  lamps_ = state.lamps;
  lamp_boxes_.clear();
  for (std::size_t i = 0; i < lamps_.size(); ++i) {
    if (!(lamps_[i].intensity_cd.maxCoeff() > 0.0F)) continue;
    const Vector3f p_WL = lamps_[i].p_WL.cast<float>();
    const Vector3f radius = Vector3f::Constant(static_cast<float>(scene_->lamps[i].radius_m));
    lamp_boxes_.emplace_back(p_WL - radius, p_WL + radius);
  }
  return true;
}

void SceneChanges::add_box(int part, const PartState& at) {
  if (!at.present) return;
  AlignedBox3f box;
  for (const Vector3f& p : scene_->parts[static_cast<std::size_t>(part)].mesh.position_m) {
    box.extend(Vector3f(at.X_WP.R * p + at.X_WP.p));
  }
  if (box.isEmpty()) return;
  box.min().array() -= kMargin_m;
  box.max().array() += kMargin_m;
  boxes_.push_back(box);
  around_.extend(box);
}

bool SceneChanges::affects(const RayBounds& bounds) const {
  if (everything_) return true;
  if (boxes_.empty() || !affects(bounds, around_)) return false;
  return std::any_of(boxes_.begin(), boxes_.end(), [&](const AlignedBox3f& box) { return affects(bounds, box); });
}

bool SceneChanges::affects(const RayBounds& bounds, const AlignedBox3f& changed) const {
  if (!bounds.ends.isEmpty() && hull_meets(camera_, bounds.ends, changed)) return true;
  if (bounds.shadow_origins.isEmpty()) return false;
  return std::any_of(lamp_boxes_.begin(), lamp_boxes_.end(),
                     [&](const AlignedBox3f& lamp) { return hull_meets(lamp, bounds.shadow_origins, changed); });
}

}  // namespace cgsr::sim
