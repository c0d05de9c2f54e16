#pragma once

#include <array>
#include <cstdint>

#include "pipeline/localization/alternate.h"
#include "pipeline/localization/localizer_parameters.h"
#include "pipeline/localization/refinement.h"
#include "pipeline/localization/search.h"

namespace cgsr::localization {

/// Finds the pose in a prior that moves the image by a few pixels: refined from the prior's mean and from a few poses about it. Goes on over
/// several images where one image's budget does not hold all of them: without them nobody knows of an alternative hypothesis.
/// Ours: Alg. 4.1 starts from one pose.
class NearStarts {
 public:
  NearStarts(const GateParameters& parameters, Alternation& alternation);

  /// Begins anew about a prior that has been looked at from its mean. \param options  of the first start.
  void begin(const Belief& belief, const PriorShape& shape, const AlternateOptions& options);
  void stop() { running_ = false; }
  [[nodiscard]] bool running() const { return running_; }

  /// Works on one image as far as the budget goes. \return whether every start was refined: best() and lead() hold.
  bool go_on(const Belief& belief, const SegmentTable& perceived, WorkBudget& budget);

  /// The camera moved between images by X_C0C1.
  void carried(const geometry::Pose& X_C0C1);

  [[nodiscard]] const Estimate& best() const { return best_; }
  [[nodiscard]] float lead() const { return lead_; }

 private:
  static constexpr std::uint32_t kStarts = 9;  ///< the prior's mean among them.

  [[nodiscard]] geometry::Pose start(std::uint32_t number) const;
  [[nodiscard]] float rank_of(const Estimate& estimate) const;
  void verdict();

  GateParameters parameters_;
  Alternation* alternation_;
  Refinement refinement_;
  AlternateOptions options_;
  PriorShape shape_;
  geometry::Matrix6d metric_ = geometry::Matrix6d::Zero();
  geometry::Pose X_WC_began_ = geometry::Pose::Identity();
  std::array<Estimate, kStarts> found_;
  std::uint32_t next_ = 0;
  Estimate best_;
  float lead_ = 1.0F;
  bool running_ = false;
};

}  // namespace cgsr::localization
