#pragma once

#include <array>

#include "pipeline/color/learn/color_model.h"
#include "pipeline/color/learn/light.h"
#include "pipeline/color/track/object_view.h"

namespace cgsr::color {

/// Where the brightness of each channel of a view lies: 32 quantiles of R, G and B in [0, 1].
struct ChannelQuantiles {
  static constexpr std::size_t kCount = 32;
  std::array<std::array<double, kCount>, 3> values{};
};

ChannelQuantiles channel_quantiles(const ObjectView& view);

/// The diagonal model (Eq. 3.1) between two sights of the same surface: per channel the factor g that makes seen = g * learned, by iteratively
/// reweighted least squares (L1; Holland and Welsch 1977) over the quantiles, without those that are cut off or black. Finer than
/// the grid of lights that the search compares with. Ours: the dissertation (3.2.2) knows the light of the best histogram only.
Light light_gain(const ChannelQuantiles& learned, const ChannelQuantiles& seen);

/// A gain, and per channel what it leaves of the second sight: the mean difference relative to the mean brightness, 1 where a channel says nothing.
struct MeasuredGain {
  Light gain{1.0, 1.0, 1.0};
  Light residual{1.0, 1.0, 1.0};
};

/// light_gain() with its residual.
MeasuredGain measured_gain(const ChannelQuantiles& learned, const ChannelQuantiles& seen);

/// \return the light of the model's grid that is nearest to `light`, channel by channel.
Light nearest_of(const ColorModel& model, const Light& light);

}  // namespace cgsr::color
