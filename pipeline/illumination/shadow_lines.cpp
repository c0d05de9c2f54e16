#include "pipeline/illumination/shadow_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr std::array kRingRadii{1.2, 1.4, 1.65, 1.95, 2.35, 2.9, 3.6, 4.5};               // of the base's radius
constexpr std::array kLengthFactors{1.5, 1.8, 2.2, 2.7, 3.3, 4.2, 5.5, 7.5, 11.0, 18.0};  // likewise, from the foot
constexpr double kLeastScore = 60.0;     // grey levels squared that a wedge explains
constexpr double kLeastKnown_m = 0.004;  // of the tip beforehand, by where a single line ends
constexpr double kMostToTip_m = 0.02;    // along a single line, for its end to be looked at
constexpr double kTipFound_m = 0.0025;   // then the tip's shadow must be known to this
constexpr double kSameContrast = 0.75;   // of the line alone
constexpr double kLeastOfFirst = 0.35;   // a second lamp's shadow, of the first one's contrast
constexpr double kLeastFilled = 0.75;    // of the places inside, dark
constexpr std::array kAxisTurns{-0.1, -0.067, -0.033, 0.0, 0.033, 0.067, 0.1};  // rad
constexpr double kLongerThanRings = 3.0;  // of the base's radius: shorter shadows end on the rings
constexpr double kBeside = 1.8;           // of the base's radius, from the axis: out of the shadow
constexpr double kAxisEnd = 1.1;          // the last part of a shadow is soft and narrow
constexpr int kLeastAxisPlaces = 3;
constexpr double kSigmaPerMedian = 1.4826;  // of a normal distribution's absolute values
constexpr double kMostNoise = 1.2;          // in a fit, of the board's own
constexpr double kMostUnlike = 0.07;        // likewise, of the contrast
constexpr double kShapeBlur_m = 0.0015;     // of edges on the rings

// A place along a shadow's axis, from the foot: of the base's radius.
double axis_place(std::size_t i) {
  return 1.3 + 0.85 * static_cast<double>(i);
}

template <class Ring>
float total(const Ring& ring) {
  float sum = 0.0F;
  for (const float value : ring) sum += value;
  return sum;
}

}  // namespace

ShadowFinder::ShadowFinder(const Board& board, int probe, const ShadowParameters& parameters, double lamp_height_m)
    : board_(board),
      probe_(board.probe[static_cast<std::size_t>(probe)]),
      parameters_(parameters),
      fit_(probe_, board, parameters, lamp_height_m) {
  for (int ray = 0; ray < kRays; ++ray) {
    const double angle = 2.0 * kPi * ray / kRays;
    for (int ring = 0; ring < kRings; ++ring) {
      grid_[static_cast<std::size_t>(ray * kRings + ring)] =
          probe_.radius_m * kRingRadii[static_cast<std::size_t>(ring)] * Vector2d(std::cos(angle), std::sin(angle));
    }
  }
  shape_.resize(static_cast<std::size_t>(kLengths) * (2 * kHalfWedge + 1));
  shape_square_.resize(shape_.size());
  for (int length = 0; length < kLengths; ++length) {
    const double distance = probe_.radius_m * kLengthFactors[static_cast<std::size_t>(length)];
    length_m_[static_cast<std::size_t>(length)] = distance;
    const Outline outline = outline_of(Vector2d::Zero(), probe_.radius_m, {distance, 0.0});
    for (int ray = -kHalfWedge; ray <= kHalfWedge; ++ray) {
      const double angle = 2.0 * kPi * ray / kRays;
      const auto k = static_cast<std::size_t>(length * (2 * kHalfWedge + 1) + ray + kHalfWedge);
      for (std::size_t ring = 0; ring < kRings; ++ring) {
        const Vector2d p = probe_.radius_m * kRingRadii[ring] * Vector2d(std::cos(angle), std::sin(angle));
        shape_[k][ring] = hidden_share(p, outline, kShapeBlur_m);
        shape_square_[k][ring] = shape_[k][ring] * shape_[k][ring];
      }
    }
  }
}

float ShadowFinder::hidden_share(const Vector2d& from_foot, const Outline& outline, double blur_m) const {
  if (!outline.valid) return 0.0F;
  // Both lines' inner sides overlap behind the base as well: only from the points on where they begin.
  if (from_foot.dot(outline.backward) > -0.5 * probe_.radius_m * outline.backward.squaredNorm()) return 0.0F;
  float share = -1.0F;
  for (std::size_t side = 0; side < 2; ++side) {
    const double d = from_foot.dot(outline.inward[side]) + probe_.radius_m;
    share += step_.at(static_cast<float>(d / blur_m)).share;
  }
  return std::max(0.0F, share);
}

void ShadowFinder::look_around(const LumaView& image, const BoardView& view) {
  int seen_places = 0;
  int clipped = 0;
  for (int ray = 0; ray < kRays; ++ray) {
    for (int ring = 0; ring < kRings; ++ring) {
      const auto r = static_cast<std::size_t>(ray);
      const auto k = static_cast<std::size_t>(ring);
      value_[r][k] = valid_[r][k] = 0.0F;
      const Vector2d p_B = probe_.foot_B + grid_[static_cast<std::size_t>(ray * kRings + ring)];
      if (!is_seen(board_, behind_, p_B)) continue;
      const auto pixel = view.pixel({p_B.x(), p_B.y(), 0.0});
      if (!pixel.in_front || !image.holds(pixel.at.x(), pixel.at.y(), 1.0)) continue;
      valid_[r][k] = 1.0F;
      value_[r][k] = image.at(pixel.at.x(), pixel.at.y());
      ++seen_places;
      clipped += image.is_clipped(pixel.at.x(), pixel.at.y(), value_[r][k]) ? 1 : 0;
    }
  }
  clipped_share_ = seen_places > 0 ? static_cast<double>(clipped) / seen_places : 0.0;
}

void ShadowFinder::take_plane_away() {
  // The board's brightness is nearly a plane; places darker than it count less and less.
  Vector3d plane(0.0, 0.0, 0.0);
  double soft = 40.0;
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Identity() * 1e-3;
    Vector3d g = Vector3d::Zero();
    for (std::size_t r = 0; r < kRays; r += round + 1 < kRounds ? 2 : 1) {
      for (std::size_t k = 0; k < kRings; ++k) {
        if (valid_[r][k] == 0.0F) continue;
        const Vector2d q = grid_[r * kRings + k] / probe_.radius_m;
        const double value = static_cast<double>(value_[r][k]);
        const double residual = round == 0 ? 0.0 : value - (plane[0] + plane[1] * q.x() + plane[2] * q.y());
        const double relative = residual / (residual < 0.0 ? soft : 3.0 * soft);
        const double w = 1.0 / (1.0 + relative * relative);
        const Vector3d j(1.0, q.x(), q.y());
        H(0, 0) += w;
        H(0, 1) += w * j[1];
        H(0, 2) += w * j[2];
        H(1, 1) += w * j[1] * j[1];
        H(1, 2) += w * j[1] * j[2];
        H(2, 2) += w * j[2] * j[2];
        g += w * value * j;
      }
    }
    H(1, 0) = H(0, 1);
    H(2, 0) = H(0, 2);
    H(2, 1) = H(1, 2);
    H(1, 1) += 20.0;  // few places do not make a slope
    H(2, 2) += 20.0;
    plane = H.ldlt().solve(g);
    soft = round == 0 ? 6.0 : 2.5;
  }
  plane_ = plane;
  for (std::size_t r = 0; r < kRays; ++r) {
    for (std::size_t k = 0; k < kRings; ++k) {
      value_[r][k] -= valid_[r][k] * static_cast<float>(plane_at(grid_[r * kRings + k]));
    }
  }
}

// From place to place along the rings, where neither the board's slope nor most of a shadow counts; the median leaves out what edges are there.
double ShadowFinder::noise() const {
  std::array<float, static_cast<std::size_t>(kRings) * kRays> step;
  std::size_t count = 0;
  for (std::size_t r = 0; r < kRays; ++r) {
    const std::size_t next = (r + 1) % kRays;
    for (std::size_t k = 0; k < kRings; ++k) {
      if (valid_[r][k] != 0.0F && valid_[next][k] != 0.0F) step[count++] = std::abs(value_[next][k] - value_[r][k]);
    }
  }
  if (count == 0) return 0.0;
  const auto middle = step.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(step.begin(), middle, step.begin() + static_cast<std::ptrdiff_t>(count));
  return kSigmaPerMedian / std::numbers::sqrt2 * static_cast<double>(*middle);
}

// A wedge is dark in its middle, near the base: rays that are not need no comparison with wedges.
bool ShadowFinder::may_be_middle(int ray) const {
  float n = 0.0F;
  float v = 0.0F;
  for (int d = -1; d <= 1; ++d) {
    const auto k = static_cast<std::size_t>((ray + d + kRays) % kRays);
    for (std::size_t ring = 0; ring < 2; ++ring) {
      n += valid_[k][ring];
      v += value_[k][ring];
    }
  }
  const float least = -0.25F * static_cast<float>(parameters_.min_contrast);
  if (n >= 3.0F) return v < least * n;
  // The cone hides it: one of its sides, then.
  for (const int way : {-1, 1}) {
    n = v = 0.0F;
    for (int d = 3; d <= 6; ++d) {
      const auto k = static_cast<std::size_t>((ray + way * d + kRays) % kRays);
      for (std::size_t ring = 0; ring < 3; ++ring) {
        n += valid_[k][ring];
        v += value_[k][ring];
      }
    }
    if (n >= 2.0F && v < least * n) return true;
  }
  return false;
}

bool ShadowFinder::is_near_tried(const std::array<int, 4>& tried, int tried_count, int ray) {
  for (int i = 0; i < tried_count; ++i) {
    const int apart = std::abs(tried[static_cast<std::size_t>(i)] - ray);
    if (std::min(apart, kRays - apart) <= 3) return true;
  }
  return false;
}

// Compares the wedges of some lengths with the brightness about a ray, and keeps the one that explains most of it.
void ShadowFinder::compare_wedges(int ray, const Lengths& lengths, Candidate& best) const {
  float n = 0.0F;
  float v = 0.0F;
  for (int d = -kHalfWindow; d <= kHalfWindow; ++d) {
    const auto k = static_cast<std::size_t>((ray + d + kRays) % kRays);
    n += ray_valid_[k];
    v += ray_value_[k];
  }
  if (n < 30.0F) return;
  const float mean = v / n;
  for (int length = lengths.first; length < lengths.end; length += lengths.step) {
    // Lane by lane, so that four rings are one instruction.
    Ring m{};
    Ring mm{};
    Ring mv{};
    for (int d = -kHalfWedge; d <= kHalfWedge; ++d) {
      const auto k = static_cast<std::size_t>((ray + d + kRays) % kRays);
      const auto s = static_cast<std::size_t>(length * (2 * kHalfWedge + 1) + d + kHalfWedge);
      for (std::size_t ring = 0; ring < kRings; ++ring) {
        m[ring] += shape_[s][ring] * valid_[k][ring];
        mm[ring] += shape_square_[s][ring] * valid_[k][ring];
        mv[ring] += shape_[s][ring] * value_[k][ring];
      }
    }
    const float sum = total(m);
    const float variance = total(mm) - sum * sum / n;
    if (sum < 1.5F || variance < 0.8F) continue;
    const float covariance = total(mv) - sum * mean;
    if (covariance >= 0.0F) continue;  // a shadow is dark
    const float explained = covariance * covariance / variance;
    if (explained <= best.score) continue;
    best.score = explained;
    best.ray = ray;
    best.length = length;
    best.contrast = static_cast<double>(-covariance / variance);
  }
}

ShadowFinder::Candidate ShadowFinder::best_candidate(const std::array<int, 4>& tried, int tried_count,
                                                     bool everywhere) const {
  Candidate best;
  const auto may_be = [&](int ray) {
    return !is_near_tried(tried, tried_count, ray) && (everywhere || may_be_middle(ray));
  };
  // Every second ray and every third length, then what lies about the best of them.
  const Lengths coarse = everywhere ? Lengths{0, kLengths, 1} : Lengths{1, kLengths, 3};
  for (int ray = 0; ray < kRays; ray += everywhere ? 1 : 2) {
    if (may_be(ray)) compare_wedges(ray, coarse, best);
  }
  if (everywhere || best.ray < 0) return best;
  const int ray = best.ray;
  const Lengths fine{std::max(0, best.length - 2), std::min(kLengths, best.length + 3), 1};
  for (int d = -1; d <= 1; ++d) {
    const int beside = (ray + d + kRays) % kRays;
    if (d == 0 || may_be(beside)) compare_wedges(beside, fine, best);
  }
  return best;
}

ShadowStart ShadowFinder::start_of(const Candidate& candidate) const {
  ShadowStart start;
  const double angle = 2.0 * kPi * candidate.ray / kRays;
  start.tip_shadow = probe_.foot_B +
                     length_m_[static_cast<std::size_t>(candidate.length)] * Vector2d(std::cos(angle), std::sin(angle));
  start.contrast = candidate.contrast;
  start.level = start.seen_level = plane_[0];
  return start;
}

// How much brighter than the plane a place of the board is; nothing where it is not seen.
std::optional<double> ShadowFinder::off_plane(const LumaView& image, const BoardView& view,
                                              const Vector2d& from_foot) const {
  const Vector2d p_B = probe_.foot_B + from_foot;
  if (!is_seen(board_, behind_, p_B)) return std::nullopt;
  const auto pixel = view.pixel({p_B.x(), p_B.y(), 0.0});
  if (!pixel.in_front || !image.holds(pixel.at.x(), pixel.at.y(), 1.0)) return std::nullopt;
  return static_cast<double>(image.at(pixel.at.x(), pixel.at.y())) - plane_at(from_foot);
}

// How much brighter than the plane the board is on both sides of an axis.
ShadowFinder::AxisPlaces ShadowFinder::beside_axis(const LumaView& image, const BoardView& view,
                                                   const Vector2d& axis) const {
  const Vector2d across(-axis.y(), axis.x());
  AxisPlaces places;
  while (places.count < kAxisPlaces &&
         is_on_board(board_, probe_.foot_B + axis_place(places.count) * probe_.radius_m * axis)) {
    double& beside = places.beside[places.count];
    int sides = 0;
    for (const double side : {-kBeside, kBeside}) {
      const auto off = off_plane(image, view, probe_.radius_m * (axis_place(places.count) * axis + side * across));
      if (!off) continue;
      beside += *off;
      ++sides;
    }
    if (sides == 2) beside /= 2.0;
    ++places.count;
  }
  return places;
}

// The rings tell a wedge near the base, and hardly how long it is: how far is it darker along its axis than on both its sides?
ShadowStart ShadowFinder::follow_axis(const LumaView& image, const BoardView& view, const ShadowStart& start) const {
  const double length_m = (start.tip_shadow - probe_.foot_B).norm();
  if (length_m < kLongerThanRings * probe_.radius_m) return start;
  const Vector2d axis = (start.tip_shadow - probe_.foot_B) / length_m;
  const Vector2d across(-axis.y(), axis.x());
  const AxisPlaces places = beside_axis(image, view, axis);
  ShadowStart followed = start;
  double best = 0.0;
  for (const double turn : kAxisTurns) {
    const Vector2d along = probe_.radius_m * (axis + turn * across).normalized();
    double missing = 0.0;
    int seen_places = 0;
    for (std::size_t i = 0; i < places.count; ++i) {
      const auto off = off_plane(image, view, axis_place(i) * along);
      if (!off) continue;
      missing += places.beside[i] - *off;
      ++seen_places;
      const double explained = missing * std::abs(missing) / seen_places;
      if (seen_places < kLeastAxisPlaces || explained <= best) continue;
      best = explained;
      followed.tip_shadow = probe_.foot_B + kAxisEnd * axis_place(i) * along;
    }
  }
  return followed;
}

double ShadowFinder::plane_at(const Vector2d& from_foot) const {
  return plane_[0] + (plane_[1] * from_foot.x() + plane_[2] * from_foot.y()) / probe_.radius_m;
}

void ShadowFinder::sum_rays() {
  for (std::size_t r = 0; r < kRays; ++r) {
    ray_valid_[r] = total(valid_[r]);
    ray_value_[r] = total(value_[r]);
  }
}

// One line is seen. Where it ends the other one may still show.
void ShadowFinder::look_for_tip(const LumaView& image, const BoardView& view, ProbeShadow& shadow) {
  const double along_m = std::sqrt(shadow.covariance.trace());
  if (along_m > kMostToTip_m || !is_seen(board_, behind_, shadow.p_BS)) return;
  ShadowStart again;
  again.tip_shadow = shadow.p_BS;
  again.contrast = shadow.contrast;
  again.level = shadow.level;
  again.seen_level = plane_[0];
  again.lamp_radius_m = shadow.lamp_radius_m;
  again.known_m = std::max(kLeastKnown_m, along_m);
  ProbeShadow with_tip;
  if (!fit_.fit(image, view, behind_, again, with_tip) || !is_explained(with_tip)) return;
  // The same shadow, and not something else where the line ends.
  if (with_tip.contrast < kSameContrast * shadow.contrast || shadow.contrast < kSameContrast * with_tip.contrast)
    return;
  if (with_tip.covariance.trace() < kTipFound_m * kTipFound_m) shadow = with_tip;
}

// How much darker than the plane it is where so much of the lamp is hidden. A plane that was clipped is not as bright as the board.
float ShadowFinder::seen_darkness(const ProbeShadow& shadow, float hidden) {
  const double clipped = shadow.contrast - shadow.seen_contrast;
  return static_cast<float>(std::max(0.0, shadow.contrast * static_cast<double>(hidden) - clipped));
}

// Is it dark between the lines too, from the base on? A spot beside a cone has edges that fit, but no such inside.
bool ShadowFinder::is_filled(const ProbeShadow& shadow) const {
  const Outline outline = outline_of(probe_.foot_B, probe_.radius_m, shadow.p_BS);
  int asked = 0;
  int dark = 0;
  for (std::size_t r = 0; r < kRays; ++r) {
    for (std::size_t k = 0; k < kRings; ++k) {
      if (valid_[r][k] == 0.0F) continue;
      if (hidden_share(grid_[r * kRings + k], outline, kShapeBlur_m) < 0.9F) continue;
      ++asked;
      if (value_[r][k] < -0.5F * seen_darkness(shadow, 1.0F)) ++dark;
    }
  }
  return dark >= kLeastFilled * asked;
}

void ShadowFinder::take_away(const ProbeShadow& shadow) {
  const Outline outline = outline_of(probe_.foot_B, probe_.radius_m, shadow.p_BS);
  for (int ray = 0; ray < kRays; ++ray) {
    for (int ring = 0; ring < kRings; ++ring) {
      const auto r = static_cast<std::size_t>(ray);
      const auto k = static_cast<std::size_t>(ring);
      const float share = hidden_share(grid_[static_cast<std::size_t>(ray * kRings + ring)], outline, kShapeBlur_m);
      value_[r][k] += valid_[r][k] * seen_darkness(shadow, share);
    }
  }
}

// Begun with the length that shows along the axis, and if that leads to none, with what the rings tell.
bool ShadowFinder::fit_either(const LumaView& image, const BoardView& view, const ShadowStart& rings,
                              ProbeShadow& shadow) {
  const auto fits = [&](const ShadowStart& start) {
    return fit_.fit(image, view, behind_, start, shadow) && is_filled(shadow) && is_explained(shadow);
  };
  const ShadowStart axis = follow_axis(image, view, rings);
  return fits(axis) || (axis.tip_shadow != rings.tip_shadow && fits(rings));
}

// A fit that stopped at half the length leaves more than the board's own noise, and than a shadow's edges differ from the model's.
bool ShadowFinder::is_explained(const ProbeShadow& shadow) const {
  const double noise = kMostNoise * noise_;
  const double unlike = kMostUnlike * shadow.seen_contrast;
  return shadow.rms * shadow.rms <= noise * noise + unlike * unlike;
}

ShadowFinder::Found ShadowFinder::find(const LumaView& image, const geometry::Pose& X_BC) {
  Found found;
  const BoardView view(board_.camera, X_BC);
  for (int i = 0; i < board_.probes; ++i) {
    const Probe& probe = board_.probe[static_cast<std::size_t>(i)];
    behind_[static_cast<std::size_t>(i)] = outline_of(probe.foot_B, probe.radius_m, cast(view.p_BC(), probe.p_BA));
  }
  look_around(image, view);
  take_plane_away();
  noise_ = noise();
  std::array<int, 4> tried{};
  int tried_count = 0;
  while (tried_count < 4 && found.count < kMostShadows) {
    sum_rays();
    const Candidate candidate = best_candidate(tried, tried_count, everywhere_);
    if (candidate.ray < 0 || static_cast<double>(candidate.score) < kLeastScore ||
        candidate.contrast < 0.5 * parameters_.min_contrast ||
        candidate.contrast < 0.5 * parameters_.min_contrast_ratio * plane_[0] ||
        (found.count > 0 && candidate.contrast < kLeastOfFirst * found.shadow[0].seen_contrast)) {
      break;
    }
    tried[static_cast<std::size_t>(tried_count++)] = candidate.ray;
    ProbeShadow shadow;
    if (!fit_either(image, view, start_of(candidate), shadow)) continue;
    bool known = false;
    for (int i = 0; i < found.count; ++i) {
      const ProbeShadow& other = found.shadow[static_cast<std::size_t>(i)];
      known = known || (other.p_BS - shadow.p_BS).norm() < probe_.radius_m;
    }
    if (known) continue;
    if (shadow.lines == 1) look_for_tip(image, view, shadow);
    found.shadow[static_cast<std::size_t>(found.count++)] = shadow;
    take_away(shadow);
  }
  return found;
}

}  // namespace cgsr::illumination
