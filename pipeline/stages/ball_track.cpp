#include "pipeline/stages/ball_track.h"

#include <optional>

namespace cgsr::stages {
namespace {

color::ShadeMaskView mask_of(const runtime::Aged<ShadowMasks>& shade) {
  const ShadowMasks* const masks = shade.within(kMaxMaskAge);
  if (masks == nullptr || !masks->masks) return {};
  const shade::ShadeMasks& cells = *masks->masks;
  return {cells.possibly_shaded.data(), cells.width, cells.height, cells.width};
}

/// Places of the map, as the shadow masks' pose and lamp have them.
class ShadeInMap final : public color::ShadeAtPlace {
 public:
  explicit ShadeInMap(const shade::ShadowVolumes& volumes) : volumes_(volumes) {}

  [[nodiscard]] bool may_be_shaded(const color::Circle& circle, double diameter_m) const override {
    return volumes_.may_be_shaded(in_image(circle, diameter_m));
  }
  [[nodiscard]] bool is_shaded(const color::Circle& circle, double diameter_m) const override {
    return volumes_.is_shaded(in_image(circle, diameter_m));
  }

 private:
  static shade::BallInImage in_image(const color::Circle& circle, double diameter_m) {
    return {{circle.x_px - 0.5, circle.y_px - 0.5}, circle.radius_px, 0.5 * diameter_m};
  }

  const shade::ShadowVolumes& volumes_;
};

}  // namespace

ObjectTrack track_ball(color::IntegratedTracker& tracker, const ImageView& image,
                       const runtime::Aged<ShadowMasks>& shade, WorkBudget& budget) {
  const ShadowMasks* const masks = shade.within(kMaxPlacesAge);
  std::optional<ShadeInMap> places;
  if (masks != nullptr && masks->volumes) places.emplace(*masks->volumes);
  ObjectTrack track;
  track.ball = tracker.track(image, mask_of(shade), budget, places ? &places.value() : nullptr);
  track.object = {track.ball.found, track.ball.box, track.ball.divergence, track.ball.light, track.ball.light, 0.0};
  return track;
}

}  // namespace cgsr::stages
