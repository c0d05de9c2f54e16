#include "pipeline/color/track/light_follower.h"

#include <algorithm>
#include <cmath>

namespace cgsr::color {
namespace {

constexpr Light kUnchanged{1.0, 1.0, 1.0};
constexpr double kDarkest = 0.15;
constexpr double kBrightest = 4.0;

/// The change of light, or none where a channel changed by more than a lamp would.
Light plausible(const Light& change, double max_step) {
  const double largest = std::max({change.r, change.g, change.b});
  const double least = std::min({change.r, change.g, change.b});
  if (!(least > 0.0) || std::max(std::log(largest), -std::log(least)) > max_step) return kUnchanged;
  return change;
}

/// One channel's change by two measurements: their geometric mean where they agree, else the object's own.
double joined(double object, double image, double agreement_step) {
  const double difference = std::log(image / object) / agreement_step;
  return object * std::pow(image / object, 0.5 * std::exp(-difference * difference));
}

/// The geometric mean of two gains, `weight` of it the second.
double blended(double gain, double other, double weight) {
  return std::clamp(gain * std::pow(other / gain, weight), kDarkest, kBrightest);
}

}  // namespace

void LightFollower::begin(const Light& gain, const ChannelQuantiles& image, const ChannelQuantiles& object) {
  gain_ = gain;
  before_ = gain;
  image_change_ = kUnchanged;
  image_ = image;
  object_ = object;
  has_image_ = true;
  has_object_ = true;
}

void LightFollower::predict(const ChannelQuantiles& image) {
  before_ = gain_;
  image_change_ = has_image_ ? plausible(light_gain(image_, image), parameters_.max_step) : kUnchanged;
  change_ = image_change_;
  const Light now = lit(gain_, image_change_);
  gain_ = {std::clamp(now.r, kDarkest, kBrightest), std::clamp(now.g, kDarkest, kBrightest),
           std::clamp(now.b, kDarkest, kBrightest)};
  image_ = image;
  has_image_ = true;
}

void LightFollower::update(const ChannelQuantiles& object, const Light& direct, double agreement) {
  if (has_object_) {
    const Light change = plausible(light_gain(object_, object), parameters_.max_step);
    change_ = {joined(change.r, image_change_.r, parameters_.agreement_step),
               joined(change.g, image_change_.g, parameters_.agreement_step),
               joined(change.b, image_change_.b, parameters_.agreement_step)};
    gain_ = lit(before_, change_);
  }
  const double excess = (agreement - parameters_.min_anchor_agreement) / (1.0 - parameters_.min_anchor_agreement);
  const double weight = parameters_.anchor_rate * std::clamp(excess, 0.0, 1.0);
  gain_ = {blended(gain_.r, direct.r, weight), blended(gain_.g, direct.g, weight), blended(gain_.b, direct.b, weight)};
  object_ = object;
  has_object_ = true;
}

}  // namespace cgsr::color
