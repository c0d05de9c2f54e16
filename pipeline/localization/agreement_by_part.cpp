#include "pipeline/localization/agreement_by_part.h"

#include <algorithm>

namespace cgsr::localization {
namespace {

constexpr float kStep_px = 4.0F;

}  // namespace

AgreementByPart::AgreementByPart(int width_px, int height_px)
    : parts_per_px_(static_cast<float>(kColumns) / static_cast<float>(width_px),
                    static_cast<float>(kRows) / static_cast<float>(height_px)) {}

void AgreementByPart::spread(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float weight, float Part::*sum) {
  const float length = (to - from).norm();
  const int steps = std::max(1, static_cast<int>(length / kStep_px));
  const Eigen::Vector2f step = (to - from) / static_cast<float>(steps);
  const float each = weight * length / static_cast<float>(steps);
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector2f at = (from + (static_cast<float>(i) + 0.5F) * step).cwiseProduct(parts_per_px_);
    const int column = std::clamp(static_cast<int>(at.x()), 0, kColumns - 1);
    const int row = std::clamp(static_cast<int>(at.y()), 0, kRows - 1);
    parts_[static_cast<std::size_t>(row * kColumns + column)].*sum += each;
  }
}

void AgreementByPart::add(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float weight) {
  spread(from, to, weight, &Part::length);
}

void AgreementByPart::agree(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float weight) {
  spread(from, to, weight, &Part::agreeing);
}

float AgreementByPart::in_the_worst(float share) const {
  auto parts = parts_;
  const auto end = std::remove_if(parts.begin(), parts.end(), [](const Part& part) { return !(part.length > 0.0F); });
  const auto agreement = [](const Part& part) { return std::min(1.0F, part.agreeing / part.length); };
  std::sort(parts.begin(), end, [&](const Part& a, const Part& b) { return agreement(a) < agreement(b); });
  float whole = 0.0F;
  for (auto part = parts.begin(); part != end; ++part) whole += part->length;
  float so_far = 0.0F;
  for (auto part = parts.begin(); part != end; ++part) {
    so_far += part->length;
    if (so_far >= share * whole) return agreement(*part);
  }
  return 0.0F;
}

}  // namespace cgsr::localization
