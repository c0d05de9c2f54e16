#pragma once

#include <vector>

#include "pipeline/color/learn/color_model.h"
#include "pipeline/color/search/similarity.h"
#include "pipeline/imaging/reduce.h"
#include "platform/box.h"

namespace cgsr::color {

/// How far any box of an image is from the learned object, under the light that fits best: the search's measure, plain, for a box that is
/// on no grid.
/// The distance of Alg. 3.2, line 7, the least over all learned histograms.
class BoxDivergence {
 public:
  BoxDivergence(const ColorModel& model, Divergence divergence);

  struct Answer {
    double divergence = 0.0;
    int light = 0;  ///< index into the model's lights.
  };
  /// \param image  reduced with the labels of the model. \param box  camera pixels; what lies outside the image is left out.
  Answer of(const imaging::ReducedImage& image, const Box& box);

 private:
  Divergence divergence_;
  Similarity similarity_;
  std::vector<int> counts_;  // by label, 0 for the colours of no learned histogram
};

}  // namespace cgsr::color
