#pragma once

#include <optional>

#include "pipeline/localization/alternate.h"

namespace cgsr::localization {

/// Alternation::refine over several images: what one image's budget cuts off goes on in the next image, from the pose that it came to.
/// Ours: Alg. 4.1 works on one image.
class Refinement {
 public:
  explicit Refinement(Alternation& alternation) : alternation_(&alternation) {}

  /// Forgets what is under way.
  void stop() { under_way_.reset(); }

  /// Goes on with what is under way, or begins at `start`. \return the estimate; nothing when the budget cut it off.
  std::optional<Estimate> refine(const geometry::Pose& start, const Belief& belief, const SegmentTable& perceived,
                                 const AlternateOptions& options, WorkBudget& budget);

  /// The camera moved between images by X_C0C1.
  void carried(const geometry::Pose& X_C0C1);

 private:
  struct Progress {
    geometry::Pose X_WC;
    int rounds;
  };

  Alternation* alternation_;
  std::optional<Progress> under_way_;
};

}  // namespace cgsr::localization
