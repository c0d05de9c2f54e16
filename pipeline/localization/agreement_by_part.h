#pragma once

#include <array>

#include <Eigen/Core>

namespace cgsr::localization {

/// How image and map agree in each part of the image. A wrong pose explains one thing, a floor's tape say, and leaves open all that stands
/// beside it; a right one fails here and there.
/// Ours, for the gate: Alg. 4.1 judges no pose. Places are pixels of the working image without lens.
class AgreementByPart {
 public:
  AgreementByPart(int width_px, int height_px);

  void clear() { parts_.fill({}); }
  /// A stretch of an edge that is expected, or was perceived.  \param weight  what a pixel of it counts.
  void add(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float weight);
  /// A stretch on which both agree.
  void agree(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float weight);

  /// \return the agreement, 0..1, that parts which hold `share` of all that was added do not exceed; 0 when nothing was.
  [[nodiscard]] float in_the_worst(float share) const;

 private:
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;
  struct Part {
    float length = 0.0F;
    float agreeing = 0.0F;
  };

  void spread(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float weight, float Part::*sum);

  Eigen::Vector2f parts_per_px_;
  std::array<Part, kColumns * kRows> parts_{};
};

}  // namespace cgsr::localization
