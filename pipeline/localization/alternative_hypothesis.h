#pragma once

#include <cstdint>

#include "pipeline/localization/alternate.h"
#include "pipeline/localization/localizer_parameters.h"

namespace cgsr::localization {

/// A second pose beside a followed one. The followed pose may have settled on the wrong one of two edges that run along each other: a
/// shelf's board has two, and the books behind it a third. A belief as narrow as its own never leaves there, however little else fits. So
/// with every image one pose a few pixels off is tried; one that settles elsewhere and is as good goes along with the robot, and takes the
/// followed one's place once it has been clearly better over several images.
/// Ours: Alg. 4.1 follows one pose.
class AlternativeHypothesis {
 public:
  AlternativeHypothesis(const LocalizerParameters& parameters, Alternation& alternation);

  /// One image's work. \param followed  solved, from this image and belief.  \return it, or what takes its place.
  Estimate better_than(const Estimate& followed, const Belief& belief, const SegmentTable& perceived,
                       WorkBudget& budget);

  /// The camera moved between images by X_C0C1.
  void carried(const geometry::Pose& X_C0C1);

  /// The next image starts anew.
  void forget();

 private:
  [[nodiscard]] geometry::Pose proposal(const Estimate& followed, const geometry::Matrix6d& metric);

  Alternation* alternation_;
  LocalizerParameters parameters_;
  std::uint32_t proposals_ = 0;
  geometry::Pose X_WC_ = geometry::Pose::Identity();
  int images_ = 0;     ///< it has stood; 0: there is none.
  float lead_ = 0.0F;  ///< in agreement with the image, summed over the images and slowly forgotten.
};

}  // namespace cgsr::localization
