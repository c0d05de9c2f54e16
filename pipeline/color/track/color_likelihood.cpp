#include "pipeline/color/track/color_likelihood.h"

#include <algorithm>
#include <cmath>

namespace cgsr::color {
namespace {

/// The pixels whose centres lie within a length.
struct PixelSpan {
  int first;
  int end;
  PixelSpan(double from, double length)
      : first(static_cast<int>(std::floor(from + 0.5))), end(static_cast<int>(std::ceil(from + length - 0.5))) {}
  [[nodiscard]] bool holds(int pixel) const { return pixel >= first && pixel < end; }
};

}  // namespace

ColorLikelihood::ColorLikelihood()
    : object_(kBins), surroundings_(kBins), likelihood_(kBins, 0.5F), counted_in_(kBins), counted_out_(kBins) {}

void ColorLikelihood::learn(const ColorPatch& patch, const Box& inside, const Box& outside, double rate) {
  int count_in = 0;
  int count_out = 0;
  const PixelSpan columns_in(inside.x, inside.width);
  const PixelSpan columns_out(outside.x, outside.width);
  const PixelSpan rows_in(inside.y, inside.height);
  const PixelSpan rows_out(outside.y, outside.height);
  std::size_t at = 0;
  for (int y = 0; y < patch.size.height_px; ++y) {
    for (int x = 0; x < patch.size.width_px; ++x, ++at) {
      if (rows_in.holds(y) && columns_in.holds(x)) {
        counted_in_[bin_of(patch.y[at], patch.u[at], patch.v[at])] += 1.0F;
        ++count_in;
      } else if (!rows_out.holds(y) || !columns_out.holds(x)) {
        counted_out_[bin_of(patch.y[at], patch.u[at], patch.v[at])] += 1.0F;
        ++count_out;
      }
    }
  }
  const auto keep = static_cast<float>(1.0 - rate);
  const auto add_in = static_cast<float>(rate / std::max(1, count_in));
  const auto add_out = static_cast<float>(rate / std::max(1, count_out));
  constexpr float kUnseen = 1e-4F;  // share of a colour never seen: it is as likely the one as the other
  for (std::size_t i = 0; i < kBins; ++i) {
    const float object = keep * object_[i] + add_in * counted_in_[i];
    const float around = keep * surroundings_[i] + add_out * counted_out_[i];
    object_[i] = object;
    surroundings_[i] = around;
    likelihood_[i] = (object + 0.5F * kUnseen) / (object + around + kUnseen);
  }
  for (std::size_t i = 0; i < patch.y.size(); ++i) {  // cheaper than clearing all bins
    const std::size_t bin = bin_of(patch.y[i], patch.u[i], patch.v[i]);
    counted_in_[bin] = 0.0F;
    counted_out_[bin] = 0.0F;
  }
}

}  // namespace cgsr::color
