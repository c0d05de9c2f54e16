#include "pipeline/illumination/shadow_brightness.h"

#include <algorithm>
#include <cmath>

#include "pipeline/illumination/board.h"
#include "pipeline/illumination/luma_view.h"

namespace cgsr::illumination {
namespace {

// Residuals beyond it count less and less: grey levels, and of the contrast.
constexpr float kLeastScale = 3.0F;
constexpr float kScale = 0.12F;

constexpr float kLeastContrast = 0.01F;
constexpr float kMostContrast = 0.98F;

constexpr auto kPower = static_cast<float>(kLightPower);

/// \return light^(1 / 2.4) to 0.13 % for light from 0.00008 to 1: the root r of r^6 = y^5 with y^2 = light, by a step of Newton's.
Lane coded_level(const Lane& light) {
  const Lane y = light.sqrt();
  const Lane z = y.sqrt();
  const Lane r = z * (0.095F + z * (1.27F - 0.365F * z));
  const Lane r3 = r * r * r;
  return r * (5.0F + light * light * y / (r3 * r3)) * (1.0F / 6.0F);
}
static_assert(kLightPower == 2.4);

/// Of four samples: robust ones, and 0 where the model is brighter than a place that is clipped, and behind the last.
Lane weights(const Lane& residual, float scale, const ShadowSamples& samples, int first) {
  const Lane relative = residual * (1.0F / scale);
  const Lane clipped = Eigen::Map<const Lane, Eigen::Aligned16>(samples.clipped.data() + first);
  const auto uninformative = clipped > 0.5F && residual < 0.0F;
  Lane robust = uninformative.select(0.0F, 1.0F / (1.0F + relative * relative));
  for (int k = samples.count - first; k < kLane; ++k) robust[k] = 0.0F;
  return robust;
}

}  // namespace

ShadowBrightness::ShadowBrightness(const ShadowUnknowns& x, const ShadowEdges& edges, const SoftStep& step)
    : step_(&step) {
  const Eigen::Vector2d tip = x.segment<2>(kTipX);
  const Eigen::Vector2d foot = x.segment<2>(kFootX);
  const Outline outline = outline_of(foot, x[kRadius], tip);
  valid_ = outline.valid;
  if (!valid_) return;
  for (std::size_t side = 0; side < 2; ++side) {
    const Eigen::Vector2d line = tip - outline.touch[side];
    const Eigen::Vector2f along = (line / line.squaredNorm()).cast<float>();
    const Eigen::Vector2f inward = outline.inward[side].cast<float>();
    line_[side] = {inward.x(), inward.y(), along.x(), along.y()};
  }
  const Eigen::Vector2f off = (foot - edges.foot).cast<float>();
  off_x_ = off.x();
  off_y_ = off.y();
  radius_ = static_cast<float>(x[kRadius]);
  dark_ = static_cast<float>(x[kDark]);
  level_ = static_cast<float>(x[kLevel]);
  slope_x_ = static_cast<float>(x[kSlopeX]);
  slope_y_ = static_cast<float>(x[kSlopeY]);
  blur_ = static_cast<float>(edges.blur_m);
  disc_ = edges.like_image ? 0.0F : 1.0F;
  penumbra_ = static_cast<float>(x[kSoftness]);
  const auto lit = static_cast<float>(std::max(1.0, x[kLevel] - edges.zero));
  contrast_ = std::clamp(dark_ / lit, kLeastContrast, kMostContrast);
  is_clamped_ = contrast_ != dark_ / lit;
  in_shadow_ = std::pow(1.0F - contrast_, kPower);
}

/// Where half of the lamp is hidden, a deep shadow has not lost half of its contrast yet.
/// \param coded  0..1. \param slope  its derivative by `hidden`. \param by_contrast  of coded times contrast, by the contrast.
void ShadowBrightness::code(const Lane& hidden, Lane& coded, Lane& slope, Lane& by_contrast) const {
  const Lane light = 1.0F - hidden * (1.0F - in_shadow_);
  const Lane level = coded_level(light);
  coded = (1.0F - level) * (1.0F / contrast_);
  const Lane steep = level / light;
  slope = ((1.0F - in_shadow_) / (kPower * contrast_)) * steep;
  by_contrast = is_clamped_ ? coded : ((in_shadow_ / (1.0F - contrast_)) * hidden * steep).eval();
}

ShadowBrightness::Value ShadowBrightness::at(const Eigen::Vector2f& from_foot) const {
  const float qx = from_foot.x() - off_x_;
  const float qy = from_foot.y() - off_y_;
  float hidden = -1.0F;
  for (const Line& line : line_) {
    const float d = qx * line.inward_x + qy * line.inward_y + radius_;
    const float soft = penumbra_ * std::clamp(qx * line.along_x + qy * line.along_y, 0.0F, 1.0F);
    const float variance = soft * soft + blur_ * blur_;
    hidden += step_->at(d / std::sqrt(variance), disc_ * soft * soft / variance).share;
  }
  Lane coded;
  Lane slope;
  Lane by_contrast;
  code(Lane::Constant(std::max(0.0F, hidden)), coded, slope, by_contrast);
  return {level_ + slope_x_ * from_foot.x() + slope_y_ * from_foot.y(), coded[0]};
}

ShadowSums ShadowBrightness::sum_up(const ShadowSamples& samples) const {
  const float scale = std::max(kLeastScale, kScale * std::abs(dark_));
  LaneSums<kShadowUnknowns> table;
  LaneSums<kShadowUnknowns>::Row j;
  for (int i = 0; i < samples.count; i += kLane) {
    const Lane x = Eigen::Map<const Lane, Eigen::Aligned16>(samples.x.data() + i);
    const Lane y = Eigen::Map<const Lane, Eigen::Aligned16>(samples.y.data() + i);
    const Lane value = Eigen::Map<const Lane, Eigen::Aligned16>(samples.value.data() + i);
    const Lane qx = x - off_x_;
    const Lane qy = y - off_y_;
    Lane hidden = Lane::Constant(-1.0F);
    std::array<Lane, 2> J_tip;
    std::array<Lane, 2> J_foot;
    Lane J_softness = Lane::Zero();
    for (std::size_t side = 0; side < 2; ++side) {
      const Line& line = line_[side];
      const Lane d = qx * line.inward_x + qy * line.inward_y + radius_;
      const Lane way = (qx * line.along_x + qy * line.along_y).max(0.0F).min(1.0F);
      const Lane soft = penumbra_ * way;
      const Lane over_sigma = 1.0F / (soft * soft + blur_ * blur_).sqrt();
      Lane share;
      Lane density;
      const Lane of_lamp = soft * over_sigma;
      step_->at(d * over_sigma, disc_ * of_lamp * of_lamp, share, density);
      hidden += share;
      const Lane J_d = -dark_ * density * over_sigma;
      J_tip[side] = J_d * way;
      J_foot[side] = J_d - J_tip[side];
      J_softness -= J_d * d * soft * way * over_sigma * over_sigma;
    }
    const auto lit = hidden <= 0.0F;
    Lane coded;
    Lane slope;
    Lane by_contrast;
    code(lit.select(0.0F, hidden), coded, slope, by_contrast);
    for (std::size_t side = 0; side < 2; ++side) {
      J_tip[side] = lit.select(0.0F, J_tip[side] * slope);
      J_foot[side] = lit.select(0.0F, J_foot[side] * slope);
    }
    j[kTipX] = -J_tip[0] * line_[0].inward_x - J_tip[1] * line_[1].inward_x;
    j[kTipY] = -J_tip[0] * line_[0].inward_y - J_tip[1] * line_[1].inward_y;
    j[kFootX] = -J_foot[0] * line_[0].inward_x - J_foot[1] * line_[1].inward_x;
    j[kFootY] = -J_foot[0] * line_[0].inward_y - J_foot[1] * line_[1].inward_y;
    j[kRadius] = J_foot[0] + J_foot[1];
    j[kDark] = -by_contrast;
    j[kLevel] = 1.0F - contrast_ * (coded - by_contrast);
    j[kSoftness] = lit.select(0.0F, J_softness * slope);
    j[kSlopeX] = x;
    j[kSlopeY] = y;
    const Lane residual = value - (level_ + slope_x_ * x + slope_y_ * y - dark_ * coded);
    j[LaneSums<kShadowUnknowns>::kResidual] = residual;
    table.add(j, weights(residual, scale, samples, i));
  }
  ShadowSums sums;
  table.put_into(sums);
  return sums;
}

}  // namespace cgsr::illumination
