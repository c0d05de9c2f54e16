#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/color/learn/light.h"
#include "pipeline/imaging/color_bins.h"
#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::color {

/// Every learned histogram sums to this.
inline constexpr int kHistogramMass = 1 << 15;

inline constexpr int kMaxSamples = 16;
inline constexpr int kMaxLights = 125;
inline constexpr int kMaxPatchSide = 128;

/// A piece of a sample image, kept small: the window that was learned and what lay around it, resampled. For what refines a found
/// window by more than its colour histogram, and for a preview.
struct SamplePatch {
  int width_px = 0;   ///< even, 16..kMaxPatchSide.
  int height_px = 0;  ///< 16..kMaxPatchSide.
  std::vector<std::uint8_t> yuyv;
  Box window;            ///< the learned window in pixels of the patch.
  double scale_x = 1.0;  ///< pixels of the patch per pixel of the sample image.
  double scale_y = 1.0;
  Light light;  ///< the light that Alg. 3.1 assumed on this sample (lines 9-11).

  [[nodiscard]] ImageView view() const { return {yuyv.data(), width_px, height_px, width_px * 2, PixelFormat::kYuyv}; }
};

/// What Alg. 3.1 leaves of an object: one colour histogram per simulated light, of the object and of what surrounded it.
/// Made by learn(), saved and loaded by model_file.h, searched for by WindowSearch.
struct ColorModel {
  imaging::ColorBins bins;
  std::vector<Light> lights;  ///< 1..kMaxLights.

  /// One row of bins.count() counts per light, each row summing to kHistogramMass.
  std::vector<std::uint16_t> object;
  /// The same of the surroundings at learning (chapter 6's negatives); empty when there were none.
  std::vector<std::uint16_t> surroundings;

  double width_px = 0.0;  ///< learned window, mean over the samples, in camera pixels.
  double height_px = 0.0;
  Box object_box;  ///< the box that was asked for, in pixels from the window's corner; widening makes it differ from the window.
  int image_width_px = 0;  ///< of the first sample image.
  int image_height_px = 0;

  double distinctiveness = 0.0;  ///< see distinctiveness.h.
  std::vector<SamplePatch> samples;

  [[nodiscard]] std::span<const std::uint16_t> object_under(std::size_t light) const { return row(object, light); }
  [[nodiscard]] std::span<const std::uint16_t> surroundings_under(std::size_t light) const {
    return surroundings.empty() ? std::span<const std::uint16_t>{} : row(surroundings, light);
  }

 private:
  [[nodiscard]] std::span<const std::uint16_t> row(const std::vector<std::uint16_t>& rows, std::size_t light) const {
    const auto width = static_cast<std::size_t>(bins.count());
    return {rows.data() + light * width, width};
  }
};

/// \return what keeps the model from being used, in words; empty when nothing does. Every model passes here before use: learned or loaded.
std::string defect_of(const ColorModel& model);

}  // namespace cgsr::color
