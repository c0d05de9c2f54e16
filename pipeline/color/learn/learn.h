#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/color/learn/color_model.h"
#include "pipeline/color/learn/light.h"
#include "pipeline/imaging/color_bins.h"
#include "platform/error.h"
#include "platform/image_view.h"
#include "platform/parameters.h"

namespace cgsr::color {

/// How an object is learned (Alg. 3.1), and what the multi-colour constraint (3.1.2) does.
struct LearnParameters {
  imaging::ColorBins bins;
  LightParameters lights;
  double min_distinctiveness = 0.01;
  bool widen = true;
  double max_widening = 0.6;
  double surroundings = 0.5;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("bins", self.bins, "The colour histograms");
    visit.section("lights", self.lights, "The simulated lights");
    visit.number("min_distinctiveness", self.min_distinctiveness, Range{0.0, 0.6}, "nat",
                 "A region whose divergence from a single-coloured surface is less than this is widened or refused.");
    visit.flag("widen", self.widen,
               "A region that has too much of one colour is widened by its surroundings instead of being refused.");
    visit.number("max_widening", self.max_widening, Range{0.0, 2.0}, "",
                 "The largest growth of a box, as a ratio of its sides.");
    visit.number("surroundings", self.surroundings, Range{0.0, 2.0}, "",
                 "The width of the ring around the box whose colours are negative examples, as a ratio of the box's "
                 "sides; 0 uses none.");
  }
};

/// A view of the object: an image (YUYV) and the box around the object in it, in pixels of the image.
struct Sample {
  ImageView image;
  Box box;
};

/// What learning did, for the person who asked for it.
struct Learned {
  ColorModel model;
  std::vector<Box>
      windows;  ///< the learned window in each sample: the box, on whole pixels, widened where that was needed.
  double widened_by = 0.0;  ///< growth per side as a share of the box's side; 0: not widened.
  std::string message;      ///< how distinctive the region is and what was done about it and why; one or two sentences.
};

/// Alg. 3.1, Learn, over one or several samples.
///
/// Per sample: crop, take the assumed light max(channel maximum, parameters.lights.assumed) out of every pixel, count a histogram
/// under every plausible light of the grid (Eq. 3.1). Several samples: the mean of their histograms light by light, which are all
/// relative to their own assumed light. The multi-colour constraint (3.1.2) is judged on all samples together.
///
/// \return an error in words: no or too many samples, an image that is not YUYV, a box outside the image or smaller than 4x4 pixels, no plausible
///         light, a region of a single colour that may not or cannot be widened enough.
Result<Learned> learn(std::span<const Sample> samples, const LearnParameters& parameters);

/// Lines 3-16 of Alg. 3.1 on plain colours: finds the assumed light and takes it out. \param colors  recorded; textures afterwards.
Light take_out_light(std::span<imaging::Rgb> colors, double assumed);

/// Line 21 of Alg. 3.1: the histogram of textures under a light. \return bins.count() shares that sum to 1 (all 0 without textures).
std::vector<double> histogram_under(std::span<const imaging::Rgb> textures, const Light& light,
                                    const imaging::ColorBins& bins);

/// Adds a row to a model's histograms: shares that sum to 1 as whole numbers that sum to kHistogramMass. Rounded down, what is missing goes to
/// the largest remainders.
void append_counts(const std::vector<double>& shares, std::vector<std::uint16_t>& rows);

}  // namespace cgsr::color
