#pragma once

#include <optional>

#include "pipeline/color/learn/light.h"
#include "pipeline/color/track/light_estimate.h"
#include "platform/parameters.h"

namespace cgsr::color {

/// How far each measurement of the illuminant is believed; errors are of the logarithm of a gain.
struct IlluminantParameters {
  double image_error = 1.0;
  double object_error = 1.5;
  double min_error = 0.01;
  double step_error = 0.1;
  double prior_sigma = 0.1;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("image_error", self.image_error, {0.01, 100.0}, "",
                 "The error of the gain between the first image and this one, per unit of the relative difference that "
                 "this gain leaves between the two.");
    visit.number("object_error", self.object_error, {0.01, 100.0}, "",
                 "The same error of the gain between the learned object and the object in this image.");
    visit.number("min_error", self.min_error, {0.001, 1.0}, "",
                 "The error of both gains, as a logarithm, where they leave no difference.");
    visit.number("step_error", self.step_error, {0.001, 10.0}, "",
                 "The error, as a logarithm, of the estimate of the last image times the change since.");
    visit.number("prior_sigma", self.prior_sigma, {0.001, 10.0}, "",
                 "The standard deviation, as a logarithm, of the light of all images about that of the first sight.");
  }
};

/// The light that falls on the object, per channel, relative to that under which it was learned.
///
/// What the object looks like (LightFollower) is this light times what its own side, shading and surroundings do to it: right for comparing colours, but not
/// the lamp's. Three measurements are weighted by what they leave unexplained: the gain between the image of the first sight and this one as
/// wholes, which holds while the camera sees the same place; the gain between the learned object and the present one, which holds while it
/// shows the same side; and the last estimate times the change since. All are pulled towards the light of the first sight.
/// Ours: 3.2.2 of the dissertation takes the light of the best histogram, one of a grid.
class IlluminantFilter {
 public:
  explicit IlluminantFilter(const IlluminantParameters& parameters) : parameters_(parameters) {}

  /// The first sight of the object. \param gain  of its light. \param image  the whole of it.
  void begin(const Light& gain, const ChannelQuantiles& image);

  /// A further image; before the first sight nothing happens. \param change  of the light since the last image.
  /// \param object  the gain between the learned object and the present one, where it is seen.
  void add(const ChannelQuantiles& image, const Light& change, const std::optional<MeasuredGain>& object);

  /// \return {1, 1, 1} before the first sight.
  [[nodiscard]] const Light& gain() const { return gain_; }

 private:
  IlluminantParameters parameters_;
  ChannelQuantiles first_image_;
  Light first_gain_{1.0, 1.0, 1.0};
  Light gain_{1.0, 1.0, 1.0};
  bool begun_ = false;
};

}  // namespace cgsr::color
