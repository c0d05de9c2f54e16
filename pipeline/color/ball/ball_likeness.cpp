#include "pipeline/color/ball/ball_likeness.h"

#include <algorithm>
#include <numeric>

#include "pipeline/color/ball/image_part.h"

namespace cgsr::color {
namespace {

constexpr double kMaxShadeShare = 0.75;  // of a circle: the rest is too little to say how it is lit
constexpr double kDecay = 0.998;         // an image
constexpr double kMinImages = 5.0;       // in shade, to tell what is too dark for it
constexpr double kMinShare = 0.1;        // of them
constexpr double kHalfStep = 1.12;       // between two lights of the model, about
constexpr double kBinWidth = 0.05;

Box core_of(const Circle& circle) {
  const double side = kCoreSide * 2.0 * circle.radius_px;
  return {circle.x_px - 0.5 * side, circle.y_px - 0.5 * side, side, side};
}

}  // namespace

BallLikeness::BallLikeness(const BallModel& ball, const BallSearch& search, Divergence divergence, double diameter_m,
                           int max_width_px, int max_height_px)
    : bright_{search.bright_table(), BoxDivergence(ball.bright, divergence)},
      dark_{search.dark_table(), BoxDivergence(ball.dark, divergence)},
      diameter_m_(diameter_m),
      labels_(max_width_px, max_height_px) {}

Likeness BallLikeness::of(const BallPixels& pixels, const Circle& circle, int factor, const ShadeAtPlace* places) {
  factor_ = factor;
  const Box core = core_of(circle);
  if (places != nullptr && !places->may_be_shaded(circle, diameter_m_)) return in_the_light(pixels, core);
  if (looks_shaded_in_the_light(pixels, circle)) return {};
  const auto bright = nearest(bright_, pixels, core, Where::kEverywhere);
  const auto dark = nearest(dark_, pixels, core, Where::kShaded);
  if (dark.divergence < bright.divergence) return {dark.divergence, dark.light, true};
  return {bright.divergence, bright.light, false};
}

/// Of what stands in the light whatever its ray passes through: nearer to a dark histogram than to every bright one it is something darker than the
/// ball.
Likeness BallLikeness::in_the_light(const BallPixels& pixels, const Box& core) {
  const auto bright = nearest(bright_, pixels, core, Where::kEverywhere);
  if (nearest(dark_, pixels, core, Where::kEverywhere).divergence < bright.divergence) return {};
  return {bright.divergence, bright.light, false};
}

/// Is what lies outside the mask nearer to a dark histogram than to every bright one? Then it is something darker than the ball, however near
/// to a bright one it comes.
bool BallLikeness::looks_shaded_in_the_light(const BallPixels& pixels, const Circle& circle) {
  if (pixels.mask.empty() || shade_share(pixels, circle) > kMaxShadeShare) return false;
  const Box core = core_of(circle);
  return nearest(dark_, pixels, core, Where::kLit).divergence < nearest(bright_, pixels, core, Where::kLit).divergence;
}

/// By those pixels of a box that count; without a mask all do.
BoxDivergence::Answer BallLikeness::nearest(Histograms& of, const BallPixels& pixels, Box box, Where where) {
  if (where == Where::kShaded && !pixels.mask.empty()) {
    // What lies beside the rectangle of all shade is left out; what is lit in it speaks against the ball.
    const ImagePart shaded = shaded_part(pixels.mask, pixels.image);
    box = intersection(box, {1.0 * shaded.left, 1.0 * shaded.top, 1.0 * shaded.width, 1.0 * shaded.height});
    if (box.area() <= 0.0) return {Likeness::kUnlike, 0};
  }
  const ImagePart part = part_around(box, pixels.image);
  if (!imaging::reduce(cut(pixels.image, part), factor_, of.table, labels_)) return {Likeness::kUnlike, 0};
  if (where != Where::kEverywhere && !pixels.mask.empty()) {
    keep_only(where == Where::kLit ? Kept::kLit : Kept::kShaded, pixels.mask, pixels.image, part, labels_);
  }
  box.x -= part.left;
  box.y -= part.top;
  return of.divergence.of(labels_, box);
}

void LightInShade::fade() {
  for (double& images : images_) images *= kDecay;
}

std::size_t LightInShade::bin_of(double gain) {
  return std::min(static_cast<std::size_t>(std::max(0.0, gain) / kBinWidth), kBins - 1);
}

void LightInShade::add(double gain) {
  images_[bin_of(gain)] += 1.0;
}

bool LightInShade::is_plausible(double gain) const {
  const double all = std::reduce(images_.begin(), images_.end());
  const auto brighter = images_.begin() + static_cast<std::ptrdiff_t>(bin_of(gain * kHalfStep)) + 1;
  const double as_dark = std::reduce(images_.begin(), brighter);
  return all < kMinImages || as_dark >= kMinShare * all;
}

}  // namespace cgsr::color
