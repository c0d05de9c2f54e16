#pragma once

#include <array>
#include <vector>

#include "pipeline/color/track/fourier.h"
#include "platform/parameters.h"

namespace cgsr::color {

/// Channels of a patch of 32x32 cells: nine gradient orientations, luma, U, V.
inline constexpr int kFilterChannels = 12;
using FilterFeatures = std::array<imaging::RealGrid, kFilterChannels>;

/// lambda, r and the width of G in the formulas of CorrelationFilter, and how much of the first image stays.
struct CorrelationParameters {
  double target_width = 0.0625;
  double regularisation = 0.001;
  double learning_rate = 0.01;
  double anchor = 0.1;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("target_width", self.target_width, {0.01, 0.5}, "",
                 "The width of the desired correlation peak, as a ratio of the object's size.");
    visit.number("regularisation", self.regularisation, {1e-6, 1.0}, "",
                 "The regularisation of the filter, which keeps weak frequencies from dominating.");
    visit.number("learning_rate", self.learning_rate, {0.0, 1.0}, "", "The weight of each new image in the filter.");
    visit.number("anchor", self.anchor, {0.0, 1.0}, "",
                 "The weight of the first image that the filter keeps for ever.");
  }
};

/// A discriminative correlation filter over several channels: it answers a patch with a peak where the object's centre is.
///
///   R = sum_k conj(A_k) F_k / (B + lambda),   A_k <- (1 - r) A_k + r conj(G) F_k,   B <- (1 - r) B + r sum_k |F_k|^2
///
/// with F the spectra of the windowed channels and G that of the wanted peak (MOSSE, Bolme et al. 2010, doi 10.1109/CVPR.2010.5539960;
/// several channels as in DSST, Danelljan et al. 2014, doi 10.5244/C.28.65).
class CorrelationFilter {
 public:
  explicit CorrelationFilter(const CorrelationParameters& parameters);

  /// Forgets everything and learns a first patch. \param object_cells  mean side of the object in cells: how wide the peak is.
  void begin(const FilterFeatures& features, double object_cells);

  /// Learns a further patch in which the object is in the middle.
  void learn(const FilterFeatures& features);

  /// The same of the patch that respond() was last asked about, without transforming it again. \param dx, dy  [cells] of the object's centre
  /// from the middle: a displacement is a turn of the spectrum's phase.
  void learn_last(double dx, double dy);

  /// Back to what begin() learned.
  void forget();

  /// \param response  of every displacement of the object's centre; (16, 16) is none.
  void respond(const FilterFeatures& features, imaging::RealGrid& response);

 private:
  using Spectra = std::array<imaging::Spectrum, kFilterChannels>;
  void transform(const FilterFeatures& features);
  void absorb(const imaging::Spectrum& target, float rate);

  CorrelationParameters parameters_;
  imaging::RealGrid window_;
  imaging::Spectrum target_;
  Spectra features_;         // of the patch at hand
  Spectra numerator_;        // A
  Spectra first_numerator_;  // A of the first patch
  imaging::RealGrid denominator_;
  imaging::RealGrid first_denominator_;
};

/// The highest point of a response, to a fraction of a cell.
struct Peak {
  double x = 0.0;  ///< cells.
  double y = 0.0;
  double value = 0.0;
  double sharpness =
      0.0;  ///< peak to sidelobe ratio: (value - mean) / standard deviation of what lies more than 3 cells away.
};
Peak peak_of(const imaging::RealGrid& response);

}  // namespace cgsr::color
