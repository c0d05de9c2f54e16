#include "pipeline/color/ball/ball_circle.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/imaging/color_code.h"

namespace cgsr::color {
namespace {

constexpr int kRays = 36;
constexpr int kRounds = 2;
constexpr double kMissing = 1.5;    // what a foreign pixel on a ray weighs against one of the ball
constexpr double kGiveUp_px = 5.0;  // so much foreign more than own ends a ray, or a sixth of the largest radius
constexpr double kInlier = 0.09;    // of the radius
constexpr double kInlier_px = 0.8;
constexpr double kLeastInliers = 0.4;
constexpr double kReach = 0.3;           // edges are looked for so far from the circle, in radii
constexpr int kSteps = 8;                // to either side
constexpr double kLeastContrast = 10.0;  // of an edge, luma and chroma added, in steps of 8 bits
constexpr double kAlong = 0.75;          // share of the gradient's energy that points to the middle
constexpr double kOnCircle = 0.06;       // an edge lies on the circle when it is no farther, in radii
constexpr double kOnCircle_px = 1.0;
constexpr double kSlack = 0.15;  // a circle may be so much larger or smaller than what can be
constexpr int kAreaPoints = 64;
constexpr int kRingPoints = 48;
constexpr double kLeastInImage = 0.5;  // of the circumference
constexpr double kEnough =
    0.85;  // of it in the image: of a circle that shows less, what lies outside speaks against it
constexpr double kGoldenTurn = 2.399963229728653;
constexpr double kWholeTurn = 6.283185307179586;

struct Point {
  double x = 0.0;
  double y = 0.0;
};

template <std::size_t kCount>
std::array<Point, kCount> directions() {
  std::array<Point, kCount> all;
  for (std::size_t i = 0; i < kCount; ++i) {
    const double angle = kWholeTurn * static_cast<double>(i) / static_cast<double>(kCount);
    all[i] = {std::cos(angle), std::sin(angle)};
  }
  return all;
}

/// Evenly over the unit circle's area: a sunflower's seeds.
template <std::size_t kCount>
std::array<Point, kCount> seeds() {
  std::array<Point, kCount> all;
  for (std::size_t i = 0; i < kCount; ++i) {
    const double radius = std::sqrt((static_cast<double>(i) + 0.5) / static_cast<double>(kCount));
    const double angle = kGoldenTurn * static_cast<double>(i);
    all[i] = {radius * std::cos(angle), radius * std::sin(angle)};
  }
  return all;
}

const std::array<Point, kRays> kDirections = directions<kRays>();
const std::array<Point, kAreaPoints> kSeeds = seeds<kAreaPoints>();
const std::array<Point, kRingPoints> kRing = directions<kRingPoints>();

int whole(double coordinate) {
  return static_cast<int>(std::floor(coordinate));
}

struct Ends {
  std::array<Point, kRays> at;
  std::array<bool, kRays> cut{};  // by the image's border: says nothing of the ball's
};

/// Along every ray the place up to which the ball's colours outweigh others most.
Ends cast(const BallPixels& pixels, const Point& from, double longest) {
  Ends ends;
  const double give_up = std::max(kGiveUp_px, longest / 12.0);
  for (std::size_t i = 0; i < kRays; ++i) {
    const Point& way = kDirections[i];
    double sum = 0.0;
    double best = 0.0;
    double end = 0.0;
    const double step = longest > 120.0 ? 2.0 : 1.0;
    double t = 0.0;
    for (; t < longest && sum > best - give_up; t += step) {
      const int x = whole(from.x + t * way.x);
      const int y = whole(from.y + t * way.y);
      if (!pixels.inside(x, y)) {
        ends.cut[i] = sum > best - 2.0 * kMissing * step;
        break;
      }
      sum += pixels.member(x, y) ? step : -kMissing * step;
      if (sum <= best) continue;
      best = sum;
      end = t + 0.5 * step;
    }
    ends.at[i] = {from.x + end * way.x, from.y + end * way.y};
  }
  return ends;
}

std::optional<Circle> circle_through(const Point& a, const Point& b, const Point& c) {
  const double bx = b.x - a.x;
  const double by = b.y - a.y;
  const double cx = c.x - a.x;
  const double cy = c.y - a.y;
  const double d = 2.0 * (bx * cy - by * cx);
  if (std::abs(d) < 1e-6) return std::nullopt;
  const double b2 = bx * bx + by * by;
  const double c2 = cx * cx + cy * cy;
  const double x = (cy * b2 - by * c2) / d;
  const double y = (bx * c2 - cx * b2) / d;
  return Circle{a.x + x, a.y + y, std::sqrt(x * x + y * y)};
}

/// How far a point is from a circle.
double off(const Point& p, const Circle& circle) {
  const double dx = p.x - circle.x_px;
  const double dy = p.y - circle.y_px;
  return std::abs(std::sqrt(dx * dx + dy * dy) - circle.radius_px);
}

double tolerance(const Circle& circle) {
  return kInlier * circle.radius_px + kInlier_px;
}

/// The algebraic fit (Kasa) to weighted points; nothing where they do not make a circle.
template <std::size_t kCount>
std::optional<Circle> fitted(const std::array<Point, kCount>& points, const std::array<double, kCount>& weights) {
  double n = 0.0, mx = 0.0, my = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    n += weights[i];
    mx += weights[i] * points[i].x;
    my += weights[i] * points[i].y;
  }
  if (n < 5.0) return std::nullopt;
  mx /= n;
  my /= n;
  double xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0, z = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const double x = points[i].x - mx;
    const double y = points[i].y - my;
    const double q = x * x + y * y;
    xx += weights[i] * x * x;
    xy += weights[i] * x * y;
    yy += weights[i] * y * y;
    xz += weights[i] * x * q;
    yz += weights[i] * y * q;
    z += weights[i] * q;
  }
  const double d = xx * yy - xy * xy;
  if (d < 1e-6 * (xx + yy) * (xx + yy)) return std::nullopt;
  const double x = 0.5 * (xz * yy - yz * xy) / d;
  const double y = 0.5 * (yz * xx - xz * xy) / d;
  return Circle{mx + x, my + y, std::sqrt(x * x + y * y + z / n)};
}

/// The circle through three of the ends that most others lie on, then through all of those.
std::optional<Circle> first_circle(const Ends& ends, double min_radius, double most_radius) {
  Circle best;
  int most = 0;
  for (const std::size_t apart : {std::size_t{6}, std::size_t{9}, std::size_t{12}}) {
    for (std::size_t i = 0; i < kRays; ++i) {
      const std::size_t j = (i + apart) % kRays;
      const std::size_t k = (i + 2 * apart) % kRays;
      if (ends.cut[i] || ends.cut[j] || ends.cut[k]) continue;
      const auto circle = circle_through(ends.at[i], ends.at[j], ends.at[k]);
      if (!circle || circle->radius_px < min_radius || circle->radius_px > most_radius) continue;
      const double within = tolerance(*circle);
      int count = 0;
      for (std::size_t other = 0; other < kRays; ++other) {
        if (!ends.cut[other] && off(ends.at[other], *circle) < within) ++count;
      }
      if (count <= most) continue;
      most = count;
      best = *circle;
    }
  }
  const auto whole_ends = std::count(ends.cut.begin(), ends.cut.end(), false);
  if (most < 5 || most < kLeastInliers * static_cast<double>(whole_ends)) return std::nullopt;
  std::array<double, kRays> weights{};
  for (std::size_t i = 0; i < kRays; ++i) {
    weights[i] = !ends.cut[i] && off(ends.at[i], best) < tolerance(best) ? 1.0 : 0.0;
  }
  const auto better = fitted(ends.at, weights);
  return better && off({better->x_px + better->radius_px, better->y_px}, best) < best.radius_px ? *better : best;
}

struct Color {
  double y = 0.0;
  double u = 0.0;
  double v = 0.0;
};

/// Bilinear; beyond the border the border repeats.
Color color_at(const ImageView& image, double x_px, double y_px) {
  const double x = std::clamp(x_px - 0.5, 0.0, image.width_px - 1.001);
  const double y = std::clamp(y_px - 0.5, 0.0, image.height_px - 1.001);
  const auto left = static_cast<int>(x);
  const auto top = static_cast<int>(y);
  const double fx = x - left;
  const double fy = y - top;
  const std::uint8_t* upper = image.row(top);
  const std::uint8_t* lower = image.row(top + 1);
  const auto between = [fx, fy](double a, double b, double c, double d) {
    const double above = a + fx * (b - a);
    return above + fy * (c + fx * (d - c) - above);
  };
  // Chroma of a pair stands midway between its two pixels.
  const double pair = std::clamp(0.5 * (x - 0.5), 0.0, 0.5 * image.width_px - 1.001);
  const auto left_pair = static_cast<int>(pair);
  const double fp = pair - left_pair;
  const auto chroma = [&](int byte) {
    const std::ptrdiff_t at = std::ptrdiff_t{4} * left_pair + byte;
    const double above = upper[at] + fp * (upper[at + 4] - upper[at]);
    const double below = lower[at] + fp * (lower[at + 4] - lower[at]);
    return above + fy * (below - above);
  };
  const std::ptrdiff_t at = std::ptrdiff_t{2} * left;
  return {between(upper[at], upper[at + 2], lower[at], lower[at + 2]), chroma(1), chroma(3)};
}

double squared(const Color& a, const Color& b) {
  const double dy = a.y - b.y;
  const double du = a.u - b.u;
  const double dv = a.v - b.v;
  return dy * dy + 2.0 * (du * du + dv * dv);
}

struct Edges {
  std::array<Point, kRays> at;
  std::array<double, kRays> weight{};  // 0: no edge there
  int in_image = 0;
};

/// The strongest edge near the circle on every ray from its middle.
Edges edges_near(const ImageView& image, const Circle& circle, double reach) {
  Edges edges;
  const double step = reach * circle.radius_px / kSteps;
  const double across = std::max(0.75, 0.08 * circle.radius_px);
  const int apart = std::max(1, static_cast<int>(std::lround(across / step)));
  for (std::size_t i = 0; i < kRays; ++i) {
    const Point& way = kDirections[i];
    if (const double x = circle.x_px + circle.radius_px * way.x, y = circle.y_px + circle.radius_px * way.y;
        x < 1.0 || y < 1.0 || x > image.width_px - 1.0 || y > image.height_px - 1.0) {
      continue;
    }
    ++edges.in_image;
    constexpr int kMost = 2 * kSteps + 1 + 2 * 4;
    std::array<Color, kMost> colors;
    const int wide = std::min(apart, 4);
    const int count = 2 * kSteps + 1 + 2 * wide;
    for (int k = 0; k < count; ++k) {
      const double t = circle.radius_px + (k - kSteps - wide) * step;
      colors[static_cast<std::size_t>(k)] = color_at(image, circle.x_px + t * way.x, circle.y_px + t * way.y);
    }
    double best = kLeastContrast * kLeastContrast;
    int at = -1;
    std::array<double, kMost> strength{};
    for (int k = wide; k < count - wide; ++k) {
      const double aside = (k - kSteps - wide) / static_cast<double>(kSteps);
      const double contrast =
          squared(colors[static_cast<std::size_t>(k - wide)], colors[static_cast<std::size_t>(k + wide)]);
      strength[static_cast<std::size_t>(k)] = contrast;
      const double worth = contrast * (1.0 - 0.5 * aside * aside);
      if (contrast < kLeastContrast * kLeastContrast || worth <= best) continue;
      best = worth;
      at = k;
    }
    if (at < 0) continue;
    double shift = 0.0;
    if (at > wide && at < count - wide - 1) {
      const double before = strength[static_cast<std::size_t>(at - 1)];
      const double here = strength[static_cast<std::size_t>(at)];
      const double after = strength[static_cast<std::size_t>(at + 1)];
      const double bend = before - 2.0 * here + after;
      if (bend < 0.0) shift = std::clamp(0.5 * (before - after) / bend, -1.0, 1.0);
    }
    const double t = circle.radius_px + (at - kSteps - wide + shift) * step;
    edges.at[i] = {circle.x_px + t * way.x, circle.y_px + t * way.y};
    edges.weight[i] = 1.0;
  }
  return edges;
}

/// Leaves out edges that lie off the circle, twice.
std::optional<Circle> refined(Edges& edges, const Circle& start) {
  Circle circle = start;
  for (int round = 0; round < 2; ++round) {
    const auto next = fitted(edges.at, edges.weight);
    if (!next) return std::nullopt;
    circle = *next;
    const double within = 1.5 * (kOnCircle * circle.radius_px + kOnCircle_px) / (round + 1);
    for (std::size_t i = 0; i < kRays; ++i) {
      if (edges.weight[i] > 0.0 && off(edges.at[i], circle) > within) edges.weight[i] = 0.0;
    }
  }
  return fitted(edges.at, edges.weight);
}

/// The share of the circumference on which an edge runs along the circle.
double agreement_of(const ImageView& image, const Edges& edges, const Circle& circle) {
  if (edges.in_image < kLeastInImage * kRays) return 0.0;
  const double h = std::max(0.75, 0.08 * circle.radius_px);
  const double within = kOnCircle * circle.radius_px + kOnCircle_px;
  int count = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    if (edges.weight[i] <= 0.0 || off(edges.at[i], circle) > within) continue;
    const Point& p = edges.at[i];
    const double dx = (p.x - circle.x_px) / circle.radius_px;
    const double dy = (p.y - circle.y_px) / circle.radius_px;
    const double out =
        squared(color_at(image, p.x + h * dx, p.y + h * dy), color_at(image, p.x - h * dx, p.y - h * dy));
    const double along =
        squared(color_at(image, p.x - h * dy, p.y + h * dx), color_at(image, p.x + h * dy, p.y - h * dx));
    if (out > kAlong * (out + along)) ++count;
  }
  return count / std::max<double>(edges.in_image, kEnough * kRays);
}

double share_inside(const BallPixels& pixels, const Circle& circle) {
  int count = 0;
  int all = 0;
  for (const Point& seed : kSeeds) {
    const int x = whole(circle.x_px + 0.92 * circle.radius_px * seed.x);
    const int y = whole(circle.y_px + 0.92 * circle.radius_px * seed.y);
    if (!pixels.inside(x, y)) continue;
    ++all;
    if (pixels.member(x, y)) ++count;
  }
  return all > 0 ? count / static_cast<double>(all) : 0.0;
}

double share_around(const BallPixels& pixels, const Circle& circle) {
  int count = 0;
  int all = 0;
  for (const double out : {1.25, 1.45}) {
    const double radius = out * circle.radius_px + 0.5;
    for (const Point& way : kRing) {
      const int x = whole(circle.x_px + radius * way.x);
      const int y = whole(circle.y_px + radius * way.y);
      if (!pixels.inside(x, y)) continue;
      ++all;
      if (pixels.member(x, y)) ++count;
    }
  }
  return all > 0 ? count / static_cast<double>(all) : 1.0;
}

}  // namespace

bool BallPixels::member(int x, int y) const {
  const std::uint8_t* pair = image.row(y) + std::ptrdiff_t{4} * (x / 2);
  const int kind = kinds & of_code[imaging::color_code(4 * pair[2 * (x % 2)], 2 * pair[1], 2 * pair[3])];
  return (kind & BallModel::kBright) != 0 || (kind != 0 && shaded(x, y));
}

CircleFit fit_circle(const BallPixels& pixels, double x_px, double y_px, const SizeRange& sizes) {
  const double least = 0.5 * sizes.min_px * (1.0 - kSlack);
  const double most = 0.5 * sizes.most_px * (1.0 + kSlack);
  Point from{x_px, y_px};
  CircleFit fit;
  fit.kinds = pixels.kinds;
  for (int round = 0; round < kRounds; ++round) {
    const Ends ends = cast(pixels, from, 2.2 * most);
    auto circle = first_circle(ends, least, most);
    if (!circle) break;
    Edges edges = edges_near(pixels.image, *circle, kReach);
    if (const auto better = refined(edges, *circle); better && better->radius_px > least && better->radius_px < most) {
      circle = better;
    }
    edges = edges_near(pixels.image, *circle, 0.5 * kReach);
    if (const auto better = refined(edges, *circle); better && better->radius_px > least && better->radius_px < most) {
      circle = better;
    }
    CircleFit now = fit;
    now.circle = *circle;
    now.agreement = agreement_of(pixels.image, edges, *circle);
    now.inside = share_inside(pixels, *circle);
    now.around = share_around(pixels, *circle);
    if (now.score() > fit.score()) fit = now;
    from = {circle->x_px, circle->y_px};
    if (now.inside < 0.3) break;
  }
  return fit;
}

Circle middle_of_members(const BallPixels& pixels, const Circle& around) {
  Circle middle = around;
  for (int round = 0; round < 3; ++round) {
    double x_sum = 0.0;
    double y_sum = 0.0;
    int count = 0;
    for (const Point& seed : kSeeds) {
      const double x = middle.x_px + middle.radius_px * seed.x;
      const double y = middle.y_px + middle.radius_px * seed.y;
      if (!pixels.inside(whole(x), whole(y)) || !pixels.member(whole(x), whole(y))) continue;
      x_sum += x;
      y_sum += y;
      ++count;
    }
    if (count == 0) break;
    middle.x_px = x_sum / count;
    middle.y_px = y_sum / count;
  }
  return middle;
}

double shade_share(const BallPixels& pixels, const Circle& circle) {
  if (pixels.mask.empty()) return 0.0;
  int count = 0;
  int all = 0;
  for (const Point& seed : kSeeds) {
    const int x = whole(circle.x_px + circle.radius_px * seed.x);
    const int y = whole(circle.y_px + circle.radius_px * seed.y);
    if (!pixels.inside(x, y)) continue;
    ++all;
    if (pixels.shaded(x, y)) ++count;
  }
  return all > 0 ? count / static_cast<double>(all) : 0.0;
}

}  // namespace cgsr::color
