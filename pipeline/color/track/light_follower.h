#pragma once

#include "pipeline/color/learn/light.h"
#include "pipeline/color/track/light_estimate.h"
#include "pipeline/color/track/object_view.h"
#include "platform/parameters.h"

namespace cgsr::color {

/// How the light of the object is followed from image to image.
struct LightFollowerParameters {
  double max_step = 0.5;
  double agreement_step = 0.04;
  double anchor_rate = 0.1;
  double min_anchor_agreement = 0.7;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number(
        "max_step", self.max_step, {0.0, 2.0}, "",
        "A change of a channel between two images, as a logarithm, beyond which it is no change of the light.");
    visit.number("agreement_step", self.agreement_step, {0.001, 1.0}, "",
                 "The changes of the object and of the whole image are averaged when they differ by less than about "
                 "this, as a logarithm; otherwise the object's own is used.");
    visit.number("anchor_rate", self.anchor_rate, {0.0, 1.0}, "",
                 "The largest weight of the direct comparison with the learned colours in each image.");
    visit.number("min_anchor_agreement", self.min_anchor_agreement, {0.0, 1.0}, "",
                 "The agreement of the colours below which the direct comparison has no weight.");
  }
};

/// The light of the object relative to that of the image it was learned from, per channel, finer than the grid.
///
/// Two kinds of measurement are joined in the logarithm of the gain. A change from one image to the next, between two views of nearly the
/// same content, is accurate but its errors add up; it comes from the object's box, and from the whole image, which shows it also where the
/// object is not known. The direct comparison with the learned view does not drift, but takes another side of the object for another
/// light; it counts as far as the colours agree with the learned ones under it. Ours: the dissertation (3.2.2) takes the light of the
/// best histogram of each image alone.
class LightFollower {
 public:
  explicit LightFollower(const LightFollowerParameters& parameters) : parameters_(parameters) {}

  /// The light is `gain`, the image as a whole looks like `image` and the object like `object`.
  void begin(const Light& gain, const ChannelQuantiles& image, const ChannelQuantiles& object);

  /// A further image: the whole of it says how the light changed, until the object's own colours say it better.
  void predict(const ChannelQuantiles& image);

  /// The object is in the image that was predicted.
  /// \param object  its view. \param direct  light_gain() from the learned view. \param agreement  of the colours with the learned ones under
  ///        `direct`, 0..1.
  void update(const ChannelQuantiles& object, const Light& direct, double agreement);

  /// The object was not seen in this image: the next change of its view cannot be measured.
  void lose() { has_object_ = false; }

  /// The light as a place elsewhere in the image showed it.
  void set(const Light& gain) { gain_ = gain; }

  [[nodiscard]] const Light& gain() const { return gain_; }
  /// Since the last image, before any comparison with the learned view.
  [[nodiscard]] const Light& change() const { return change_; }

 private:
  LightFollowerParameters parameters_;
  Light gain_{1.0, 1.0, 1.0};
  Light before_{1.0, 1.0, 1.0};        ///< the gain of the last image,
  Light image_change_{1.0, 1.0, 1.0};  ///< and the whole image's change since.
  Light change_{1.0, 1.0, 1.0};
  ChannelQuantiles image_;
  ChannelQuantiles object_;
  bool has_image_ = false;
  bool has_object_ = false;
};

}  // namespace cgsr::color
