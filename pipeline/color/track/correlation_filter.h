#pragma once

#include <array>

#include "pipeline/color/track/fourier.h"
#include "platform/parameters.h"

namespace cgsr::color {

/// Channels of a patch of 32x32 cells: nine gradient orientations, luma, U, V.
inline constexpr int kFilterChannels = 12;
using FilterFeatures = std::array<RealGrid, kFilterChannels>;

/// gamma, mu and the width of G in the formulas of CorrelationFilter, and how often they are evaluated.
struct CorrelationParameters {
  double target_width = 0.0625;
  double support_weight = 1.0;
  double temporal_weight = 20.0;
  int first_rounds = 4;
  int rounds = 2;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("target_width", self.target_width, {0.01, 0.5}, "",
                 "The width of the desired correlation peak, as a ratio of the object's size.");
    visit.number(
        "support_weight", self.support_weight, {1e-4, 1e4}, "",
        "The weight of the constraint that the filter is zero beside the object, relative to the mean power of "
        "the features.");
    visit.number("temporal_weight", self.temporal_weight, {0.0, 1e4}, "",
                 "The weight of the filter of the last image, relative to the mean power of the features.");
    visit.number("first_rounds", self.first_rounds, {1, 20}, "", "The number of rounds for the first image.");
    visit.number("rounds", self.rounds, {1, 20}, "", "The number of rounds for every further image.");
  }
};

/// A discriminative correlation filter over several channels: it answers a patch with a peak where the object's centre is.
///
///   R = sum_k conj(H_k) F_k,   H minimises |R - G|^2 + mu |H - H'|^2,   H_k zero in space beside the object
///
/// with F the spectra of the windowed channels, G that of the wanted peak, H' the filter of the image before. The whole patch is a
/// negative example at every displacement, and none of it is taken for the object (background-aware filters, Galoogahi et al. 2017,
/// doi 10.1109/ICCV.2017.129); mu keeps what earlier images taught without keeping the images (STRCF, Li et al. 2018,
/// doi 10.1109/CVPR.2018.00515). Solved by the alternating direction method of multipliers: for each frequency in closed form
/// (Sherman and Morrison 1950), then cut to the object in space.
class CorrelationFilter {
 public:
  explicit CorrelationFilter(const CorrelationParameters& parameters);

  /// Forgets everything and learns a first patch. \param width_cells, height_cells  of the object, which is in the middle.
  void begin(const FilterFeatures& features, double width_cells, double height_cells);

  /// Learns a further patch in which the object is in the middle.
  void learn(const FilterFeatures& features);

  /// The same of the patch that respond() was last asked about, without transforming it again. \param dx, dy  [cells] of the object's centre
  /// from the middle: a displacement is a turn of the spectrum's phase.
  void learn_last(double dx, double dy);

  /// \param response  of every displacement of the object's centre; (16, 16) is none.
  void respond(const FilterFeatures& features, RealGrid& response);

 private:
  using Spectra = std::array<Spectrum, kFilterChannels>;
  void set_support(double width_cells, double height_cells);
  void transform(const FilterFeatures& features);
  void train(const Spectrum& target, int rounds, double temporal_weight);
  void fit(const Spectrum& target, float support_weight, float temporal_weight);
  void cut_to_support();

  CorrelationParameters parameters_;
  RealGrid window_;
  RealGrid support_;  ///< 1 where the object is, 0 beside it.
  RealGrid power_;    ///< sum over the channels of |F|^2.
  Spectrum target_;
  Spectra features_;    ///< F of the patch at hand.
  Spectra filter_;      ///< H
  Spectra previous_;    ///< H'
  Spectra cut_;         ///< H cut to the support,
  Spectra multiplier_;  ///< and the sum of what was cut off so far, for the constraint.
};

/// The highest point of a response, to a fraction of a cell.
struct Peak {
  double x = 0.0;  ///< cells.
  double y = 0.0;
  double value = 0.0;
  double sharpness =
      0.0;  ///< peak to sidelobe ratio: (value - mean) / standard deviation of what lies more than 3 cells away.
};
Peak peak_of(const RealGrid& response);

}  // namespace cgsr::color
