#include "pipeline/color/track/illuminant_filter.h"

#include <algorithm>
#include <cmath>

namespace cgsr::color {
namespace {

constexpr double kDarkest = 0.1;
constexpr double kBrightest = 4.0;

/// A mean of gains in the logarithm, each weighted by its inverse variance.
class WeightedMean {
 public:
  void add(double gain, double error) {
    const double weight = 1.0 / (error * error);
    sum_ += weight * std::log(std::clamp(gain, kDarkest, kBrightest));
    weights_ += weight;
  }
  [[nodiscard]] double gain() const { return std::exp(sum_ / weights_); }

 private:
  double sum_ = 0.0;
  double weights_ = 0.0;
};

}  // namespace

void IlluminantFilter::begin(const Light& gain, const ChannelQuantiles& image) {
  first_image_ = image;
  first_gain_ = gain;
  gain_ = gain;
  begun_ = true;
}

void IlluminantFilter::add(const ChannelQuantiles& image, const Light& change,
                           const std::optional<MeasuredGain>& object) {
  if (!begun_) return;
  const IlluminantParameters& p = parameters_;
  const MeasuredGain whole = measured_gain(first_image_, image);
  const auto channel = [&](double Light::*c) {
    WeightedMean mean;
    mean.add(gain_.*c * (change.*c), p.step_error);
    mean.add(first_gain_.*c, p.prior_sigma);
    mean.add(first_gain_.*c * (whole.gain.*c), std::hypot(p.image_error * (whole.residual.*c), p.min_error));
    if (object) mean.add(object->gain.*c, std::hypot(p.object_error * (object->residual.*c), p.min_error));
    return mean.gain();
  };
  gain_ = {channel(&Light::r), channel(&Light::g), channel(&Light::b)};
}

}  // namespace cgsr::color
