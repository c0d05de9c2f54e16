#include "pipeline/illumination/shadow_brightness.h"

#include <algorithm>
#include <cmath>

#include "pipeline/illumination/board.h"

namespace cgsr::illumination {
namespace {

// Residuals beyond it count less and less: grey levels, and of the contrast.
constexpr float kLeastScale = 3.0F;
constexpr float kScale = 0.12F;

constexpr float kLeastContrast = 0.01F;
constexpr float kMostContrast = 0.98F;

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
  penumbra_ = static_cast<float>(x[kSoftness]);
  const auto lit = static_cast<float>(std::max(1.0, x[kLevel] - edges.black));
  contrast_ = std::clamp(dark_ / lit, kLeastContrast, kMostContrast);
  in_shadow_ = (1.0F - contrast_) * (1.0F - contrast_);
}

/// Where half of the lamp is hidden, a deep shadow has not lost half of its contrast yet.
void ShadowBrightness::code(const Lane& hidden, Lane& coded, Lane& slope) const {
  const Lane level = (1.0F - hidden * (1.0F - in_shadow_)).sqrt();
  coded = (1.0F - level) * (1.0F / contrast_);
  slope = (0.5F * (1.0F - in_shadow_) / contrast_) / level;
}

ShadowBrightness::Value ShadowBrightness::at(const Eigen::Vector2f& from_foot) const {
  const float qx = from_foot.x() - off_x_;
  const float qy = from_foot.y() - off_y_;
  float hidden = -1.0F;
  for (const Line& line : line_) {
    const float d = qx * line.inward_x + qy * line.inward_y + radius_;
    const float soft = penumbra_ * std::clamp(qx * line.along_x + qy * line.along_y, 0.0F, 1.0F);
    hidden += step_->at(d / std::sqrt(soft * soft + blur_ * blur_)).share;
  }
  Lane coded;
  Lane slope;
  code(Lane::Constant(std::max(0.0F, hidden)), coded, slope);
  return {level_ + slope_x_ * from_foot.x() + slope_y_ * from_foot.y(), coded[0]};
}

ShadowSums ShadowBrightness::sum_up(const ShadowSamples& samples) const {
  const float scale = std::max(kLeastScale, kScale * std::abs(dark_));
  LaneSums<kShadowUnknowns> table;
  LaneSums<kShadowUnknowns>::Row j;
  j[kLevel] = Lane::Ones();
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
      step_->at(d * over_sigma, share, density);
      hidden += share;
      const Lane J_d = -dark_ * density * over_sigma;
      J_tip[side] = J_d * way;
      J_foot[side] = J_d - J_tip[side];
      J_softness -= J_d * d * soft * way * over_sigma * over_sigma;
    }
    const auto lit = hidden <= 0.0F;
    Lane slope;
    code(lit.select(0.0F, hidden), hidden, slope);
    for (std::size_t side = 0; side < 2; ++side) {
      J_tip[side] = lit.select(0.0F, J_tip[side] * slope);
      J_foot[side] = lit.select(0.0F, J_foot[side] * slope);
    }
    j[kTipX] = -J_tip[0] * line_[0].inward_x - J_tip[1] * line_[1].inward_x;
    j[kTipY] = -J_tip[0] * line_[0].inward_y - J_tip[1] * line_[1].inward_y;
    j[kFootX] = -J_foot[0] * line_[0].inward_x - J_foot[1] * line_[1].inward_x;
    j[kFootY] = -J_foot[0] * line_[0].inward_y - J_foot[1] * line_[1].inward_y;
    j[kRadius] = J_foot[0] + J_foot[1];
    j[kDark] = -hidden;
    j[kSoftness] = lit.select(0.0F, J_softness * slope);
    j[kSlopeX] = x;
    j[kSlopeY] = y;
    const Lane residual = value - (level_ + slope_x_ * x + slope_y_ * y - dark_ * hidden);
    j[LaneSums<kShadowUnknowns>::kResidual] = residual;
    const Lane relative = residual * (1.0F / scale);
    Lane robust = 1.0F / (1.0F + relative * relative);
    for (int k = samples.count - i; k < kLane; ++k) robust[k] = 0.0F;
    table.add(j, robust);
  }
  ShadowSums sums;
  table.put_into(sums);
  return sums;
}

}  // namespace cgsr::illumination
