#include "pipeline/illumination/cone_strip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "pipeline/illumination/lane_sums.h"

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBlur_px = 0.45;        // of lens, pixel and reading between pixels
constexpr double kStep_m = 0.0025;       // between places along the outline
constexpr double kFrom_px = -2.5;        // across: from within the cone
constexpr double kAcrossStep_px = 0.75;  // outwards
constexpr double kEdgeSigma_m = 0.001;   // of the outline's place against the registered one
constexpr double kCorrelation = 1.6;     // samples read between pixels are not independent
constexpr float kScale = 3.0F;           // grey levels, of a sample that is believed
constexpr double kLeastVariance = 0.5;   // grey levels squared
constexpr double kLeastGain = 16.0;      // chi-square that the shadow explains
constexpr int kLeastBeyond = 3;          // places without shadow behind the tip
constexpr int kLeastSamples = 150;
constexpr double kModelSigma_m = 0.0006;   // of a tip, by what a penumbra is like beside a cone
constexpr double kMostSigma_m = 0.004;     // of a tip that is called found
constexpr double kFurthestOut_m = 0.0125;  // where samples end
constexpr double kSteepest = 0.5;          // of the way along: a shadow that turns away further shows both its lines,
constexpr double kShort_m = 0.006;         // unless it is as short as this
constexpr double kFurthestIn_m = 0.003;
constexpr int kIterations = 5;      // with every second sample
constexpr int kLastIterations = 2;  // with all
constexpr std::array kNear_px{1.0, 1.7, 2.4};
constexpr std::array kFar_px{9.0, 11.0, 13.0};
constexpr float kLeastFall = 1.4F;  // grey levels, mean
constexpr std::array kTrialAlong_m{-0.002, 0.002, 0.006};
constexpr std::array kTrialOut_m{-0.0015, 0.0005, 0.0025, 0.005, 0.009};

enum Unknown : std::uint8_t {
  kTipAlong,
  kTipOut,
  kDark,
  kLevel,
  kSlopeAlong,
  kSlopeOut,
  kCone,
  kConeSlope,
  kEdge,
  kEdgeSlope
};

}  // namespace

ConeStrip::ConeStrip(const Board& board, int probe, const ShadowParameters& parameters, double lamp_height_m)
    : board_(board),
      probe_(board.probe[static_cast<std::size_t>(probe)]),
      index_(probe),
      parameters_(parameters),
      lamp_height_m_(lamp_height_m) {}

bool ConeStrip::seen(const Vector2d& p_B, const std::array<Outline, kMostProbes>& behind) const {
  if (!is_on_board(board_, p_B)) return false;
  for (int i = 0; i < board_.probes; ++i) {
    if (i == index_) continue;
    const Probe& other = board_.probe[static_cast<std::size_t>(i)];
    if (within(behind[static_cast<std::size_t>(i)], other.foot_B, other.radius_m, p_B, 0.002)) return false;
  }
  return true;
}

// A quick look: is a stretch of board beside the outline darker than further away, and another stretch not?
bool ConeStrip::may_be(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
                       const Frame& frame) const {
  std::array<float, kPlaces> darker;
  int count = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double along = (i + 1) * kStep_m;
    const auto value_at = [&](double out_px, float& value) {
      const Vector2d p_B = frame.origin + along * frame.along + out_px / frame.px_per_m * frame.outward;
      const auto pixel = view.pixel({p_B.x(), p_B.y(), 0.0});
      if (!seen(p_B, behind) || !pixel.in_front || !image.holds(pixel.at.x(), pixel.at.y(), 1.0)) return false;
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
    if (before / kBefore - after / kAfter > kLeastFall) return true;
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
      if (!image.holds(pixel.x(), pixel.y(), 1.0) || !seen(p_B, behind)) continue;
      Sample& sample = samples_[static_cast<std::size_t>(count++)];
      sample.at = {static_cast<float>(along), static_cast<float>(out)};
      sample.value = image.at(pixel.x(), pixel.y());
      sample.place = i;
    }
  }
  return count;
}

float ConeStrip::hidden(const Eigen::Vector2f& from_foot, const Outline& outline, float over_length,
                        float blur_m) const {
  const auto soft_end = static_cast<float>(0.5 * parameters_.lamp_radius_m * probe_.p_BA.z() /
                                           std::max(0.1, lamp_height_m_ - probe_.p_BA.z()));
  float share = -1.0F;
  for (std::size_t side = 0; side < 2; ++side) {
    const Eigen::Vector2f inward = outline.inward[side].cast<float>();
    const float d = from_foot.dot(inward) + static_cast<float>(probe_.radius_m);
    const Eigen::Vector2f along =
        side == 0 ? Eigen::Vector2f(-inward.y(), inward.x()) : Eigen::Vector2f(inward.y(), -inward.x());
    const float way = std::clamp(std::abs(from_foot.dot(along)) * over_length, 0.0F, 1.0F);
    const float soft = soft_end * way;
    share += step_.at(d / std::sqrt(soft * soft + blur_m * blur_m)).share;
  }
  return std::max(0.0F, share);
}

ConeStrip::Sums ConeStrip::sum_up(const Unknowns& x, int count, bool with_shadow, bool darker_counts, int every) const {
  Sums sums;
  const auto radius = static_cast<float>(probe_.radius_m);
  const auto soft_end = static_cast<float>(0.5 * parameters_.lamp_radius_m * probe_.p_BA.z() /
                                           std::max(0.1, lamp_height_m_ - probe_.p_BA.z()));
  const Vector2d foot(0.0, -probe_.radius_m);
  const Vector2d tip(x[kTipAlong], x[kTipOut]);
  const Outline outline = outline_of(foot, probe_.radius_m, tip);
  const bool shadow = with_shadow && outline.valid;
  std::array<Eigen::Vector2f, 2> inward;
  std::array<Eigen::Vector2f, 2> line;
  std::array<float, 2> over_length{};
  for (std::size_t side = 0; side < 2 && shadow; ++side) {
    const Vector2d to_tip = tip - outline.touch[side];
    const double length = to_tip.norm();
    inward[side] = outline.inward[side].cast<float>();
    line[side] = (to_tip / length).cast<float>();
    over_length[side] = static_cast<float>(1.0 / length);
  }
  const Eigen::Matrix<float, kUnknowns, 1> f = x.cast<float>();
  const auto end = static_cast<float>(kPlaces * kStep_m);
  LaneSums<kUnknowns> table;
  LaneSums<kUnknowns>::Row j;
  for (int i = 0; i < count; i += kLane * every) {
    Lane along;
    Lane out;
    Lane value;
    Lane there;  // the last ones are not
    for (int k = 0; k < kLane; ++k) {
      const int at = i + k * every;
      const Sample& sample = samples_[static_cast<std::size_t>(std::min(at, count - 1))];
      along[k] = sample.at.x();
      out[k] = sample.at.y();
      value[k] = sample.value;
      there[k] = at < count ? 1.0F : 0.0F;
    }
    Lane w;
    Lane edge_density;
    step_.at((out - f[kEdge] - f[kEdgeSlope] * along / end) / blur_m_, w, edge_density);
    Lane dark_share = Lane::Zero();
    Lane J_tip_x = Lane::Zero();
    Lane J_tip_y = Lane::Zero();
    if (shadow) {
      // The outline's place is the cone's own: where its edge is seen, its base is.
      const Lane q = out - f[kEdge] + radius;
      dark_share = Lane::Constant(-1.0F);
      for (std::size_t side = 0; side < 2; ++side) {
        const Lane d = along * inward[side].x() + q * inward[side].y() + radius;
        const Lane way = ((along * line[side].x() + q * line[side].y()) * over_length[side]).max(0.0F).min(1.0F);
        const Lane soft = soft_end * way;
        const Lane over_sigma = 1.0F / (soft * soft + blur_m_ * blur_m_).sqrt();
        Lane share;
        Lane density;
        step_.at(d * over_sigma, share, density);
        dark_share += share;
        const Lane J_tip = f[kDark] * density * over_sigma * way;
        J_tip_x += J_tip * inward[side].x();
        J_tip_y += J_tip * inward[side].y();
      }
      const auto lit = dark_share <= 0.0F;
      J_tip_x = lit.select(0.0F, J_tip_x);
      J_tip_y = lit.select(0.0F, J_tip_y);
      dark_share = dark_share.max(0.0F);
    }
    const Lane board = f[kLevel] + f[kSlopeAlong] * along + f[kSlopeOut] * out - f[kDark] * dark_share;
    const Lane cone = f[kCone] + f[kConeSlope] * along;
    j[kTipAlong] = w * J_tip_x;
    j[kTipOut] = w * J_tip_y;
    j[kDark] = -w * dark_share;
    j[kLevel] = w;
    j[kSlopeAlong] = w * along;
    j[kSlopeOut] = w * out;
    j[kCone] = 1.0F - w;
    j[kConeSlope] = (1.0F - w) * along;
    j[kEdge] = -(board - cone) * edge_density / blur_m_;
    j[kEdgeSlope] = j[kEdge] * along / end;
    const Lane residual = value - (cone + (board - cone) * w);
    j[LaneSums<kUnknowns>::kResidual] = residual;
    const Lane scale = (residual < 0.0F).select(Lane::Constant(kScale), darker_counts ? kScale : 2.0F * kScale);
    const Lane relative = residual / scale;
    table.add(j, there / (1.0F + relative * relative));
  }
  table.put_into(sums);
  return sums;
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

// Where the tip may be, out of what the outline alone does not explain.
bool ConeStrip::start_from(Unknowns& x, int count) const {
  std::array<float, kPlaces> missing{};
  const auto end = static_cast<float>(kPlaces * kStep_m);
  const Eigen::Matrix<float, kUnknowns, 1> f = x.cast<float>();
  std::array<float, static_cast<std::size_t>(kPlaces) * kAcross> residual;
  for (int i = 0; i < count; ++i) {
    const Sample& sample = samples_[static_cast<std::size_t>(i)];
    const float along = sample.at.x();
    const float out = sample.at.y();
    const float w = step_.at((out - f[kEdge] - f[kEdgeSlope] * along / end) / blur_m_).share;
    const float board = f[kLevel] + f[kSlopeAlong] * along + f[kSlopeOut] * out;
    const float cone = f[kCone] + f[kConeSlope] * along;
    const float r = cone + (board - cone) * w - sample.value;
    residual[static_cast<std::size_t>(i)] = r;
    if (w > 0.3F) missing[static_cast<std::size_t>(sample.place)] += r;
  }
  const Ends ends = ends_of(missing);
  const std::size_t tried = ends.fall[1] < 0.5F * ends.fall[0] ? 1 : 2;
  const Vector2d foot(0.0, -probe_.radius_m);
  const Unknowns from = x;
  float best = 0.0F;
  for (std::size_t trial = 0; trial < tried * kTrialAlong_m.size() * kTrialOut_m.size(); ++trial) {
    const std::size_t place = ends.place[trial / (kTrialAlong_m.size() * kTrialOut_m.size())];
    const Vector2d tip((static_cast<double>(place) + 0.5) * kStep_m + kTrialAlong_m[trial % kTrialAlong_m.size()],
                       kTrialOut_m[trial % kTrialOut_m.size()]);
    const Outline outline = outline_of(foot, probe_.radius_m, tip);
    if (!outline.valid) continue;
    const auto over_length = static_cast<float>(1.0 / (tip - outline.touch[0]).norm());
    float hh = 0.0F;
    float hr = 0.0F;
    for (int i = 0; i < count; i += 2) {
      const Sample& sample = samples_[static_cast<std::size_t>(i)];
      if (sample.at.y() < f[kEdge]) continue;
      const Eigen::Vector2f q(sample.at.x(), sample.at.y() - f[kEdge] + static_cast<float>(probe_.radius_m));
      const float h = hidden(q, outline, over_length, blur_m_);
      hh += h * h;
      hr += h * residual[static_cast<std::size_t>(i)];
    }
    if (hh < 1.0F || hr <= 0.0F || hr * hr <= best * hh) continue;
    best = hr * hr / hh;
    x = from;
    x[kTipAlong] = tip.x();
    x[kTipOut] = tip.y();
    x[kDark] = static_cast<double>(hr / hh);
  }
  return static_cast<double>(best) > 0.25 * kLeastGain;
}

// Do the places along the outline show it, each by itself, from the base to the tip?
bool ConeStrip::is_shown(const Unknowns& x, int count) const {
  std::array<float, kPlaces> hh{};
  std::array<float, kPlaces> hr{};
  const auto end = static_cast<float>(kPlaces * kStep_m);
  const Eigen::Matrix<float, kUnknowns, 1> f = x.cast<float>();
  const Vector2d foot(0.0, -probe_.radius_m);
  const Vector2d tip(x[kTipAlong], x[kTipOut]);
  const Outline outline = outline_of(foot, probe_.radius_m, tip);
  if (!outline.valid) return false;
  const auto over_length = static_cast<float>(1.0 / (tip - outline.touch[0]).norm());
  for (int i = 0; i < count; ++i) {
    const Sample& sample = samples_[static_cast<std::size_t>(i)];
    const float along = sample.at.x();
    const float out = sample.at.y();
    const float w = step_.at((out - f[kEdge] - f[kEdgeSlope] * along / end) / blur_m_).share;
    const float board = f[kLevel] + f[kSlopeAlong] * along + f[kSlopeOut] * out;
    const float cone = f[kCone] + f[kConeSlope] * along;
    const Eigen::Vector2f q(along, out - f[kEdge] + static_cast<float>(probe_.radius_m));
    const float h = w * hidden(q, outline, over_length, blur_m_);
    hh[static_cast<std::size_t>(sample.place)] += h * h;
    hr[static_cast<std::size_t>(sample.place)] += h * (cone + (board - cone) * w - sample.value);
  }
  int asked = 0;
  int shown = 0;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    // Where little is seen of it noise says nothing: three standard deviations of the place's own contrast.
    if (static_cast<double>(hh[i]) < 20.0 * kLeastVariance / (x[kDark] * x[kDark])) continue;
    const double contrast = static_cast<double>(hr[i] / hh[i]);
    ++asked;
    if (contrast > 0.4 * x[kDark] && contrast < 1.7 * x[kDark]) ++shown;
  }
  return asked >= 3 && shown >= parameters_.min_support * asked;
}

bool ConeStrip::fit_side(const LumaView& image, const BoardView& view, const std::array<Outline, kMostProbes>& behind,
                         std::size_t side, ProbeShadow& shadow, double& gain) {
  const Outline& outline = behind[static_cast<std::size_t>(index_)];
  const Vector2d hidden_tip = cast(view.p_BC(), probe_.p_BA);
  Frame frame;
  frame.origin = outline.touch[side];
  frame.along = (hidden_tip - outline.touch[side]).normalized();
  frame.outward = -outline.inward[side];
  const Vector2d middle = frame.origin + 0.03 * frame.along;
  const auto d = view.derivative({middle.x(), middle.y(), 0.0});
  if (!d.in_front) return false;
  const Vector2d along_px = (d.J_point.leftCols<2>() * frame.along).normalized();
  const Vector2d across_px = d.J_point.leftCols<2>() * frame.outward;
  frame.px_per_m = std::abs(along_px.x() * across_px.y() - along_px.y() * across_px.x());
  if (frame.px_per_m < 50.0) return false;
  blur_m_ = static_cast<float>(kBlur_px / frame.px_per_m);
  if (!may_be(image, view, behind, frame)) return false;
  const int count = choose_samples(image, view, behind, frame);
  if (count < kLeastSamples) return false;

  Unknowns prior_weight = Unknowns::Constant(1e-9);
  prior_weight[kTipAlong] = prior_weight[kTipOut] = 1.0 / (0.05 * 0.05);
  prior_weight[kSlopeAlong] = prior_weight[kSlopeOut] = prior_weight[kConeSlope] = 1.0 / (100.0 * 100.0);
  prior_weight[kEdge] = prior_weight[kEdgeSlope] = 1.0 / (kEdgeSigma_m * kEdgeSigma_m);
  float cone = 0.0F;
  float board = 0.0F;
  int cones = 0;
  int boards = 0;
  for (int i = 0; i < count; ++i) {
    const Sample& sample = samples_[static_cast<std::size_t>(i)];
    const float out_px = sample.at.y() * static_cast<float>(frame.px_per_m);
    if (out_px < -1.5F) cone += sample.value, ++cones;
    if (out_px > 6.0F) board += sample.value, ++boards;
  }
  if (cones < 10 || boards < 10) return false;
  Unknowns x = Unknowns::Zero();
  x[kCone] = static_cast<double>(cone) / cones;
  x[kLevel] = static_cast<double>(board) / boards;
  x[kTipAlong] = 2.0 * probe_.radius_m;
  const auto solve = [&](bool with_shadow, bool darker_counts, int every, int iterations, Sums& sums, double& variance,
                         Normal& H) {
    const Unknowns centre = x;
    for (int iteration = 0; iteration < iterations; ++iteration) {
      sums = sum_up(x, count, with_shadow, darker_counts, every);
      variance = std::max(kLeastVariance, sums.squares / std::max(1.0, sums.weights - kUnknowns));
      H = sums.H / (variance * kCorrelation);
      Unknowns g = sums.g / (variance * kCorrelation);
      for (int k = 0; k < kUnknowns; ++k) {
        H(k, k) += prior_weight[k];
        const double mean = k == kTipAlong || k == kTipOut ? centre[k] : 0.0;
        if (k != kCone && k != kLevel && k != kDark) g[k] += prior_weight[k] * (mean - x[k]);
      }
      const Eigen::LLT<Normal> solver(H);
      if (solver.info() != Eigen::Success) return false;
      Unknowns change = solver.solve(g);
      if (!change.allFinite()) return false;
      const double move = change.head<2>().norm();
      if (move > 0.004) change *= 0.004 / move;
      x += change;
    }
    return true;
  };
  Sums sums;
  double variance = 1.0;
  Normal H;
  // First without a shadow, what is darker than that counting less.
  if (!solve(false, false, 2, 3, sums, variance, H)) return false;
  if (!start_from(x, count)) return false;
  if (!solve(true, true, 2, kIterations, sums, variance, H)) return false;
  if (!solve(true, true, 1, kLastIterations, sums, variance, H)) return false;
  const double explained = sums.squares;
  Unknowns without = x;
  without[kDark] = 0.0;
  {
    // The same without a shadow, by the same measure.
    const Unknowns kept = x;
    x = without;
    Sums plain;
    double plain_variance = 1.0;
    Normal plain_H;
    if (!solve(false, true, 1, 2, plain, plain_variance, plain_H)) return false;
    gain = (plain.squares - explained) / (variance * kCorrelation);
    x = kept;
  }
  if (gain < kLeastGain) return false;
  const double tip_along = x[kTipAlong];
  const double tip_out = x[kTipOut];
  const double reach = samples_[static_cast<std::size_t>(count - 1)].place * kStep_m;
  if (tip_along > reach - kLeastBeyond * kStep_m || tip_out < -kFurthestIn_m) return false;
  if (tip_out > std::min(kFurthestOut_m, std::max(kShort_m, kSteepest * tip_along))) return false;
  const double dark = x[kDark];
  if (dark < parameters_.min_contrast || dark < parameters_.min_contrast_ratio * x[kLevel] || dark > 0.9 * x[kLevel])
    return false;
  shadow.rms = std::sqrt(variance);
  if (shadow.rms > std::max(1.8, 0.1 * dark)) return false;
  if (!is_shown(x, count)) return false;
  const Normal covariance = H.inverse();
  if (dark < 2.5 * std::sqrt(covariance(kDark, kDark))) return false;
  Eigen::Matrix2d R;
  R.col(0) = frame.along;
  R.col(1) = frame.outward;
  shadow.p_BS = frame.origin + R * (x.head<2>() + Vector2d(0.0, x[kEdge]));
  shadow.covariance = R * covariance.topLeftCorner<2, 2>() * R.transpose();
  shadow.covariance.diagonal().array() += kModelSigma_m * kModelSigma_m + board_.place_sigma_m * board_.place_sigma_m;
  if (std::sqrt(shadow.covariance.trace()) > kMostSigma_m) return false;
  const double distance = (shadow.p_BS - probe_.foot_B).norm();
  const double flat = (shadow.p_BS - probe_.p_BA.head<2>()).norm();
  if (distance < 1.15 * probe_.radius_m) return false;
  if (flat > probe_.p_BA.z() * std::tan(parameters_.max_angle_deg * std::numbers::pi / 180.0)) return false;
  const Vector3d p_BS(shadow.p_BS.x(), shadow.p_BS.y(), 0.0);
  const auto at = view.derivative(p_BS);
  if (!at.in_front) return false;
  shadow.J_pose = -at.J_point.leftCols<2>().inverse() * view.pose_jacobian(at, p_BS);
  shadow.contrast = dark;
  shadow.support = 1.0;
  shadow.lines = 2;
  shadow.line_seen = {side == 0, side == 1};
  return true;
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
