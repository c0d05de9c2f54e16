#pragma once

#include <array>
#include <cstddef>

#include "platform/parameters.h"

namespace cgsr::color {

/// The logistic regression of Confidence: a weight for each measure of Evidence, in the order of their declaration.
struct ConfidenceParameters {
  double smoothing = 0.15;
  double offset = -9.12;
  double sharpness_weight = 3.05;
  double agreement_weight = 0.6;
  double separation_weight = 3.44;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("smoothing", self.smoothing, {0.01, 1.0}, "",
                 "The weight of each new image in the smoothed measures.");
    visit.number("offset", self.offset, {-100.0, 100.0}, "", "The logarithm of the odds when every measure is 0.");
    visit.number("sharpness_weight", self.sharpness_weight, {-100.0, 100.0}, "",
                 "The weight of the logarithm of the peak's sharpness.");
    visit.number("agreement_weight", self.agreement_weight, {-100.0, 100.0}, "",
                 "The weight of the agreement with the learned colours under the followed light.");
    visit.number("separation_weight", self.separation_weight, {-100.0, 100.0}, "",
                 "The weight of the difference of the pixel likelihoods inside and around the box.");
  }
};

/// What is measured of the box in one image.
struct Evidence {
  double sharpness = 0.0;   ///< peak to sidelobe ratio of the shape.
  double agreement = 0.0;   ///< ColorAmounts::agreement with the learned ones under the followed light.
  double separation = 0.0;  ///< mean likelihood of the pixels inside the box less that around it.
};

/// How probable it is that the box covers the object (intersection over union of at least 0.5): a logistic regression (Cox 1958) on measures
/// that are smoothed over the images since the object was last found. Its weights were fitted to images of recorded sequences; the
/// divergence and the height of the response added nothing to these three. Ours: the dissertation (3.2.2) has the divergence alone.
class Confidence {
 public:
  explicit Confidence(const ConfidenceParameters& parameters) : parameters_(parameters) {}

  /// \return the probability, 0..1, after a further image.
  double add(const Evidence& evidence);

  /// The object was lost: what comes is measured anew.
  void reset() { measured_ = false; }

 private:
  static constexpr std::size_t kMeasures = 3;

  ConfidenceParameters parameters_;
  std::array<double, kMeasures> smoothed_{};
  bool measured_ = false;
};

}  // namespace cgsr::color
