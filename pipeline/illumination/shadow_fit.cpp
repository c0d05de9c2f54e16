#include "pipeline/illumination/shadow_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using enum ShadowBrightness::Unknown;

constexpr double kBlur_px = 0.55;         // of lens, pixel and reading between pixels
constexpr double kStartOfLine_m = 0.003;  // nearer to the base its own contact is seen
constexpr double kEndOfLine = 0.9;        // of the way to the tip's shadow, which is soft all over
constexpr double kEndWithTip = 1.1;       // the tip is most of what is seen
constexpr int kAcross = 9;                // samples across a line
constexpr int kLeastAcross = 5;           // of them to be seen
constexpr int kLeastSamples = 20;         // for a fit at all
constexpr int kLeastSparse = 24;
constexpr double kSparseContrast = 6.0;  // grey levels; a weaker one needs all samples from the start
constexpr double kSettled_m = 0.0015;    // a tip that moved less needs no other samples
constexpr int kChoices = 8;              // of samples, at most
constexpr int kMostAlong = 14;           // places along a line
constexpr double kCorrelation = 1.6;     // samples read between pixels are not independent
constexpr double kRadiusSigma_m = 0.0003;
constexpr double kUnknown_m = 0.5;     // sigma of a tip of which nothing is known
constexpr double kSlopeSigma = 100.0;  // grey levels per metre
constexpr double kLongestStep = 0.35;  // of the shadow's length: no further than samples reach
constexpr double kLeastRadius_m = 0.005;
constexpr double kMostRadius_m = 0.4;
constexpr double kMostChange = 2.0;     // a factor of the softness in one step
constexpr double kLeastVariance = 0.3;  // grey levels squared
constexpr double kOverClipped =
    0.25;  // so much brighter than the image holds a board is likely to be, with that standard deviation
constexpr double kMinDarkSigmas = 6.0;  // of a contrast
// Of 255: from where to where a colour tells the ceiling.
constexpr float kLeastColor = 110.0F;
constexpr float kMostColor = 240.0F;
// What the dark side of the edges leaves open: how far they lie from where they seem to, alike along both lines, as a share of the penumbra; and from which
// share of clipped samples on. From tuning homes (homes-5.1, seeds 22 and 23).
constexpr double kEdgeShare = 0.45;
constexpr double kHalfClipped = 0.3;
// Added to a clipped fit's covariance, in its own units and times the share of clipped samples: what is left of the edges hangs on the penumbra's exact shape,
// and errs alike along a line. From tuning homes (homes-5.1, seeds 5 to 8).
constexpr double kClippedVariance = 8.0;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;

}  // namespace

ShadowFit::ShadowFit(const Probe& probe, const Board& board, const ShadowParameters& parameters, double lamp_height_m)
    : board_(board),
      probe_(probe),
      parameters_(parameters),
      softness_per_radius_(softness_per_radius(probe.p_BA.z(), lamp_height_m)) {
  edges_.foot = probe_.foot_B;
}

// The part of a line that lies on the board, so that a long shadow's samples do not fall beside it.
double ShadowFit::reach_on_board(const Vector2d& from, const Vector2d& line, double most) const {
  double reach = most;
  for (int axis = 0; axis < 2; ++axis) {
    const double edge = (axis == 0 ? board_.depth_m : board_.width_m) / 2 - kBoardMargin_m;
    const double end = from[axis] + line[axis];
    if (std::abs(end) > edge) reach = std::min(reach, (std::copysign(edge, end) - from[axis]) / line[axis]);
  }
  return reach;
}

void ShadowFit::choose(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
                       const Choice& choice) {
  const Outline outline = outline_of(probe_.foot_B, probe_.radius_m, choice.tip_shadow);
  samples_.clear();
  edges_.zero = image.levels().zero;
  if (!outline.valid) return;
  int place = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const Vector2d line = choice.tip_shadow - outline.touch[side];
    const double length = line.norm();
    const double reach = reach_on_board(outline.touch[side], line, choice.with_tip ? kEndWithTip : kEndOfLine);
    const double begin = kStartOfLine_m / length;
    if (reach <= begin) continue;
    const Vector2d middle_B = outline.touch[side] + 0.4 * reach * line;
    const auto middle = view.derivative({middle_B.x(), middle_B.y(), 0.0});
    if (!middle.in_front) continue;
    const double line_px = (middle.J_point.leftCols<2>() * line).norm() * (reach - begin);
    int places = std::clamp(static_cast<int>(line_px / parameters_.spacing_px), 5, kMostAlong);
    if (choice.sparse) places = std::max(5, places / 2);
    const int samples_across = choice.sparse ? kAcross / 2 + 1 : kAcross;
    for (int i = 0; i < places; ++i) {
      const double along = begin + (reach - begin) * (i + 0.5) / places;
      const Vector2d centre = outline.touch[side] + along * line;
      const auto d = view.derivative({centre.x(), centre.y(), 0.0});
      if (!d.in_front) continue;
      const Vector2d across = d.J_point.leftCols<2>() * outline.inward[side];
      const double m_per_px = 1.0 / across.norm();
      edges_.blur_m = kBlur_px * m_per_px;
      const double half = std::max(2.2 * m_per_px, 2.2 * std::min(along, 1.0) * choice.softness_m) + choice.slack_m;
      const int before = samples_.count;
      const int clipped_before = samples_.clipped_count;
      for (int k = 0; k < samples_across && samples_.count < ShadowSamples::kMost; ++k) {
        const double t = half * (2.0 * k / (samples_across - 1) - 1.0);
        const Vector2d p_B = centre + t * outline.inward[side];
        const Vector2d pixel = d.at + t * across;
        if (!image.holds(pixel.x(), pixel.y(), 1.0) || !is_seen(board_, behind, p_B)) continue;
        const float level = image.at(pixel.x(), pixel.y());
        pixel_[static_cast<std::size_t>(samples_.count)] = pixel.cast<float>();
        samples_.add((p_B - probe_.foot_B).cast<float>(), level, image.is_clipped(pixel.x(), pixel.y(), level), place);
      }
      if (samples_.count - before < (choice.with_tip || choice.sparse ? 3 : kLeastAcross)) {
        samples_.count = before;
        samples_.clipped_count = clipped_before;
        continue;
      }
      side_of_[static_cast<std::size_t>(place++)] = side;
    }
  }
  if (samples_.clipped_count > 0) samples_.clip_at(ceiling(image));
}

// The level at which the brightest colour is clipped: as far above the levels of places that are not clipped as their brightest colour is below its
// end. Places that are nearly as bright count most, for their light is nearly the board's.
float ShadowFit::ceiling(const LumaView& image) const {
  float brightness = 0.0F;
  float color = 0.0F;
  float lowest = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < static_cast<std::size_t>(samples_.count); ++i) {
    if (samples_.clipped[i] != 0.0F) lowest = std::min(lowest, samples_.value[i]);
    const auto shown = image.shown_at(pixel_[i].x(), pixel_[i].y());
    if (shown.brightest_color < kLeastColor || shown.brightest_color > kMostColor) continue;
    const float squared = shown.brightest_color * shown.brightest_color;
    brightness += squared * squared * shown.brightness;
    color += squared * squared * shown.brightest_color;
  }
  return color > 0.0F ? image.level_of(image.full_color() * brightness / color) : lowest;
}

bool ShadowFit::choose_enough(const LumaView& image, const BoardView& view,
                              const std::array<Outline, kMostProbes>& behind, Choice choice) {
  choose(image, view, behind, choice);
  if (choice.sparse && samples_.count < kLeastSparse) {
    choice.sparse = false;
    choose(image, view, behind, choice);
  }
  return samples_.count >= (choice.with_tip ? kLeastSamples / 2 : choice.sparse ? kLeastSparse : kLeastSamples);
}

// What is known beside the samples: the base, and very weakly what they may not tell: with one line the place along it, and how bright a board is
// that the image can't hold.
void ShadowFit::add_known(const ShadowUnknowns& x, const ShadowStart& start, ShadowSums& sums) const {
  const auto add = [&](int unknown, double sigma2, double off) {
    sums.H(unknown, unknown) += 1.0 / sigma2;
    sums.g[unknown] += off / sigma2;
  };
  const double foot2 = std::max(1e-10, board_.place_sigma_m * board_.place_sigma_m);
  const double known_m = start.known_m > 0.0 ? start.known_m : kUnknown_m;
  for (int axis = 0; axis < 2; ++axis) {
    add(kFootX + axis, foot2, probe_.foot_B[axis] - x[kFootX + axis]);
    add(kTipX + axis, known_m * known_m, start.tip_shadow[axis] - x[kTipX + axis]);
    add(kSlopeX + axis, kSlopeSigma * kSlopeSigma, 0.0);
  }
  add(kRadius, kRadiusSigma_m * kRadiusSigma_m, probe_.radius_m - x[kRadius]);
  const double softness_sigma = softness_per_radius_ * parameters_.lamp_radius_sigma_m;
  add(kSoftness, softness_sigma * softness_sigma, softness_per_radius_ * parameters_.lamp_radius_m - x[kSoftness]);
  sums.H(kDark, kDark) += 1e-6;
  if (samples_.clipped_count > 0) {
    const double over = kOverClipped * (start.seen_level - edges_.zero);
    add(kLevel, over * over, start.seen_level + over - x[kLevel]);
  }
}

// Gauss-Newton: few samples until the tip stays where it is, then all of them.
bool ShadowFit::settle(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
                       const ShadowStart& start, Fitted& fitted) {
  ShadowUnknowns& x = fitted.x;
  const bool with_tip = start.known_m > 0.0;
  double moved_m = 1.0;
  bool settled = false;
  for (int round = 0; round < kChoices && !settled; ++round) {
    settled = round + 1 == kChoices || (round > 0 && moved_m < kSettled_m);
    Choice choice;
    choice.tip_shadow = x.head<2>();
    choice.softness_m = x[kSoftness];
    choice.slack_m = round == 0 ? std::min(0.004, 0.08 * (choice.tip_shadow - probe_.foot_B).norm()) : 0.001;
    choice.with_tip = with_tip;
    choice.sparse = !settled && !with_tip && start.contrast > kSparseContrast;
    if (!choose_enough(image, view, behind, choice)) return false;
    edges_.like_image = round == 0;
    const int steps = round == 0 ? 3 : 2;
    for (int step = 0; step < steps; ++step) {
      const ShadowBrightness model(x, edges_, step_);
      if (!model.valid()) return false;
      ShadowSums sums = model.sum_up(samples_);
      fitted.variance = std::max(kLeastVariance, sums.squares / std::max(1.0, sums.weights - kShadowUnknowns));
      sums.H /= fitted.variance * kCorrelation;
      sums.g /= fitted.variance * kCorrelation;
      add_known(x, start, sums);
      fitted.information = sums.H;
      const Eigen::LLT<ShadowNormal> solver(sums.H);
      if (solver.info() != Eigen::Success) return false;
      ShadowUnknowns change = solver.solve(sums.g);
      const double most = kLongestStep * (x.head<2>() - x.segment<2>(kFootX)).norm();
      const double move = change.head<2>().norm();
      if (move > most) change *= most / move;
      const double softness_m = x[kSoftness];
      x += change;
      x[kSoftness] = std::clamp(x[kSoftness], std::max(softness_m / kMostChange, softness_per_radius_ * kLeastRadius_m),
                                std::min(softness_m * kMostChange, softness_per_radius_ * kMostRadius_m));
      if (x[kDark] < 1.0) return false;
    }
    moved_m = (x.head<2>() - choice.tip_shadow).norm();
  }
  return true;
}

// Where the bright side of the edges is clipped, a brighter board with softer edges looks nearly alike.
double ShadowFit::softness_left_open_m(const ShadowUnknowns& x) const {
  const double share = std::min(1.0, samples_.clipped_count / (kHalfClipped * samples_.count));
  return kEdgeShare * share * std::max(x[kSoftness], softness_per_radius_ * parameters_.lamp_radius_m);
}

// Both lines then lie further out or in, and the tip, where they meet, moves along the shadow, the more the narrower it is.
Eigen::Matrix2d ShadowFit::tip_left_open(const ShadowUnknowns& x) const {
  const Vector2d along = x.head<2>() - x.segment<2>(kFootX);
  const Vector2d tip_moves = softness_left_open_m(x) / x[kRadius] * along;
  return tip_moves * tip_moves.transpose();
}

double ShadowFit::seen_contrast(const ShadowUnknowns& x, const ShadowStart& start) const {
  return samples_.clipped_count == 0 ? x[kDark] : x[kDark] - std::max(0.0, x[kLevel] - start.seen_level);
}

bool ShadowFit::may_be_shadow(const ShadowUnknowns& x, double seen_contrast) const {
  const double distance = (x.head<2>() - probe_.foot_B).norm();
  const double flat = (x.head<2>() - probe_.p_BA.head<2>()).norm();
  return distance >= 1.15 * probe_.radius_m &&
         flat <= probe_.p_BA.z() * std::tan(parameters_.max_angle_deg * kRadPerDeg) &&
         seen_contrast >= parameters_.min_contrast && seen_contrast >= parameters_.min_contrast_ratio * x[kLevel];
}

// How bright a clipped board is only its prior says: there the contrast counts at the level that was found.
bool ShadowFit::is_dark(double seen_contrast, const ShadowNormal& covariance) const {
  double variance = covariance(kDark, kDark);
  if (samples_.clipped_count > 0) {
    const double shared = covariance(kDark, kLevel);
    variance -= shared * shared / covariance(kLevel, kLevel);
  }
  return seen_contrast >= kMinDarkSigmas * std::sqrt(variance);
}

// Do the places along the lines show it, each by itself?
bool ShadowFit::is_shown(const ShadowUnknowns& x, ProbeShadow& shadow) const {
  // Of each place: the line through what is missing over what is hidden.
  struct Place {
    float n = 0.0F, h = 0.0F, hh = 0.0F, v = 0.0F, hv = 0.0F;
  };
  std::array<Place, kMostPlaces> places{};
  const ShadowBrightness model(x, edges_, step_);
  for (std::size_t i = 0; i < static_cast<std::size_t>(samples_.count); ++i) {
    const auto brightness = model.at({samples_.x[i], samples_.y[i]});
    const float expected = brightness.plain - static_cast<float>(x[kDark]) * brightness.hidden;
    // A lower bound that holds agrees; what the place shows is up to its other samples.
    const bool agrees = samples_.clipped[i] != 0.0F && samples_.value[i] < expected;
    const float missing = brightness.plain - (agrees ? expected : samples_.value[i]);
    Place& place = places[static_cast<std::size_t>(samples_.place[i])];
    place.n += 1.0F;
    place.h += brightness.hidden;
    place.hh += brightness.hidden * brightness.hidden;
    place.v += missing;
    place.hv += brightness.hidden * missing;
  }
  std::array<int, 2> shown{};
  std::array<int, 2> asked{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& place = places[i];
    if (place.n == 0.0F) continue;
    const float spread = place.hh - place.h * place.h / place.n;
    if (spread < 0.25F) continue;
    const double contrast = static_cast<double>((place.hv - place.h * place.v / place.n) / spread);
    ++asked[side_of_[i]];
    if (contrast > 0.5 * shadow.contrast && contrast < 1.6 * shadow.contrast) ++shown[side_of_[i]];
  }
  shadow.lines = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const bool enough = asked[side] >= 3 && shown[side] >= parameters_.min_support * asked[side];
    if (asked[side] >= 3 && !enough) return false;
    shadow.line_seen[side] = enough;
    shadow.lines += enough ? 1 : 0;
  }
  shadow.support = static_cast<double>(shown[0] + shown[1]) / std::max(1, asked[0] + asked[1]);
  return shadow.lines > 0 && shadow.rms <= std::max(4.0, 0.35 * shadow.seen_contrast);
}

bool ShadowFit::fit(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
                    const ShadowStart& start, ProbeShadow& shadow) {
  const bool with_tip = start.known_m > 0.0;
  const double radius_m = start.lamp_radius_m > 0.0 ? start.lamp_radius_m : parameters_.lamp_radius_m;
  Fitted fitted;
  fitted.x << start.tip_shadow, probe_.foot_B, probe_.radius_m, start.contrast, start.level, 0.0, 0.0,
      softness_per_radius_ * std::clamp(radius_m, kLeastRadius_m, kMostRadius_m);
  if (!settle(image, view, behind, start, fitted)) return false;
  const ShadowUnknowns& x = fitted.x;
  shadow.seen_contrast = seen_contrast(x, start);
  if (!may_be_shadow(x, shadow.seen_contrast)) return false;
  const ShadowNormal covariance = fitted.information.inverse();
  if (!with_tip && !is_dark(shadow.seen_contrast, covariance)) return false;
  const Vector3d p_BS(x[kTipX], x[kTipY], 0.0);
  const auto d = view.derivative(p_BS);
  if (!d.in_front) return false;
  shadow.contrast = x[kDark];
  shadow.level = x[kLevel];
  shadow.rms = std::sqrt(fitted.variance);
  shadow.p_BS = x.head<2>();
  const double inflation = 1.0 + kClippedVariance * samples_.clipped_count / samples_.count;
  shadow.covariance = inflation * covariance.topLeftCorner<2, 2>() + tip_left_open(x);
  shadow.lamp_radius_m = x[kSoftness] / softness_per_radius_;
  shadow.lamp_radius_sigma_m =
      std::hypot(std::sqrt(inflation * covariance(kSoftness, kSoftness)), softness_left_open_m(x)) /
      softness_per_radius_;
  shadow.J_pose = -d.J_point.leftCols<2>().inverse() * view.pose_jacobian(d, p_BS);
  if (!with_tip) return is_shown(x, shadow);
  shadow.lines = 2;
  shadow.support = 1.0;
  return shadow.rms < std::max(1.8, 0.1 * shadow.seen_contrast) &&
         (shadow.p_BS - start.tip_shadow).norm() < 3.0 * start.known_m;
}

}  // namespace cgsr::illumination
