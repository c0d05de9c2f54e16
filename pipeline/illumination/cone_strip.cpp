#include "pipeline/illumination/cone_strip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBlur_px = 0.45;  // of lens, pixel and reading between pixels
constexpr double kStep_m = StripModel::kStep_m;
constexpr double kFrom_px = -2.5;        // across: from within the cone
constexpr double kAcrossStep_px = 0.75;  // outwards
constexpr double kEdgeSigma_m = 0.001;   // of the outline's place against the registered one
constexpr double kCorrelation = 1.6;     // samples read between pixels are not independent
constexpr double kMinVariance = 0.5;     // grey levels squared
constexpr double kMinGain = 16.0;        // chi-square that the shadow explains
constexpr int kMinPlacesBeyond = 3;      // places without shadow behind the tip
constexpr int kMinSamples = 150;
constexpr double kModelSigma_m = 0.0006;  // of a tip, by what a penumbra is like beside a cone
constexpr double kModelShare = 0.4;       // likewise, of the penumbra at the tip
constexpr double kMaxSigma_m = 0.004;     // of a tip that counts as found
constexpr double kMaxOut_m = 0.0125;      // where samples end
constexpr double kMaxSlope = 0.5;         // of the way along: a shadow that turns away further shows both its lines,
constexpr double kShort_m = 0.006;        // unless it is as short as this
constexpr double kMaxIn_m = 0.003;
constexpr double kMaxMove_m = 0.004;  // of the tip in one iteration
constexpr double kLeastRadius_m = 0.005;
constexpr double kMostRadius_m = 0.4;
constexpr double kHeld = 1e4;       // of a weight: the softness stays
constexpr double kMaxChange = 2.0;  // a factor of the softness in one iteration
constexpr std::array kNear_px{1.0, 1.7, 2.4};
constexpr std::array kFar_px{9.0, 11.0, 13.0};
constexpr float kMinFall = 1.4F;  // grey levels, mean
constexpr std::array kTrialAlong_m{-0.002, 0.002, 0.006};
constexpr std::array kTrialOut_m{-0.0015, 0.0005, 0.0025, 0.005, 0.009};

// First without a shadow, what is darker than that counting less; then with it, and the same without it by the same measure.
constexpr StripModel::Pass kOutlineOnly{.with_shadow = false, .darker_counts = false, .every = 2, .iterations = 3};
constexpr StripModel::Pass kCoarse{.with_shadow = true, .darker_counts = true, .every = 2, .iterations = 5};
constexpr StripModel::Pass kFine{.with_shadow = true, .darker_counts = true, .every = 1, .iterations = 2};
constexpr StripModel::Pass kShadowRemoved{.with_shadow = false, .darker_counts = true, .every = 1, .iterations = 2};

StripModel::Unknowns prior_weights(double softness_sigma_m) {
  StripModel::Unknowns weight = StripModel::Unknowns::Constant(1e-9);
  weight[kTipAlong] = weight[kTipOut] = 1.0 / (0.05 * 0.05);
  weight[kSlopeAlong] = weight[kSlopeOut] = weight[kConeSlope] = 1.0 / (100.0 * 100.0);
  weight[kEdge] = weight[kEdgeSlope] = 1.0 / (kEdgeSigma_m * kEdgeSigma_m);
  weight[kSoftEnd] = 1.0 / (softness_sigma_m * softness_sigma_m);
  return weight;
}

}  // namespace

ConeStrip::ConeStrip(const Board& board, int probe, const ShadowParameters& parameters, double lamp_height_m)
    : board_(board),
      probe_(board.probe[static_cast<std::size_t>(probe)]),
      index_(probe),
      parameters_(parameters),
      model_(probe_),
      softness_per_radius_(softness_per_radius(probe_.p_BA.z(), lamp_height_m)),
      prior_weight_(prior_weights(softness_per_radius_ * parameters.lamp_radius_sigma_m)) {}

bool ConeStrip::is_seen(const Vector2d& p_B, const std::array<Outline, kMostProbes>& behind) const {
  if (!is_on_board(board_, p_B)) return false;
  for (int i = 0; i < board_.probes; ++i) {
    if (i == index_) continue;
    const Probe& other = board_.probe[static_cast<std::size_t>(i)];
    if (within(behind[static_cast<std::size_t>(i)], other.foot_B, other.radius_m, p_B, 0.002)) return false;
  }
  return true;
}

// A quick test: is a stretch of board beside the outline darker than further away, and another stretch not?
bool ConeStrip::may_be(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
                       const Frame& frame) const {
  std::array<float, kPlaces> darker;
  int count = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double along = (i + 1) * kStep_m;
    const auto value_at = [&](double out_px, float& value) {
      const Vector2d p_B = frame.origin + along * frame.along + out_px / frame.px_per_m * frame.outward;
      const auto pixel = view.pixel({p_B.x(), p_B.y(), 0.0});
      if (!is_seen(p_B, behind) || !pixel.in_front || !image.holds(pixel.at.x(), pixel.at.y(), 1.0)) return false;
      value = image.at(pixel.at.x(), pixel.at.y());
      return true;
    };
    float sum = 0.0F;
    bool all = true;
    for (std::size_t k = 0; k < kNear_px.size() && all; ++k) {
      float near = 0.0F;
      float far = 0.0F;
      all = value_at(kNear_px[k], near) && value_at(kFar_px[k], far);
      sum += far - near;
    }
    if (all) darker[static_cast<std::size_t>(count++)] = sum / static_cast<float>(kNear_px.size());
  }
  // Where a strip ends, what is missing falls.
  constexpr int kBefore = 7;
  constexpr int kAfter = 5;
  for (int i = kBefore; i + kAfter <= count; ++i) {
    float before = 0.0F;
    float after = 0.0F;
    for (int k = 0; k < kBefore; ++k) before += darker[static_cast<std::size_t>(i - 1 - k)];
    for (int k = 0; k < kAfter; ++k) after += darker[static_cast<std::size_t>(i + k)];
    if (before / kBefore - after / kAfter > kMinFall) return true;
  }
  return false;
}

int ConeStrip::choose_samples(const LumaView& image, const BoardView& view,
                              const std::array<Outline, kMostProbes>& behind, const Frame& frame) {
  int count = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double along = (i + 1) * kStep_m;
    const Vector2d centre = frame.origin + along * frame.along;
    const auto d = view.derivative({centre.x(), centre.y(), 0.0});
    if (!d.in_front) continue;
    const Vector2d across = d.J_point.leftCols<2>() * frame.outward;
    for (int k = 0; k < kAcross; ++k) {
      // The last ones further apart: how bright the board is.
      const double out_px = kFrom_px + kAcrossStep_px * (k < kAcross - 3 ? k : k + 3 * (k - kAcross + 4));
      const double out = out_px / frame.px_per_m;
      const Vector2d p_B = centre + out * frame.outward;
      const Vector2d pixel = d.at + out * across;
      if (!image.holds(pixel.x(), pixel.y(), 1.0) || !is_seen(p_B, behind)) continue;
      StripSample& sample = samples_[static_cast<std::size_t>(count++)];
      sample.at = {static_cast<float>(along), static_cast<float>(out)};
      sample.value = image.at(pixel.x(), pixel.y());
      sample.place = i;
    }
  }
  return count;
}

// Where a strip may end, at most two places: what is missing falls from one place to the next ones.
ConeStrip::Ends ConeStrip::ends_of(const std::array<float, kPlaces>& missing) {
  constexpr std::size_t kWindow = 4;
  Ends ends;
  for (std::size_t i = kWindow; i + kWindow <= kPlaces; ++i) {
    float before = 0.0F;
    float after = 0.0F;
    for (std::size_t k = 0; k < kWindow; ++k) {
      before += missing[i - 1 - k];
      after += missing[i + k];
    }
    const float fall = before - std::max(0.0F, after);
    if (fall > ends.fall[0]) {
      if (i > ends.place[0] + kWindow) ends.fall[1] = ends.fall[0], ends.place[1] = ends.place[0];
      ends.fall[0] = fall, ends.place[0] = i;
    } else if (fall > ends.fall[1] && i > ends.place[0] + kWindow) {
      ends.fall[1] = fall, ends.place[1] = i;
    }
  }
  return ends;
}

// Where the tip may be, out of what the outline alone leaves open.
bool ConeStrip::guess_tip(Unknowns& x) const {
  std::array<float, kPlaces> missing{};
  std::array<float, static_cast<std::size_t>(kPlaces) * kAcross> residual;
  for (std::size_t i = 0; i < samples().size(); ++i) {
    const StripSample& sample = samples_[i];
    const auto shadowless = model_.without_shadow(x, sample);
    residual[i] = shadowless.missing;
    if (shadowless.board > 0.3F) missing[static_cast<std::size_t>(sample.place)] += shadowless.missing;
  }
  const Ends ends = ends_of(missing);
  const std::size_t tried = ends.fall[1] < 0.5F * ends.fall[0] ? 1 : 2;
  const Unknowns from = x;
  float best = 0.0F;
  for (std::size_t trial = 0; trial < tried * kTrialAlong_m.size() * kTrialOut_m.size(); ++trial) {
    const std::size_t place = ends.place[trial / (kTrialAlong_m.size() * kTrialOut_m.size())];
    const Vector2d tip((static_cast<double>(place) + 0.5) * kStep_m + kTrialAlong_m[trial % kTrialAlong_m.size()],
                       kTrialOut_m[trial % kTrialOut_m.size()]);
    const auto [hh, hr] = match_shadow(from, tip, residual);
    if (hh < 1.0F || hr <= 0.0F || hr * hr <= best * hh) continue;
    best = hr * hr / hh;
    x = from;
    x[kTipAlong] = tip.x();
    x[kTipOut] = tip.y();
    x[kShadowDepth] = static_cast<double>(hr / hh);
  }
  return static_cast<double>(best) > 0.25 * kMinGain;
}

// How well a shadow with its tip there explains the residuals: sums over every second sample, zero where there is no such shadow.
ConeStrip::ShadowMatch ConeStrip::match_shadow(const Unknowns& from, const Vector2d& tip,
                                               std::span<const float> residual) const {
  ShadowMatch match;
  const Outline outline = model_.shadow_outline(tip);
  if (!outline.valid) return match;
  const auto over_length = static_cast<float>(1.0 / (tip - outline.touch[0]).norm());
  const auto edge = static_cast<float>(from[kEdge]);
  for (std::size_t i = 0; i < samples().size(); i += 2) {
    const StripSample& sample = samples_[i];
    if (sample.at.y() < edge) continue;
    const float h = model_.hidden(from, sample, outline, over_length);
    match.hh += h * h;
    match.hr += h * residual[i];
  }
  return match;
}

// Do the places along the outline show it, each by itself, from the base to the tip?
bool ConeStrip::is_shown(const Unknowns& x) const {
  const Vector2d tip(x[kTipAlong], x[kTipOut]);
  const Outline outline = model_.shadow_outline(tip);
  if (!outline.valid) return false;
  const auto over_length = static_cast<float>(1.0 / (tip - outline.touch[0]).norm());
  std::array<ShadowMatch, kPlaces> match{};
  for (const StripSample& sample : samples()) {
    const auto shadowless = model_.without_shadow(x, sample);
    const float h = shadowless.board * model_.hidden(x, sample, outline, over_length);
    match[static_cast<std::size_t>(sample.place)].hh += h * h;
    match[static_cast<std::size_t>(sample.place)].hr += h * shadowless.missing;
  }
  int examined = 0;
  int shown = 0;
  for (const auto& [hh, hr] : match) {
    // Where little of it is visible noise decides: three standard deviations of the place's own contrast.
    if (static_cast<double>(hh) < 20.0 * kMinVariance / (x[kShadowDepth] * x[kShadowDepth])) continue;
    const double contrast = static_cast<double>(hr / hh);
    ++examined;
    if (contrast > 0.4 * x[kShadowDepth] && contrast < 1.7 * x[kShadowDepth]) ++shown;
  }
  return examined >= 3 && shown >= parameters_.min_support * examined;
}

// The frame of the samples beside one side of the outline; none where the board is seen too small or from behind.
std::optional<ConeStrip::Frame> ConeStrip::frame_beside(const BoardView& view, const Outline& outline,
                                                        std::size_t side) const {
  const Vector2d hidden_tip = cast(view.p_BC(), probe_.p_BA);
  Frame frame;
  frame.origin = outline.touch[side];
  frame.along = (hidden_tip - outline.touch[side]).normalized();
  frame.outward = -outline.inward[side];
  const Vector2d middle = frame.origin + 0.03 * frame.along;
  const auto d = view.derivative({middle.x(), middle.y(), 0.0});
  if (!d.in_front) return std::nullopt;
  const Vector2d along_px = (d.J_point.leftCols<2>() * frame.along).normalized();
  const Vector2d across_px = d.J_point.leftCols<2>() * frame.outward;
  frame.px_per_m = std::abs(along_px.x() * across_px.y() - along_px.y() * across_px.x());
  if (frame.px_per_m < 50.0) return std::nullopt;
  return frame;
}

// The fit begins with the mean brightness on either side of the outline.
std::optional<ConeStrip::Unknowns> ConeStrip::first_guess(const Frame& frame) const {
  float cone = 0.0F;
  float board = 0.0F;
  int cones = 0;
  int boards = 0;
  for (const StripSample& sample : samples()) {
    const float out_px = sample.at.y() * static_cast<float>(frame.px_per_m);
    if (out_px < -1.5F) cone += sample.value, ++cones;
    if (out_px > 6.0F) board += sample.value, ++boards;
  }
  if (cones < 10 || boards < 10) return std::nullopt;
  Unknowns x = Unknowns::Zero();
  x[kCone] = static_cast<double>(cone) / cones;
  x[kBoardLevel] = static_cast<double>(board) / boards;
  x[kTipAlong] = 2.0 * probe_.radius_m;
  x[kSoftEnd] = softness_per_radius_ * std::clamp(parameters_.lamp_radius_m, kLeastRadius_m, kMostRadius_m);
  return x;
}

// Gauss-Newton with a Gaussian prior on all but the brightness of cone, board and shadow. False when the equations have no solution.
bool ConeStrip::solve(Fit& fit, const StripModel::Pass& pass) const {
  Unknowns mean = Unknowns::Zero();
  mean[kTipAlong] = fit.x[kTipAlong];
  mean[kTipOut] = fit.x[kTipOut];
  mean[kSoftEnd] = softness_per_radius_ * parameters_.lamp_radius_m;
  for (int iteration = 0; iteration < pass.iterations; ++iteration) {
    fit.sums = model_.sum_up(fit.x, samples(), pass);
    fit.variance = std::max(kMinVariance, fit.sums.squares / std::max(1.0, fit.sums.weights - StripModel::kUnknowns));
    fit.H = fit.sums.H / (fit.variance * kCorrelation);
    Unknowns g = fit.sums.g / (fit.variance * kCorrelation);
    for (int k = 0; k < StripModel::kUnknowns; ++k) {
      fit.H(k, k) += prior_weight_[k];
      if (k != kCone && k != kBoardLevel && k != kShadowDepth) g[k] += prior_weight_[k] * (mean[k] - fit.x[k]);
    }
    const Eigen::LLT<StripModel::Normal> solver(fit.H);
    if (solver.info() != Eigen::Success) return false;
    Unknowns change = solver.solve(g);
    if (!change.allFinite()) return false;
    const double move = change.head<2>().norm();
    if (move > kMaxMove_m) change *= kMaxMove_m / move;
    const double softness_m = fit.x[kSoftEnd];
    fit.x += change;
    fit.x[kSoftEnd] =
        std::clamp(fit.x[kSoftEnd], std::max(softness_m / kMaxChange, softness_per_radius_ * kLeastRadius_m),
                   std::min(softness_m * kMaxChange, softness_per_radius_ * kMostRadius_m));
  }
  return true;
}

// The chi-square that the shadow explains: what the samples leave over without it, less what they leave over with it.
std::optional<double> ConeStrip::gain_of(const Fit& fit) const {
  Fit without;
  without.x = fit.x;
  without.x[kShadowDepth] = 0.0;
  if (!solve(without, kShadowRemoved)) return std::nullopt;
  return (without.sums.squares - fit.sums.squares) / (fit.variance * kCorrelation);
}

// Is it where a strip's shadow can be, as dark as a shadow is, and sure?
bool ConeStrip::is_plausible(const Fit& fit) const {
  const double tip_along = fit.x[kTipAlong];
  const double tip_out = fit.x[kTipOut];
  const double reach = samples().back().place * kStep_m;
  if (tip_along > reach - kMinPlacesBeyond * kStep_m || tip_out < -kMaxIn_m) return false;
  if (tip_out > std::min(kMaxOut_m, std::max(kShort_m, kMaxSlope * tip_along))) return false;
  const double dark = fit.x[kShadowDepth];
  const double level = fit.x[kBoardLevel];
  if (dark < parameters_.min_contrast || dark < parameters_.min_contrast_ratio * level || dark > 0.9 * level)
    return false;
  if (std::sqrt(fit.variance) > std::max(1.8, 0.1 * dark)) return false;
  return is_shown(fit.x);
}

// The tip's shadow on the board; false when it is not certain enough, or cannot be the shadow of this cone.
bool ConeStrip::place_shadow(const Fit& fit, const Frame& frame, const BoardView& view, ProbeShadow& shadow) const {
  StripModel::Normal covariance = fit.H.inverse();
  if (fit.x[kShadowDepth] < 2.5 * std::sqrt(covariance(kShadowDepth, kShadowDepth))) return false;
  // A softness that was held is no better known for that.
  const double softness_sigma = softness_per_radius_ * parameters_.lamp_radius_sigma_m;
  const double surplus = prior_weight_[kSoftEnd] - 1.0 / (softness_sigma * softness_sigma);
  if (surplus > 0.0) {
    StripModel::Normal H = fit.H;
    H(kSoftEnd, kSoftEnd) -= surplus;
    covariance = H.inverse();
  }
  Eigen::Matrix2d R;
  R.col(0) = frame.along;
  R.col(1) = frame.outward;
  shadow.p_BS = frame.origin + R * (fit.x.head<2>() + Vector2d(0.0, fit.x[kEdge]));
  shadow.covariance = R * covariance.topLeftCorner<2, 2>() * R.transpose();
  const double model_sigma = std::max(kModelSigma_m, kModelShare * fit.x[kSoftEnd]);
  shadow.covariance.diagonal().array() += model_sigma * model_sigma + board_.place_sigma_m * board_.place_sigma_m;
  if (std::sqrt(shadow.covariance.trace()) > kMaxSigma_m) return false;
  const double distance = (shadow.p_BS - probe_.foot_B).norm();
  const double flat = (shadow.p_BS - probe_.p_BA.head<2>()).norm();
  if (distance < 1.15 * probe_.radius_m) return false;
  if (flat > probe_.p_BA.z() * std::tan(parameters_.max_angle_deg * std::numbers::pi / 180.0)) return false;
  const Vector3d p_BS(shadow.p_BS.x(), shadow.p_BS.y(), 0.0);
  const auto at = view.derivative(p_BS);
  if (!at.in_front) return false;
  shadow.J_pose = -at.J_point.leftCols<2>().inverse() * view.pose_jacobian(at, p_BS);
  shadow.rms = std::sqrt(fit.variance);
  shadow.contrast = fit.x[kShadowDepth];
  shadow.support = 1.0;
  shadow.lines = 2;
  shadow.lamp_radius_m = fit.x[kSoftEnd] / softness_per_radius_;
  shadow.lamp_radius_sigma_m = std::sqrt(covariance(kSoftEnd, kSoftEnd)) / softness_per_radius_;
  return true;
}

bool ConeStrip::fit_side(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
                         std::size_t side, ProbeShadow& shadow, double& gain) {
  const auto frame = frame_beside(view, behind[static_cast<std::size_t>(index_)], side);
  if (!frame) return false;
  model_.set_blur(static_cast<float>(kBlur_px / frame->px_per_m));
  if (!may_be(image, view, behind, *frame)) return false;
  sample_count_ = choose_samples(image, view, behind, *frame);
  if (sample_count_ < kMinSamples) return false;
  const auto guess = first_guess(*frame);
  if (!guess) return false;
  Fit start;
  start.x = *guess;
  if (!solve(start, kOutlineOnly) || !guess_tip(start.x)) return false;
  // How soft it is, a weak strip cannot tell: then it is as soft as was expected.
  const double weight = prior_weight_[kSoftEnd];
  bool found = false;
  for (const double held : {1.0, kHeld}) {
    prior_weight_[kSoftEnd] = held * weight;
    Fit fit = start;
    if (!solve(fit, kCoarse) || !solve(fit, kFine)) continue;
    const auto explained = gain_of(fit);
    if (!explained || *explained < kMinGain) continue;
    if (!is_plausible(fit) || !place_shadow(fit, *frame, view, shadow)) continue;
    gain = *explained;
    found = true;
    break;
  }
  prior_weight_[kSoftEnd] = weight;
  shadow.line_seen = {side == 0, side == 1};
  return found;
}

bool ConeStrip::find(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
                     ProbeShadow& shadow) {
  if (!behind[static_cast<std::size_t>(index_)].valid) return false;
  double best = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    ProbeShadow one;
    double gain = 0.0;
    if (!fit_side(image, view, behind, side, one, gain) || gain <= best) continue;
    best = gain;
    shadow = one;
  }
  return best > 0.0;
}

}  // namespace cgsr::illumination
