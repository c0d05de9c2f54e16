#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pipeline/color/track/orientation_histograms.h"
#include "pipeline/imaging/pyramid.h"
#include "platform/box.h"
#include "platform/parameters.h"

namespace cgsr::color {

/// lambda and r of the scale filter, as of CorrelationFilter, and the ratio of its scales.
struct ScaleParameters {
  double step = 1.03;
  double regularisation = 0.01;
  double learning_rate = 0.025;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("step", self.step, {1.005, 1.2}, "", "The ratio of neighbouring scales.");
    visit.number("regularisation", self.regularisation, {1e-6, 1.0}, "",
                 "The regularisation of the filter, which keeps weak frequencies from dominating.");
    visit.number("learning_rate", self.learning_rate, {0.0, 1.0}, "", "The weight of each new image in the filter.");
  }
};

/// Says by how much the object grew: a one-dimensional correlation filter over a pyramid of 17 patches of the object, each described by its
/// gradient orientations (DSST, Danelljan et al. 2014, doi 10.5244/C.28.65).
///
/// Memory is reserved at construction.
class ScaleFilter {
 public:
  static constexpr int kScales = 17;

  explicit ScaleFilter(const ScaleParameters& parameters);

  /// Forgets everything and learns how the object looks in `box`.
  void begin(const imaging::Pyramid& image, const Box& box);
  /// Learns how it looks now. Where a box about the same centre was just described, its description serves: in the spectrum over the scales
  /// a growth by n steps is a turn of the phase.
  void learn(const imaging::Pyramid& image, const Box& box);

  /// Back to what begin() learned.
  void forget();

  /// Growth of less than a quarter of a step is none.
  /// \return the factor by which `box` must grow about its centre to hold the object.
  double estimate(const imaging::Pyramid& image, const Box& box);

 private:
  // The features are real, so half of the spectrum over the scales says everything.
  static constexpr int kFrequencies = kScales / 2 + 1;
  static constexpr int kMostFeatures = 12 * 12 * kOrientations;
  struct Complex {
    float re = 0.0F;
    float im = 0.0F;
  };

  void describe(const imaging::Pyramid& image, const Box& box);
  void absorb(float rate, double growth_steps = 0.0);
  [[nodiscard]] std::optional<double> steps_from_described(const imaging::Pyramid& image, const Box& box) const;

  ScaleParameters parameters_;
  Box described_;                      ///< whose spectra re_ and im_ are,
  std::uint64_t described_build_ = 0;  ///< and in which image.
  imaging::PatchSize patch_{};
  std::size_t features_count_ = 0;
  std::array<double, kScales> factors_{};
  std::array<float, kScales> window_{};
  std::array<std::array<Complex, kScales>, kFrequencies> rotation_{};  // exp(-2 pi i k n / 17)
  std::array<Complex, kFrequencies> target_{};
  std::vector<float> samples_;                            // [scale][feature]
  std::array<std::vector<float>, kFrequencies> re_, im_;  // spectra of the patches at hand
  std::array<std::vector<float>, kFrequencies> numerator_re_, numerator_im_;
  std::array<std::vector<float>, kFrequencies> first_numerator_re_, first_numerator_im_;
  std::array<float, kFrequencies> denominator_{};
  std::array<float, kFrequencies> first_denominator_{};
};

}  // namespace cgsr::color
