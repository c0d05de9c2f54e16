#include "pipeline/shade/shadow_volumes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "pipeline/shade/ball_in_shade.h"

namespace cgsr::shade {
namespace {

constexpr float kLikeCells = 0.6F;     // parts of a side whose uncertainty differs by less are widened alike
constexpr double kWithinACell = 0.4;   // added to what a border may be off by: a cell is marked by its middle alone
constexpr float kLeastDepth_m = 0.2F;  // what is nearer is widened as what stands here
constexpr double kCircle_px = 0.25;    // standard deviation of a ball's radius in the image,
constexpr double kBallSize = 0.01;     // and of what is known of its own, as a share of it

render::RasterParameters raster_of(const ShadeParameters& parameters) {
  render::RasterParameters raster;
  raster.width = parameters.width * parameters.finer;
  raster.height = parameters.height * parameters.finer;
  raster.near_m = parameters.near_m;
  raster.max_surfaces = parameters.max_surfaces;
  raster.max_visited = std::max(raster.max_visited, 2 * parameters.max_surfaces);
  raster.max_triangles = 8 * parameters.max_surfaces;
  raster.min_surface_cells = 0.5;
  return raster;
}

/// The bit of a cell that is to grow by so many cells (MaskGrowth::grow).
std::uint8_t growth_bit(float cells) {
  return static_cast<std::uint8_t>(1U << static_cast<unsigned>(std::lround(cells)));
}

bool same(const geometry::Camera& a, const geometry::Camera& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.fx_px == b.fx_px && a.fy_px == b.fy_px &&
         a.cx_px == b.cx_px && a.cy_px == b.cy_px && a.k1 == b.k1 && a.k2 == b.k2 && a.p1 == b.p1 && a.p2 == b.p2 &&
         a.k3 == b.k3;
}

}  // namespace

ShadowVolumes::ShadowVolumes(const world::Map& map, const ShadeParameters& parameters)
    : parameters_(parameters),
      views_(raster_of(parameters).width, raster_of(parameters).height),
      view_(&views_.of(geometry::Camera())),
      surfaces_(map, raster_of(parameters)),
      buffer_(raster_of(parameters).width, raster_of(parameters).height),
      lamps_{Silhouettes(map, parameters), Silhouettes(map, parameters)},
      growth_(parameters.width, parameters.height) {
  const auto cells = static_cast<std::size_t>(parameters.width) * static_cast<std::size_t>(parameters.height);
  rays_.resize(cells);
  ends_.resize(cells);
  sides_.resize(cells * static_cast<std::size_t>(parameters.finer * parameters.finer));
  masks_.width = parameters.width;
  masks_.height = parameters.height;
  masks_.surface_shaded.resize(cells);
  masks_.possibly_shaded.resize(cells);
  take_camera(geometry::Camera());
}

const ShadeMasks& ShadowVolumes::look(const geometry::Pose& X_WC, const geometry::Camera& camera,
                                      const Eigen::Vector3d& p_WL, int widen_cells) {
  return look(X_WC, camera, p_WL, widen_cells, nullptr);
}

const ShadeMasks& ShadowVolumes::look(const geometry::Pose& X_WC, const geometry::Camera& camera,
                                      const Eigen::Vector3d& p_WL, const ShadeErrors& errors) {
  return look(X_WC, camera, p_WL, 0, &errors);
}

const ShadeMasks& ShadowVolumes::look(const geometry::Pose& X_WC, const geometry::Camera& camera,
                                      const Eigen::Vector3d& p_WL, int widen_cells, const ShadeErrors* errors) {
  const bool same_lamp = valid_ && p_WL == p_WL_drawn_;
  const bool same_errors = (errors != nullptr) == uncertain_ &&
                           (errors == nullptr || (errors->lamp == errors_.lamp && errors->pose == errors_.pose));
  if (same_lamp && X_WC.matrix() == X_WC_.matrix() && same(camera, camera_) && widen_cells == widened_ && same_errors) {
    return masks_;
  }
  if (!same(camera, camera_)) take_camera(camera);
  UnlimitedBudget whole;
  prepare(p_WL, whole);
  valid_ = true;
  X_WC_ = X_WC;
  p_WL_drawn_ = p_WL;
  widened_ = widen_cells;
  uncertain_ = errors != nullptr;
  if (uncertain_) errors_ = *errors;
  const Eigen::Matrix3f R_WC = X_WC.linear().cast<float>();
  axes_ = {R_WC.col(0), R_WC.col(1), R_WC.col(2), X_WC.translation().cast<float>(),
           static_cast<float>(std::max(camera.fx_px * parameters_.width / camera.width_px,
                                       camera.fy_px * parameters_.height / camera.height_px))};
  from_lamp_ = axes_.p_WC - p_WL.cast<float>();
  view_ = &views_.of(camera);
  surfaces_.draw(X_WC, *view_, buffer_);
  mark_sides(p_WL.cast<float>());
  shade_surfaces();
  write_masks();
  if (widen_cells > 0) {
    growth_.grow_square(masks_.surface_shaded.data(), widen_cells);
    growth_.grow_square(masks_.possibly_shaded.data(), widen_cells);
  }
  return masks_;
}

bool ShadowVolumes::may_be_shaded(const BallInImage& ball) const {
  if (!valid_ || !(ball.radius_px > 0.0)) return true;
  return may_lie_in_shade(place_of(ball), lamps_[now_].lamp(), p_WL_.cast<float>());
}

bool ShadowVolumes::is_shaded(const BallInImage& ball) const {
  if (!valid_ || !(ball.radius_px > 0.0)) return false;
  return lies_in_shade(place_of(ball), lamps_[now_].lamp(), p_WL_.cast<float>());
}

UncertainBall ShadowVolumes::place_of(const BallInImage& ball) const {
  const Eigen::Vector2d ideal = camera_.ideal_of(ball.middle_px);
  // Beside the axis a ball shows an ellipse, longer by this factor away from the axis: the circle is between its axes.
  const double longer = std::sqrt(1.0 + ideal.squaredNorm());
  const double focal_px = 0.5 * (camera_.fx_px + camera_.fy_px);
  const double distance_m = longer * 0.5 * (1.0 + longer) * focal_px * ball.radius_m / ball.radius_px;
  const ShadeErrors errors = uncertain_ ? errors_ : ShadeErrors{};
  const auto variance = [](const Eigen::Matrix3d& covariance) { return covariance.trace() / 3.0; };
  // The lamp moves the border of a shade by no more than its own way where what throws it stands nearer to the ball than to the lamp.
  const double across_m = std::sqrt(variance(errors.lamp) + variance(errors.pose.topLeftCorner<3, 3>()) +
                                    distance_m * distance_m * variance(errors.pose.bottomRightCorner<3, 3>()) +
                                    parameters_.map_sigma_m * parameters_.map_sigma_m);
  UncertainBall uncertain;
  uncertain.along =
      (static_cast<float>(ideal.x()) * axes_.right + static_cast<float>(ideal.y()) * axes_.down + axes_.ahead)
          .normalized();
  uncertain.p_WB = axes_.p_WC + static_cast<float>(distance_m) * uncertain.along;
  uncertain.radius_m = static_cast<float>(ball.radius_m);
  uncertain.along_m =
      static_cast<float>(parameters_.ball_sigmas * distance_m * std::hypot(kBallSize, kCircle_px / ball.radius_px));
  uncertain.across_m = static_cast<float>(parameters_.ball_sigmas * across_m);
  return uncertain;
}

bool ShadowVolumes::prepare(const Eigen::Vector3d& p_WL, WorkBudget& budget) {
  if (p_WL == p_WL_) return true;
  if (p_WL != p_WL_next_) {
    p_WL_next_ = p_WL;
    lamps_[1 - now_].begin(p_WL.cast<float>());
  }
  while (budget.grant()) {
    if (!lamps_[1 - now_].work_unit()) continue;
    now_ = 1 - now_;
    p_WL_ = p_WL;
    p_WL_next_ = kNowhere;
    return true;
  }
  return false;
}

void ShadowVolumes::take_camera(const geometry::Camera& camera) {
  camera_ = camera;
  const render::View& view = views_.of(camera);
  const double px_x = static_cast<double>(camera.width_px) / parameters_.width;
  const double px_y = static_cast<double>(camera.height_px) / parameters_.height;
  std::size_t i = 0;
  for (int y = 0; y < parameters_.height; ++y) {
    for (int x = 0; x < parameters_.width; ++x, ++i) {
      const Eigen::Vector2d ideal = camera.ideal_of({(x + 0.5) * px_x - 0.5, (y + 0.5) * px_y - 0.5});
      const auto u = static_cast<float>(view.fx * ideal.x() + view.cx);
      const auto v = static_cast<float>(view.fy * ideal.y() + view.cy);
      const int left = std::clamp(static_cast<int>(u), 0, view.width - 2);
      const int top = std::clamp(static_cast<int>(v), 0, view.height - 2);
      const int column = std::clamp(static_cast<int>(std::lround(u)), 0, view.width - 1);
      const int row = std::clamp(static_cast<int>(std::lround(v)), 0, view.height - 1);
      rays_[i] = {u,
                  v,
                  static_cast<float>(ideal.x()),
                  static_cast<float>(ideal.y()),
                  static_cast<std::uint32_t>(buffer_.at(left, top)),
                  static_cast<std::uint32_t>(row * view.width + column)};
    }
  }
}

void ShadowVolumes::mark_sides(const Eigen::Vector3f& p_WL) {
  std::fill(sides_.begin(), sides_.end(), std::uint8_t{0});
  for (const Silhouettes::Side& side : lamps_[now_].sides()) draw_side(side, p_WL);
}

/// The side of a volume: from the edge away from the lamp, to where its shade has fallen on something.
void ShadowVolumes::draw_side(const Silhouettes::Side& side, const Eigen::Vector3f& p_WL) {
  const Eigen::Vector3f to_a = side.a - p_WL;
  const Eigen::Vector3f to_b = side.b - p_WL;
  const Eigen::Vector3f n = to_a.cross(to_b);
  const float size = n.norm();
  if (size < 1e-9F) return;
  render::DepthPlane plane;
  if (!surfaces_.plane_in_view(n / size, n.dot(p_WL) / size, plane)) return;
  const Strip strip{side.a, side.b, to_a, to_b};
  if (!surfaces_.may_be_in_view(strip.between(1.0F, side.reach))) return;
  draw_part(strip, plane, end_of(strip, 1.0F), end_of(strip, side.reach));
}

std::array<Eigen::Vector3f, 4> ShadowVolumes::Strip::between(float from, float to) const {
  return {a + (from - 1.0F) * to_a, b + (from - 1.0F) * to_b, b + (to - 1.0F) * to_b, a + (to - 1.0F) * to_a};
}

ShadowVolumes::PartEnd ShadowVolumes::end_of(const Strip& strip, float times) const {
  if (!uncertain_) return {times, 0.0F, 0.0F};
  const float a = moved_cells(strip.a + (times - 1.0F) * strip.to_a, times);
  const float b = moved_cells(strip.b + (times - 1.0F) * strip.to_b, times);
  return {times, std::min(a, b), std::max(a, b)};
}

/// A side between two multiples of the way to the edge, in as many parts as its uncertainty differs.
void ShadowVolumes::draw_part(const Strip& strip, const render::DepthPlane& plane, const PartEnd& from,
                              const PartEnd& to) {
  std::uint8_t bits = 1;
  if (uncertain_) {
    const float least = std::min(from.least, to.least);
    const float most = std::max(from.most, to.most);
    if (most > least + kLikeCells && to.times > 1.15F * from.times) {
      const PartEnd middle = end_of(strip, std::sqrt(from.times * to.times));
      draw_part(strip, plane, from, middle);
      draw_part(strip, plane, middle, to);
      return;
    }
    bits = growth_bit(most);
  }
  surfaces_.mark(strip.between(from.times, to.times), plane, 1.0F + static_cast<float>(parameters_.lift), buffer_, bits,
                 sides_);
}

/// By how much the border of a volume has to be widened in the image at a point that lies so many times as far from the lamp as what throws the
/// shade: for the larger of both directions of the image, in cells of the masks, at the widest what a mask may grow by.
float ShadowVolumes::moved_cells(const Eigen::Vector3f& p_W, float times) const {
  const Eigen::Vector3f arm = p_W - axes_.p_WC;
  const float depth = std::max(arm.dot(axes_.ahead), kLeastDepth_m);
  const auto variance = [&](const Eigen::Vector3f& way) {
    geometry::Vector6d J_pose;
    J_pose << way.cast<double>(), arm.cross(way).cast<double>();
    const Eigen::Vector3d J_lamp = way.cast<double>() * static_cast<double>(times - 1.0F);
    return J_pose.dot(errors_.pose * J_pose) + J_lamp.dot(errors_.lamp * J_lamp);
  };
  const double by_map = static_cast<double>(times) * parameters_.map_sigma_m;
  const double sigma_m = std::sqrt(std::max(variance(axes_.right), variance(axes_.down)) + by_map * by_map);
  const double cells = parameters_.sigmas * sigma_m * static_cast<double>(axes_.cells / depth) + kWithinACell;
  return static_cast<float>(std::clamp(cells, 0.0, static_cast<double>(parameters_.max_widening_cells)));
}

/// Every second ray of every second row is followed; what lies between rays that end alike is taken to end alike when nothing else is seen
/// there, by the camera or by the lamp. So a shadow narrower than two cells may be lost, a narrow thing is not.
void ShadowVolumes::shade_surfaces() {
  const int width = masks_.width;
  const int height = masks_.height;
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y * width + x); };
  for (int y = 0; y < height; y += 2) {
    for (int x = 0; x < width; x += 2) follow(rays_[at(x, y)], seen_at(rays_[at(x, y)]), ends_[at(x, y)]);
  }
  const auto between = [&](std::size_t cell, const End& a, const End& b) {
    const Ray& ray = rays_[cell];
    const std::uint32_t around = seen_around(ray);
    if (a.like(b) && a.triangle == around) {
      ends_[cell] = a;
    } else {
      follow(ray, around == LampView::kSeveral ? seen_at(ray) : around, ends_[cell]);
    }
  };
  for (int y = 0; y < height; y += 2) {
    for (int x = 1; x < width; x += 2) {
      between(at(x, y), ends_[at(x - 1, y)], ends_[at(std::min(x + 1, width - 1) & ~1, y)]);
    }
  }
  for (int y = 1; y < height; y += 2) {
    const int below = std::min(y + 1, height - 1) & ~1;
    for (int x = 0; x < width; ++x) between(at(x, y), ends_[at(x, y - 1)], ends_[at(x, below)]);
  }
}

void ShadowVolumes::follow(const Ray& ray, std::uint32_t triangle, End& end) const {
  end = {triangle, LampView::kSeveral, 0};
  if (triangle == render::DepthBuffer::kNothing) return;
  const std::uint32_t own = surfaces_.surface_of(triangle);
  // A sheet between lamp and camera shades itself: what is seen is its other side.
  if (lamps_[now_].in_front_of(own) != surfaces_.from_front(own)) {
    end.shaded = 255;
    end.seen = triangle;
    return;
  }
  // From the lamp to where the ray ends, times 1/Z: no division is needed.
  const float w = surfaces_.plane_of(own).at(ray.u, ray.v);
  const Eigen::Vector3f way = (w * from_lamp_ + axes_.ahead) + (ray.x * axes_.right + ray.y * axes_.down);
  const LampView::Answer answer = lamps_[now_].lamp().look_along(way, w, own);
  end.shaded = answer.hidden ? 255 : 0;
  end.seen = answer.seen;
}

void ShadowVolumes::write_masks() {
  const std::uint8_t in_shade = lamps_[now_].lamp().look_at(axes_.p_WC, world::kNone).hidden ? 1 : 0;
  std::uint8_t* const surface =
      masks_.surface_shaded.data();  // bytes may point anywhere: spare what is behind the vectors a look
  std::uint8_t* const possibly = masks_.possibly_shaded.data();
  const std::uint8_t* const sides = sides_.data();
  const End* const ends = ends_.data();
  const Ray* const rays = rays_.data();
  const std::size_t count = rays_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t some = ends[i].triangle == render::DepthBuffer::kNothing ? 0 : 255;
    surface[i] = ends[i].shaded;
    const auto marks = static_cast<std::uint8_t>(((ends[i].shaded & 1U) | in_shade | sides[rays[i].nearest]) & some);
    possibly[i] = uncertain_ ? marks : static_cast<std::uint8_t>(marks != 0 ? 255 : 0);
  }
  if (!uncertain_) return;
  mark_outlines();
  growth_.grow(possibly);
}

/// What a shaded surface grows by where an outline ends its shade: only the pose and the outline's own corners are uncertain there, so it depends
/// on depth alone, and one bit for every step of 1/Z serves all cells. Where a side ends the shade its own uncertainty is marked already.
void ShadowVolumes::mark_outlines() {
  constexpr float kStepsPerInverseMetre = 32.0F;
  std::array<std::uint8_t, 160> growth{};
  for (std::size_t i = 0; i < growth.size(); ++i) {
    const float w = (static_cast<float>(i) + 0.5F) / kStepsPerInverseMetre;
    growth[i] = growth_bit(moved_cells(axes_.p_WC + axes_.ahead / w, 1.0F));
  }
  const auto width = static_cast<std::size_t>(masks_.width);
  const std::uint8_t* const surface = masks_.surface_shaded.data();
  const std::size_t count = masks_.surface_shaded.size();
  const auto mark = [&](std::size_t i) {
    const bool inside = i >= width && i + width < count &&
                        (surface[i - 1] & surface[i + 1] & surface[i - width] & surface[i + width]) != 0;
    if (surface[i] == 0 || inside) return;
    const float w = surfaces_.plane_of(surfaces_.surface_of(ends_[i].triangle)).at(rays_[i].u, rays_[i].v);
    const auto step = std::clamp(static_cast<int>(w * kStepsPerInverseMetre), 0, static_cast<int>(growth.size()) - 1);
    masks_.possibly_shaded[i] |= growth[static_cast<std::size_t>(step)];
  };
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  const auto eight_at = [surface](std::size_t i) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, surface + i, sizeof eight);
    return eight;
  };
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    const std::uint64_t eight = eight_at(i);
    if (eight == 0) continue;
    const bool inside = eight == kAll && i >= width && i + 8 + width <= count &&
                        (eight_at(i - width) & eight_at(i + width)) == kAll && (surface[i - 1] & surface[i + 8]) != 0;
    for (std::size_t k = i; k < i + 8 && !inside; ++k) mark(k);
  }
  for (; i < count; ++i) mark(i);
}

/// The triangle in all four cells around a ray; kSeveral: there is not one.
std::uint32_t ShadowVolumes::seen_around(const Ray& ray) const {
  const auto around = buffer_.names(ray.around);
  const bool one = ((around[0] ^ around[1]) | (around[0] ^ around[2]) | (around[0] ^ around[3])) == 0;
  return one ? around[0] : LampView::kSeveral;
}

/// The first triangle along a ray: the nearest of those around that cover it.
std::uint32_t ShadowVolumes::seen_at(const Ray& ray) const {
  const auto around = buffer_.names(ray.around);
  if (((around[0] ^ around[1]) | (around[0] ^ around[2]) | (around[0] ^ around[3])) == 0) return around[0];
  std::uint32_t nearest = render::DepthBuffer::kNothing;
  float most = 0.0F;
  for (const std::uint32_t triangle : around) {
    if (triangle == render::DepthBuffer::kNothing || triangle == nearest || !surfaces_.covers(triangle, ray.u, ray.v))
      continue;
    const float w = surfaces_.plane_of(surfaces_.surface_of(triangle)).at(ray.u, ray.v);
    if (w > most) {
      most = w;
      nearest = triangle;
    }
  }
  if (nearest != render::DepthBuffer::kNothing) return nearest;
  const auto nearest_cell = static_cast<int>(ray.nearest);
  const std::uint32_t triangle = buffer_.name(nearest_cell % view_->width, nearest_cell / view_->width);
  if (triangle == render::DepthBuffer::kNothing) return triangle;
  // A cell's own triangle that ends short of the ray: its plane still has to lie before the camera there.
  const bool before = surfaces_.plane_of(surfaces_.surface_of(triangle)).at(ray.u, ray.v) > 0.0F;
  return before ? triangle : render::DepthBuffer::kNothing;
}

}  // namespace cgsr::shade
