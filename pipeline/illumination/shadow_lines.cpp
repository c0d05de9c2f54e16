#include "pipeline/illumination/shadow_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr std::array kRingRadii{1.2, 1.4, 1.65, 1.95, 2.35, 2.9, 3.6, 4.5};               // of the base's radius
constexpr std::array kLengthFactors{1.5, 1.8, 2.2, 2.7, 3.3, 4.2, 5.5, 7.5, 11.0, 18.0};  // likewise, from the foot
constexpr double kBoardMargin_m = 0.003;
constexpr double kConeMargin_m = 0.0013;
constexpr double kBlur_px = 0.55;         // of lens, pixel and reading between pixels
constexpr double kStartOfLine_m = 0.003;  // nearer to the base its own contact is seen
constexpr double kEndOfLine = 0.9;        // of the way to the tip's shadow, which is soft all over
constexpr int kAcross = 9;                // samples across a line
constexpr int kLeastAcross = 5;           // of them to be seen
constexpr int kLeastSamples = 20;         // for a fit at all
constexpr int kLeastSparse = 24;
constexpr double kSparseContrast = 6.0;  // grey levels; a weaker one needs all samples from the start
constexpr double kSettled_m = 0.0015;    // a tip that moved less needs no other samples
constexpr int kMostPlaces = 14;          // along a line
constexpr double kCorrelation = 1.6;     // samples read between pixels are not independent
constexpr double kLeastScore = 60.0;     // grey levels squared that a wedge explains
constexpr double kLeastKnown_m = 0.004;  // of the tip beforehand, by where a single line ends
constexpr double kMostToTip_m = 0.02;    // along a single line, for its end to be looked at
constexpr double kTipFound_m = 0.0025;   // then the tip's shadow must be known to this
constexpr double kSameContrast = 0.75;   // of the line alone
constexpr double kEndWithTip = 1.1;      // the tip is most of what is seen
constexpr double kLeastOfFirst = 0.35;   // a second lamp's shadow, of the first one's contrast
constexpr double kRadiusSigma_m = 0.0003;
constexpr double kLeastFilled = 0.75;  // of the places inside, dark

// The unknowns of the fit.
enum Unknown : std::uint8_t { kTipX, kTipY, kFootX, kFootY, kRadius, kDark, kLevel, kSlopeX, kSlopeY };
constexpr int kUnknowns = 9;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

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
      lamp_height_m_(lamp_height_m) {
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
        shape_[k][ring] = hidden_share(p, outline, 0.0015);
        shape_square_[k][ring] = shape_[k][ring] * shape_[k][ring];
      }
    }
  }
}

double ShadowFinder::penumbra_sigma(double along) const {
  const double z = std::clamp(along, 0.0, 1.0) * probe_.p_BA.z();
  return 0.5 * parameters_.lamp_radius_m * z / std::max(0.1, lamp_height_m_ - z);
}

float ShadowFinder::hidden_share(const Vector2d& from_foot, const Outline& outline, double blur_m) const {
  if (!outline.valid) return 0.0F;
  // Both lines' inner sides overlap behind the base as well: only from the points on where they begin.
  const Vector2d backward = outline.inward[0] + outline.inward[1];
  if (from_foot.dot(backward) > -0.5 * probe_.radius_m * backward.squaredNorm()) return 0.0F;
  float share = -1.0F;
  for (std::size_t side = 0; side < 2; ++side) {
    const double d = from_foot.dot(outline.inward[side]) + probe_.radius_m;
    share += step_.at(static_cast<float>(d / blur_m)).share;
  }
  return std::max(0.0F, share);
}

bool ShadowFinder::seen(const Vector2d& p_B) const {
  if (std::abs(p_B.x()) > board_.depth_m / 2 - kBoardMargin_m ||
      std::abs(p_B.y()) > board_.width_m / 2 - kBoardMargin_m)
    return false;
  for (int i = 0; i < board_.probes; ++i) {
    const Probe& probe = board_.probe[static_cast<std::size_t>(i)];
    if (within(behind_[static_cast<std::size_t>(i)], probe.foot_B, probe.radius_m, p_B, kConeMargin_m)) return false;
  }
  return true;
}

void ShadowFinder::look_around(const LumaView& image, const BoardView& view) {
  for (int ray = 0; ray < kRays; ++ray) {
    for (int ring = 0; ring < kRings; ++ring) {
      const auto r = static_cast<std::size_t>(ray);
      const auto k = static_cast<std::size_t>(ring);
      value_[r][k] = valid_[r][k] = 0.0F;
      const Vector2d p_B = probe_.foot_B + grid_[static_cast<std::size_t>(ray * kRings + ring)];
      if (!seen(p_B)) continue;
      const auto pixel = view.pixel({p_B.x(), p_B.y(), 0.0});
      if (!pixel.in_front || !image.holds(pixel.at.x(), pixel.at.y(), 1.0)) continue;
      valid_[r][k] = 1.0F;
      value_[r][k] = image.at(pixel.at.x(), pixel.at.y());
    }
  }
}

void ShadowFinder::take_plane_away() {
  // The board's brightness is nearly a plane; places darker than it count less and less.
  Vector3d plane(0.0, 0.0, 0.0);
  double soft = 40.0;
  for (int round = 0; round < 4; ++round) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Identity() * 1e-3;
    Vector3d g = Vector3d::Zero();
    for (std::size_t r = 0; r < kRays; ++r) {
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
  level_ = plane[0];
  for (std::size_t r = 0; r < kRays; ++r) {
    for (std::size_t k = 0; k < kRings; ++k) {
      const Vector2d q = grid_[r * kRings + k] / probe_.radius_m;
      value_[r][k] -= valid_[r][k] * static_cast<float>(plane[0] + plane[1] * q.x() + plane[2] * q.y());
    }
  }
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
  const float least = -0.25F * static_cast<float>(parameters_.least_contrast);
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

ShadowFinder::Candidate ShadowFinder::best_candidate(const std::array<int, 4>& tried, int tried_count,
                                                     bool everywhere) const {
  Candidate best;
  float best_score = 0.0F;
  const auto may_be = [&](int ray) {
    for (int i = 0; i < tried_count; ++i) {
      const int apart = std::abs(tried[static_cast<std::size_t>(i)] - ray);
      if (std::min(apart, kRays - apart) <= 3) return false;
    }
    return everywhere || may_be_middle(ray);
  };
  int best_length = 0;
  const auto compare = [&](int ray, int from, int to, int step) {
    float n = 0.0F;
    float v = 0.0F;
    for (int d = -kHalfWindow; d <= kHalfWindow; ++d) {
      const auto k = static_cast<std::size_t>((ray + d + kRays) % kRays);
      n += ray_valid_[k];
      v += ray_value_[k];
    }
    if (n < 30.0F) return;
    const float mean = v / n;
    for (int length = from; length < to; length += step) {
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
      if (explained <= best_score) continue;
      best_score = explained;
      best_length = length;
      best.score = static_cast<double>(explained);
      best.ray = ray;
      best.contrast = static_cast<double>(-covariance / variance);
      best.level = level_;
      const double angle = 2.0 * kPi * ray / kRays;
      best.tip_shadow =
          probe_.foot_B + length_m_[static_cast<std::size_t>(length)] * Vector2d(std::cos(angle), std::sin(angle));
    }
  };
  const int step = everywhere ? 1 : 3;
  for (int ray = 0; ray < kRays; ++ray) {
    if (may_be(ray)) compare(ray, everywhere ? 0 : 1, kLengths, step);
  }
  if (everywhere || best.ray < 0) return best;
  const int ray = best.ray;
  const int length = best_length;
  for (int d = -1; d <= 1; ++d) {
    const int beside = (ray + d + kRays) % kRays;
    if (d == 0 || may_be(beside)) compare(beside, std::max(0, length - 2), std::min(kLengths, length + 3), 1);
  }
  return best;
}

void ShadowFinder::sum_rays() {
  for (std::size_t r = 0; r < kRays; ++r) {
    ray_valid_[r] = total(valid_[r]);
    ray_value_[r] = total(value_[r]);
  }
}

int ShadowFinder::choose_samples(const LumaView& image, const BoardView& view, const Vector2d& tip_shadow,
                                 double slack_m, bool with_tip, bool sparse) {
  const Outline outline = outline_of(probe_.foot_B, probe_.radius_m, tip_shadow);
  if (!outline.valid) return 0;
  int count = 0;
  int place = 0;
  for (Place& p : places_) p = Place{};
  for (std::size_t side = 0; side < 2; ++side) {
    const Vector2d line = tip_shadow - outline.touch[side];
    const double length = line.norm();
    // The part of the line that lies on the board, so that a long shadow's samples do not fall beside it.
    double reach = with_tip ? kEndWithTip : kEndOfLine;
    for (int axis = 0; axis < 2; ++axis) {
      const double edge = (axis == 0 ? board_.depth_m : board_.width_m) / 2 - kBoardMargin_m;
      const double end = outline.touch[side][axis] + line[axis];
      if (std::abs(end) > edge) {
        reach = std::min(reach, (std::copysign(edge, end) - outline.touch[side][axis]) / line[axis]);
      }
    }
    const double begin = kStartOfLine_m / length;
    if (reach <= begin) continue;
    const auto middle = view.derivative(
        {outline.touch[side].x() + 0.4 * reach * line.x(), outline.touch[side].y() + 0.4 * reach * line.y(), 0.0});
    if (!middle.in_front) continue;
    const double line_px = (middle.by_point.leftCols<2>() * line).norm() * (reach - begin);
    int places = std::clamp(static_cast<int>(line_px / parameters_.spacing_px), 5, kMostPlaces);
    if (sparse) places = std::max(5, places / 2);
    const int samples_across = sparse ? kAcross / 2 + 1 : kAcross;
    for (int i = 0; i < places; ++i) {
      const double along = begin + (reach - begin) * (i + 0.5) / places;
      const Vector2d centre = outline.touch[side] + along * line;
      const auto d = view.derivative({centre.x(), centre.y(), 0.0});
      if (!d.in_front) continue;
      const Vector2d across = d.by_point.leftCols<2>() * outline.inward[side];
      const double px_per_m = across.norm();
      m_per_px_ = 1.0 / px_per_m;
      const double soft = penumbra_sigma(along);
      const double half = std::max(2.2 * m_per_px_, 2.2 * soft) + slack_m;
      const int before = count;
      for (int k = 0; k < samples_across && count < kMostSamples; ++k) {
        const double t = half * (2.0 * k / (samples_across - 1) - 1.0);
        const Vector2d p_B = centre + t * outline.inward[side];
        const Vector2d pixel = d.at + t * across;
        if (!image.holds(pixel.x(), pixel.y(), 1.0) || !seen(p_B)) continue;
        Sample& sample = samples_[static_cast<std::size_t>(count++)];
        sample.from_foot = (p_B - probe_.foot_B).cast<float>();
        sample.value = image.at(pixel.x(), pixel.y());
        sample.place = place;
      }
      if (count - before < (with_tip || sparse ? 3 : kLeastAcross)) {
        count = before;
        continue;
      }
      places_[static_cast<std::size_t>(place++)].side = static_cast<int>(side);
    }
  }
  return count;
}

bool ShadowFinder::fit(const LumaView& image, const BoardView& view, const Candidate& candidate, ProbeShadow& shadow) {
  const bool with_tip = candidate.known_m > 0.0;
  Unknowns x;
  x << candidate.tip_shadow, probe_.foot_B, probe_.radius_m, candidate.contrast, candidate.level, 0.0, 0.0;
  Normal H;
  double variance = 0.0;
  double moved_m = 1.0;
  int count = 0;
  const double foot_weight = 1.0 / std::max(1e-10, board_.place_sigma_m * board_.place_sigma_m);
  // Few samples until the tip stays where it is, then all of them.
  constexpr int kChoices = 4;
  bool settled = false;
  for (int choice = 0; choice < kChoices && !settled; ++choice) {
    settled = choice + 1 == kChoices || (choice > 0 && moved_m < kSettled_m);
    bool sparse = !settled && !with_tip && candidate.contrast > kSparseContrast;
    const Vector2d chosen_at = x.head<2>();
    const double slack_m = choice == 0 ? std::min(0.004, 0.08 * (chosen_at - probe_.foot_B).norm()) : 0.001;
    count = choose_samples(image, view, chosen_at, slack_m, with_tip, sparse);
    if (sparse && count < kLeastSparse) {
      sparse = false;
      count = choose_samples(image, view, chosen_at, slack_m, with_tip, sparse);
    }
    if (count < (with_tip ? kLeastSamples / 2 : sparse ? kLeastSparse : kLeastSamples)) return false;
    const int steps = choice == 0 ? 3 : 2;
    for (int step = 0; step < steps; ++step) {
      const Vector2d tip = x.head<2>();
      const Vector2d foot = x.segment<2>(kFootX);
      const Outline outline = outline_of(foot, x[kRadius], tip);
      if (!outline.valid) return false;
      std::array<Eigen::Vector2f, 2> inward;
      std::array<Eigen::Vector2f, 2> along;
      std::array<float, 2> over_length{};
      for (std::size_t side = 0; side < 2; ++side) {
        const Vector2d line = tip - outline.touch[side];
        const double length = line.norm();
        inward[side] = outline.inward[side].cast<float>();
        along[side] = (line / length).cast<float>();
        over_length[side] = static_cast<float>(1.0 / length);
      }
      const Eigen::Vector2f off_foot = (foot - probe_.foot_B).cast<float>();
      const auto radius = static_cast<float>(x[kRadius]);
      const auto dark = static_cast<float>(x[kDark]);
      const auto level = static_cast<float>(x[kLevel]);
      const Eigen::Vector2f slope = x.segment<2>(kSlopeX).cast<float>();
      const float blur = static_cast<float>(kBlur_px * m_per_px_);
      const auto soft_end = static_cast<float>(penumbra_sigma(1.0));
      const float scale = std::max(3.0F, 0.12F * std::abs(dark));
      // Sums over samples in plain arrays: 9 unknowns and the residual, padded to 12.
      std::array<std::array<float, 12>, 10> sums{};
      float squares = 0.0F;
      float weights = 0.0F;
      for (Place& p : places_) p.h = p.hh = p.hv = p.v = 0.0F, p.count = 0;
      for (int i = 0; i < count; ++i) {
        const Sample& sample = samples_[static_cast<std::size_t>(i)];
        const Eigen::Vector2f q = sample.from_foot - off_foot;
        float hidden = -1.0F;
        std::array<float, 2> density{};
        std::array<float, 2> share_of_way{};
        for (std::size_t side = 0; side < 2; ++side) {
          const float d = q.dot(inward[side]) + radius;
          const float way = std::clamp(q.dot(along[side]) * over_length[side], 0.0F, 1.0F);
          const float soft = soft_end * way;
          const float sigma = std::sqrt(soft * soft + blur * blur);
          const auto value = step_.at(d / sigma);
          hidden += value.share;
          density[side] = value.density / sigma;
          share_of_way[side] = way;
        }
        if (hidden <= 0.0F) hidden = 0.0F, density = {};
        std::array<float, 12> j{};
        for (std::size_t side = 0; side < 2; ++side) {
          const float by_d = -dark * density[side];
          const float at_tip = by_d * share_of_way[side];
          const float at_foot = by_d - at_tip;
          j[kTipX] -= at_tip * inward[side].x();
          j[kTipY] -= at_tip * inward[side].y();
          j[kFootX] -= at_foot * inward[side].x();
          j[kFootY] -= at_foot * inward[side].y();
          j[kRadius] += at_foot;
        }
        j[kDark] = -hidden;
        j[kLevel] = 1.0F;
        j[kSlopeX] = sample.from_foot.x();
        j[kSlopeY] = sample.from_foot.y();
        const float plain = level + slope.dot(sample.from_foot);
        const float residual = sample.value - (plain - dark * hidden);
        j[9] = residual;
        const float relative = residual / scale;
        const float robust = 1.0F / (1.0F + relative * relative);
        for (std::size_t a = 0; a < 9; ++a) {
          const float w = robust * j[a];
          for (std::size_t b = a / 4 * 4; b < 12; ++b) sums[a][b] += w * j[b];
        }
        squares += robust * residual * residual;
        weights += robust;
        Place& place = places_[static_cast<std::size_t>(sample.place)];
        const float missing = plain - sample.value;
        place.h += hidden;
        place.hh += hidden * hidden;
        place.hv += hidden * missing;
        place.v += missing;
        ++place.count;
      }
      Unknowns g;
      for (int a = 0; a < kUnknowns; ++a) {
        for (int b = a; b < kUnknowns; ++b) {
          H(a, b) = H(b, a) = static_cast<double>(sums[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)]);
        }
        g[a] = static_cast<double>(sums[static_cast<std::size_t>(a)][9]);
      }
      variance = std::max(0.3, static_cast<double>(squares) / std::max(1.0, static_cast<double>(weights) - kUnknowns));
      const double noise = variance * kCorrelation;
      H /= noise;
      g /= noise;
      H(kFootX, kFootX) += foot_weight;
      H(kFootY, kFootY) += foot_weight;
      g.segment<2>(kFootX) += foot_weight * (probe_.foot_B - foot);
      H(kRadius, kRadius) += 1.0 / (kRadiusSigma_m * kRadiusSigma_m);
      g[kRadius] += (probe_.radius_m - x[kRadius]) / (kRadiusSigma_m * kRadiusSigma_m);
      // Very weak, for what the samples cannot tell: with one line the place along it.
      const double known_m = with_tip ? candidate.known_m : 0.5;
      const double weak = 1.0 / (known_m * known_m);
      g.head<2>() += weak * (candidate.tip_shadow - tip);
      H(kTipX, kTipX) += weak;
      H(kTipY, kTipY) += weak;
      H(kSlopeX, kSlopeX) += 1.0 / (100.0 * 100.0);
      H(kSlopeY, kSlopeY) += 1.0 / (100.0 * 100.0);
      H(kDark, kDark) += 1e-6;
      const Eigen::LLT<Normal> solver(H);
      if (solver.info() != Eigen::Success) return false;
      Unknowns change = solver.solve(g);
      // No further than samples reach; the tip not through the base.
      const double distance = (x.head<2>() - x.segment<2>(kFootX)).norm();
      const double most = 0.35 * distance;
      const double move = change.head<2>().norm();
      if (move > most) change *= most / move;
      x += change;
      if (x[kDark] < 1.0) return false;
    }
    moved_m = (x.head<2>() - chosen_at).norm();
  }
  const double distance = (x.head<2>() - probe_.foot_B).norm();
  const double flat = (x.head<2>() - probe_.p_BA.head<2>()).norm();
  if (distance < 1.15 * probe_.radius_m) return false;
  if (flat > probe_.p_BA.z() * std::tan(parameters_.largest_angle_deg * kPi / 180.0)) return false;
  shadow.contrast = x[kDark];
  shadow.rms = std::sqrt(variance);
  const Normal covariance = H.inverse();
  if (!with_tip && shadow.contrast < 6.0 * std::sqrt(covariance(kDark, kDark))) return false;
  if (shadow.contrast < parameters_.least_contrast || shadow.contrast < parameters_.least_share * x[kLevel])
    return false;
  shadow.p_BS = x.head<2>();
  shadow.covariance = covariance.topLeftCorner<2, 2>();
  const Vector3d p_BS(x[kTipX], x[kTipY], 0.0);
  const auto d = view.derivative(p_BS);
  if (!d.in_front) return false;
  shadow.by_pose = -d.by_point.leftCols<2>().inverse() * view.by_pose(d, p_BS);
  if (with_tip) {
    shadow.lines = 2;
    shadow.support = 1.0;
    return shadow.rms < std::max(1.8, 0.1 * shadow.contrast) &&
           (shadow.p_BS - candidate.tip_shadow).norm() < 3.0 * candidate.known_m;
  }
  // Do the places along the lines show it, each by itself?
  std::array<int, 2> shown{};
  std::array<int, 2> asked{};
  for (const Place& place : places_) {
    if (place.count == 0) continue;
    const float n = static_cast<float>(place.count);
    const float spread = place.hh - place.h * place.h / n;
    if (spread < 0.25F) continue;
    const double contrast = static_cast<double>((place.hv - place.h * place.v / n) / spread);
    const auto side = static_cast<std::size_t>(place.side);
    ++asked[side];
    if (contrast > 0.5 * shadow.contrast && contrast < 1.6 * shadow.contrast) ++shown[side];
  }
  int all_asked = 0;
  int all_shown = 0;
  shadow.lines = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    all_asked += asked[side];
    all_shown += shown[side];
    const bool enough = asked[side] >= 3 && shown[side] >= parameters_.least_support * asked[side];
    if (asked[side] >= 3 && !enough) return false;
    shadow.line_seen[side] = enough;
    shadow.lines += enough ? 1 : 0;
  }
  if (shadow.lines == 0 || shadow.rms > std::max(4.0, 0.35 * shadow.contrast)) return false;
  shadow.support = static_cast<double>(all_shown) / std::max(1, all_asked);
  return true;
}

// One line is seen. Where it ends the other one may still show.
void ShadowFinder::look_for_tip(const LumaView& image, const BoardView& view, ProbeShadow& shadow) {
  const double along_m = std::sqrt(shadow.covariance.trace());
  if (along_m > kMostToTip_m || !seen(shadow.p_BS)) return;
  Candidate again;
  again.tip_shadow = shadow.p_BS;
  again.contrast = shadow.contrast;
  again.level = level_;
  again.known_m = std::max(kLeastKnown_m, along_m);
  ProbeShadow with_tip;
  if (!fit(image, view, again, with_tip)) return;
  // The same shadow, and not something else where the line ends.
  if (with_tip.contrast < kSameContrast * shadow.contrast || shadow.contrast < kSameContrast * with_tip.contrast)
    return;
  if (with_tip.covariance.trace() < kTipFound_m * kTipFound_m) shadow = with_tip;
}

// Is it dark between the lines too, from the base on? A spot beside a cone has edges that fit, but no such inside.
bool ShadowFinder::is_filled(const ProbeShadow& shadow) const {
  const Outline outline = outline_of(probe_.foot_B, probe_.radius_m, shadow.p_BS);
  int asked = 0;
  int dark = 0;
  for (std::size_t r = 0; r < kRays; ++r) {
    for (std::size_t k = 0; k < kRings; ++k) {
      if (valid_[r][k] == 0.0F) continue;
      if (hidden_share(grid_[r * kRings + k], outline, 0.0015) < 0.9F) continue;
      ++asked;
      if (static_cast<double>(value_[r][k]) < -0.5 * shadow.contrast) ++dark;
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
      const float share = hidden_share(grid_[static_cast<std::size_t>(ray * kRings + ring)], outline, 0.0015);
      value_[r][k] += valid_[r][k] * static_cast<float>(shadow.contrast) * share;
    }
  }
}

double ShadowFinder::share_brighter_than(double level) const {
  int seen_places = 0;
  int brighter = 0;
  for (std::size_t r = 0; r < kRays; ++r) {
    for (std::size_t k = 0; k < kRings; ++k) {
      if (valid_[r][k] == 0.0F) continue;
      ++seen_places;
      if (static_cast<double>(value_[r][k]) > level) ++brighter;
    }
  }
  return seen_places > 0 ? static_cast<double>(brighter) / seen_places : 0.0;
}

ShadowFinder::Found ShadowFinder::find(const LumaView& image, const geometry::Pose& X_BC, double saturation) {
  Found found;
  const BoardView view(board_.camera, X_BC);
  for (int i = 0; i < board_.probes; ++i) {
    const Probe& probe = board_.probe[static_cast<std::size_t>(i)];
    behind_[static_cast<std::size_t>(i)] = outline_of(probe.foot_B, probe.radius_m, cast(view.p_BC(), probe.p_BA));
  }
  look_around(image, view);
  saturated_ = share_brighter_than(saturation);
  take_plane_away();
  std::array<int, 4> tried{};
  int tried_count = 0;
  while (tried_count < 4 && found.count < kMostShadows) {
    sum_rays();
    const Candidate candidate = best_candidate(tried, tried_count, everywhere_);
    if (candidate.ray < 0 || candidate.score < kLeastScore || candidate.contrast < 0.5 * parameters_.least_contrast ||
        candidate.contrast < 0.5 * parameters_.least_share * level_ ||
        (found.count > 0 && candidate.contrast < kLeastOfFirst * found.shadow[0].contrast)) {
      break;
    }
    tried[static_cast<std::size_t>(tried_count++)] = candidate.ray;
    ProbeShadow shadow;
    if (!fit(image, view, candidate, shadow) || !is_filled(shadow)) continue;
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
