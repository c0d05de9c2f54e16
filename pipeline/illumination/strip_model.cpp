#include "pipeline/illumination/strip_model.h"

#include <algorithm>
#include <cmath>

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;

constexpr float kScale = 3.0F;  // grey levels, of a sample that is accepted
constexpr auto kEnd_m = static_cast<float>(StripModel::kPlaces * StripModel::kStep_m);

}  // namespace

StripModel::StripModel(const Probe& probe) : radius_m_(probe.radius_m) {}

Outline StripModel::shadow_outline(const Vector2d& tip) const {
  return outline_of(Vector2d(0.0, -radius_m_), radius_m_, tip);
}

StripModel::Shadowless StripModel::without_shadow(const Unknowns& x, const StripSample& sample) const {
  const Floats f = x.cast<float>();
  const float along = sample.at.x();
  const float out = sample.at.y();
  const float w = step_.at((out - f[kEdge] - f[kEdgeSlope] * along / kEnd_m) / blur_m_).share;
  const float board = f[kBoardLevel] + f[kSlopeAlong] * along + f[kSlopeOut] * out;
  const float cone = f[kCone] + f[kConeSlope] * along;
  return {.board = w, .missing = cone + (board - cone) * w - sample.value};
}

float StripModel::hidden(const Unknowns& x, const StripSample& sample, const Outline& outline,
                         float over_length) const {
  const auto edge = static_cast<float>(x[kEdge]);
  const Eigen::Vector2f from_foot(sample.at.x(), sample.at.y() - edge + static_cast<float>(radius_m_));
  const auto soft_end = static_cast<float>(x[kSoftEnd]);
  float share = -1.0F;
  for (std::size_t side = 0; side < 2; ++side) {
    const Eigen::Vector2f inward = outline.inward[side].cast<float>();
    const float d = from_foot.dot(inward) + static_cast<float>(radius_m_);
    const Eigen::Vector2f along =
        side == 0 ? Eigen::Vector2f(-inward.y(), inward.x()) : Eigen::Vector2f(inward.y(), -inward.x());
    const float way = std::clamp(std::abs(from_foot.dot(along)) * over_length, 0.0F, 1.0F);
    const float soft = soft_end * way;
    share += step_.at(d / std::sqrt(soft * soft + blur_m_ * blur_m_)).share;
  }
  return std::max(0.0F, share);
}

StripModel::Wedge StripModel::wedge_at(const Unknowns& x) const {
  const Vector2d tip(x[kTipAlong], x[kTipOut]);
  const Outline outline = shadow_outline(tip);
  Wedge wedge;
  wedge.valid = outline.valid;
  wedge.dark = static_cast<float>(x[kShadowDepth]);
  wedge.soft_end = static_cast<float>(x[kSoftEnd]);
  for (std::size_t side = 0; side < 2 && wedge.valid; ++side) {
    const Vector2d to_tip = tip - outline.touch[side];
    const double length = to_tip.norm();
    wedge.inward[side] = outline.inward[side].cast<float>();
    wedge.line[side] = (to_tip / length).cast<float>();
    wedge.over_length[side] = static_cast<float>(1.0 / length);
  }
  return wedge;
}

inline StripModel::SampleLanes StripModel::lanes_at(std::span<const StripSample> samples, int first, int every) {
  const int count = static_cast<int>(samples.size());
  SampleLanes lanes;
  for (int k = 0; k < kLane; ++k) {
    const int at = first + k * every;
    const StripSample& sample = samples[static_cast<std::size_t>(std::min(at, count - 1))];
    lanes.along[k] = sample.at.x();
    lanes.out[k] = sample.at.y();
    lanes.value[k] = sample.value;
    lanes.there[k] = at < count ? 1.0F : 0.0F;
  }
  return lanes;
}

// How dark the shadow is at four samples, and its derivatives with respect to the tip and the softness.
inline StripModel::WedgeLanes StripModel::darken(const Wedge& wedge, const Lane& along, const Lane& q) const {
  const auto radius = static_cast<float>(radius_m_);
  WedgeLanes lanes;
  lanes.dark_share = Lane::Constant(-1.0F);
  for (std::size_t side = 0; side < 2; ++side) {
    const Lane d = along * wedge.inward[side].x() + q * wedge.inward[side].y() + radius;
    const Lane way =
        ((along * wedge.line[side].x() + q * wedge.line[side].y()) * wedge.over_length[side]).max(0.0F).min(1.0F);
    const Lane soft = wedge.soft_end * way;
    const Lane over_sigma = 1.0F / (soft * soft + blur_m_ * blur_m_).sqrt();
    Lane share;
    Lane density;
    step_.at(d * over_sigma, share, density);
    lanes.dark_share += share;
    const Lane J_tip = wedge.dark * density * over_sigma * way;
    lanes.J_soft_end += J_tip * d * soft * over_sigma * over_sigma;
    lanes.J_tip_x += J_tip * wedge.inward[side].x();
    lanes.J_tip_y += J_tip * wedge.inward[side].y();
  }
  const auto lit = lanes.dark_share <= 0.0F;
  lanes.J_tip_x = lit.select(0.0F, lanes.J_tip_x);
  lanes.J_tip_y = lit.select(0.0F, lanes.J_tip_y);
  lanes.J_soft_end = lit.select(0.0F, lanes.J_soft_end);
  lanes.dark_share = lanes.dark_share.max(0.0F);
  return lanes;
}

// The residuals of four samples and their derivatives.
inline void StripModel::linearize(const Floats& f, const SampleLanes& at, const WedgeLanes& shadow, Row& j) const {
  Lane w;
  Lane edge_density;
  step_.at((at.out - f[kEdge] - f[kEdgeSlope] * at.along / kEnd_m) / blur_m_, w, edge_density);
  const Lane board =
      f[kBoardLevel] + f[kSlopeAlong] * at.along + f[kSlopeOut] * at.out - f[kShadowDepth] * shadow.dark_share;
  const Lane cone = f[kCone] + f[kConeSlope] * at.along;
  j[kTipAlong] = w * shadow.J_tip_x;
  j[kTipOut] = w * shadow.J_tip_y;
  j[kSoftEnd] = w * shadow.J_soft_end;
  j[kShadowDepth] = -w * shadow.dark_share;
  j[kBoardLevel] = w;
  j[kSlopeAlong] = w * at.along;
  j[kSlopeOut] = w * at.out;
  j[kCone] = 1.0F - w;
  j[kConeSlope] = (1.0F - w) * at.along;
  j[kEdge] = -(board - cone) * edge_density / blur_m_;
  j[kEdgeSlope] = j[kEdge] * at.along / kEnd_m;
  j[LaneSums<kUnknowns>::kResidual] = at.value - (cone + (board - cone) * w);
}

StripModel::Sums StripModel::sum_up(const Unknowns& x, std::span<const StripSample> samples, const Pass& pass) const {
  const Wedge wedge = wedge_at(x);
  const bool with_shadow = pass.with_shadow && wedge.valid;
  const Floats f = x.cast<float>();
  const float brighter_scale = pass.darker_counts ? kScale : 2.0F * kScale;
  LaneSums<kUnknowns> table;
  Row j;
  for (int i = 0; i < static_cast<int>(samples.size()); i += kLane * pass.every) {
    const SampleLanes at = lanes_at(samples, i, pass.every);
    // The outline's place is the cone's own: where its edge is seen, its base is.
    const Lane q = at.out - f[kEdge] + static_cast<float>(radius_m_);
    const WedgeLanes shadow = with_shadow ? darken(wedge, at.along, q) : WedgeLanes{};
    linearize(f, at, shadow, j);
    const Lane& residual = j[LaneSums<kUnknowns>::kResidual];
    const Lane scale = (residual < 0.0F).select(Lane::Constant(kScale), brighter_scale);
    const Lane relative = residual / scale;
    table.add(j, at.there / (1.0F + relative * relative));
  }
  Sums sums;
  table.put_into(sums);
  return sums;
}

}  // namespace cgsr::illumination
