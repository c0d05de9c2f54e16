#include "tools/lab/localization/standpoints.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

#include "hal/sim/render/lens.h"
#include "hal/sim/render/pixel_rays.h"
#include "hal/sim/scene/map_count.h"

namespace cgsr::lab {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kRad = std::numbers::pi / 180.0;
constexpr float kAir_m = 0.35F;
constexpr float kOffSurface_m = 0.004F;
constexpr double kNear_m = 0.05;
constexpr double kStep_px = 2.0;
constexpr int kDraws = 2000;
constexpr double kSameLine_m = 1e-3;

using Key = std::array<std::int64_t, 3>;

Key key_of(const Vector3f& p) {
  Key key{};
  for (int i = 0; i < 3; ++i) {
    key[static_cast<std::size_t>(i)] = std::llround((static_cast<double>(p[i]) + 0.31e-4) / 1e-4);
  }
  return key;
}

/// An outline's edge on its way: with what normal, and whether it is no edge after all since its plane goes on in the same material.
struct Candidate {
  std::array<Vector3f, 2> ends;
  Vector3f normal;
  int material = 0;
  bool seam = false;
};

double distance_to(const std::array<Vector3f, 2>& edge, const Vector3f& p) {
  const Vector3f along = edge[1] - edge[0];
  const float t = std::clamp((p - edge[0]).dot(along) / along.squaredNorm(), 0.0F, 1.0F);
  return static_cast<double>((edge[0] + t * along - p).norm());
}

/// Where a wall stands on a floor both end: that is one edge. Of those that lie on one line only what is not part of a longer one is kept.
std::vector<std::array<Vector3f, 2>> each_once(const std::vector<std::array<Vector3f, 2>>& edges) {
  const auto length = [](const std::array<Vector3f, 2>& edge) { return (edge[1] - edge[0]).norm(); };
  std::vector<std::array<Vector3f, 2>> longest_first = edges;
  std::stable_sort(longest_first.begin(), longest_first.end(),
                   [&](const auto& a, const auto& b) { return length(a) > length(b); });
  std::vector<std::array<Vector3f, 2>> kept;
  for (const auto& edge : longest_first) {
    const bool part = std::any_of(kept.begin(), kept.end(), [&](const auto& longer) {
      return distance_to(longer, edge[0]) < kSameLine_m && distance_to(longer, edge[1]) < kSameLine_m;
    });
    if (!part) kept.push_back(edge);
  }
  return kept;
}

}  // namespace

TrueEdges::TrueEdges(const sim::Scene& scene) {
  std::map<std::pair<Key, Key>, Candidate> found;
  for (const sim::Part& part : scene.parts) {
    if (part.figure >= 0 || !part.in_map || part.mesh.smooth) continue;
    for (const auto& outline : part.mesh.polygons) {
      const auto corner = [&](std::size_t i) { return part.mesh.position_m[outline[i % outline.size()]]; };
      const Vector3f normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
      for (std::size_t i = 0; i < outline.size(); ++i) {
        Key a = key_of(corner(i));
        Key b = key_of(corner(i + 1));
        if (a == b) continue;
        if (b < a) std::swap(a, b);
        const auto [at, fresh] =
            found.try_emplace({a, b}, Candidate{{corner(i), corner(i + 1)}, normal, part.material, false});
        if (!fresh && at->second.material == part.material && normal.dot(at->second.normal) > 0.9999F) {
          at->second.seam = true;
        }
      }
    }
  }
  for (const auto& [keys, candidate] : found) {
    if (!candidate.seam) edges_.push_back(candidate.ends);
  }
  edges_ = each_once(edges_);
}

int TrueEdges::seen(Place& place, const geometry::Pose& X_WC, double min_px) const {
  const sim::Tracer& tracer = place.renderer().tracer();
  const sim::CameraModel& camera = place.camera();
  const geometry::Pose X_CW = X_WC.inverse();
  const Vector3f eye = X_WC.translation().cast<float>();
  const auto pixel_of = [&](const Vector3d& p_C) -> Vector2d {
    return sim::project(camera, {p_C.x() / p_C.z(), p_C.y() / p_C.z()});
  };
  int count = 0;
  for (const auto& ends : edges_) {
    Vector3d a = X_CW * ends[0].cast<double>();
    Vector3d b = X_CW * ends[1].cast<double>();
    if (a.z() < kNear_m && b.z() < kNear_m) continue;
    if (a.z() < kNear_m) a += (b - a) * ((kNear_m - a.z()) / (b.z() - a.z()));
    if (b.z() < kNear_m) b += (a - b) * ((kNear_m - b.z()) / (a.z() - b.z()));
    // Far outside of the image the lens model means nothing: keep to what lies within half an image of it.
    const double reach_x = 0.75 * camera.width_px / camera.fx_px;
    const double reach_y = 0.75 * camera.height_px / camera.fy_px;
    const int steps = std::clamp(static_cast<int>((pixel_of(a) - pixel_of(b)).norm() / kStep_px), 8, 640);
    double run_px = 0.0;
    double longest_px = 0.0;
    Vector2d last = Vector2d::Zero();
    bool was_visible = false;
    for (int i = 0; i <= steps; ++i) {
      // Even in the image: the depth's inverse is what runs linearly.
      const double s = static_cast<double>(i) / steps;
      const double t = s * a.z() / (s * a.z() + (1.0 - s) * b.z());
      const Vector3d p = a + t * (b - a);
      const bool near = std::abs(p.x()) < reach_x * p.z() && std::abs(p.y()) < reach_y * p.z();
      const Vector2d at = near ? pixel_of(p) : Vector2d(-1.0, -1.0);
      bool visible =
          at.x() >= 2.0 && at.y() >= 2.0 && at.x() <= camera.width_px - 3.0 && at.y() <= camera.height_px - 3.0;
      if (visible) {
        const Vector3f p_W = (X_WC * p).cast<float>();
        const Vector3f from = p_W + (eye - p_W).normalized() * kOffSurface_m;
        visible = sim::sees(tracer, from, eye, sim::kSightRays);
      }
      if (visible && was_visible) run_px += (at - last).norm();
      if (!visible) run_px = 0.0;
      longest_px = std::max(longest_px, run_px);
      last = at;
      was_visible = visible;
    }
    if (longest_px >= min_px) ++count;
  }
  return count;
}

Area area_of(std::string_view world) {
  if (world == "spl-field") return {-5.0, 5.0, -3.5, 3.5};
  if (world == "planar") return {-1.0, 8.0, -4.0, 4.0};
  if (world == "occlusion") return {0.4, 5.4, -2.1, 2.1};
  if (world == "corridor") return {-1.0, 13.0, -0.9, 0.9};
  if (world == "people") return {0.4, 7.6, -3.1, 3.1};
  return {0.4, 8.6, 0.4, 6.1};  // home
}

std::optional<Standpoint> draw_standpoint(Place& place, const TrueEdges& edges, const Area& area, const View& view,
                                          Random& random) {
  const sim::Tracer& tracer = place.renderer().tracer();
  for (int draw = 0; draw < kDraws; ++draw) {
    const double x = random.uniform(area.left_m, area.right_m);
    const double y = random.uniform(area.near_m, area.far_m);
    const double heading = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double roll = random.normal() * kRad;
    const double pitch = random.normal() * kRad;
    Standpoint at;
    at.X_WR = geometry::pose_on_floor(x, y, heading);
    at.X_WC = at.X_WR * place.X_RC();
    // The base tilts about its wheels; what matters to the camera is its direction.
    at.X_WC.linear() = geometry::rotation_of(at.X_WR.linear() * Vector3d(roll, pitch, 0.0)) * at.X_WC.linear();
    at.X_WR = at.X_WC * place.X_RC().inverse();
    bool free = true;
    const Vector3f eye = at.X_WC.translation().cast<float>();
    for (const float below : {0.0F, 0.5F, 0.9F}) {
      const Vector3f mast = eye - Vector3f(0.0F, 0.0F, std::min(below, eye.z() - 0.1F));
      for (int i = 0; i < 12 && free; ++i) {
        const float angle = static_cast<float>(i) * std::numbers::pi_v<float> / 6.0F;
        free =
            sim::sees(tracer, mast + kAir_m * Vector3f(std::cos(angle), std::sin(angle), 0.0F), mast, sim::kSightRays);
      }
    }
    if (!free) continue;
    at.edges = edges.seen(place, at.X_WC);
    if (at.edges >= view.min_edges && at.edges <= view.most_edges) return at;
  }
  return std::nullopt;
}

geometry::Vector6d draw_prior_error(double scale, Random& random) {
  geometry::Vector6d error = geometry::Vector6d::Zero();
  error[0] = random.normal() * 0.15;
  error[1] = random.normal() * 0.15;
  error[3] = random.normal() * kRad;
  error[4] = random.normal() * kRad;
  error[5] = random.normal() * 4.0 * kRad;
  return error * scale;
}

geometry::Pose believed(const geometry::Pose& X_WC, const geometry::Vector6d& error, const geometry::Pose& X_RC,
                        const geometry::Pose& X_RC_told) {
  geometry::Pose X = geometry::moved(X_WC, error);
  const geometry::Pose X_CC = X_RC.inverse() * X_RC_told;
  return X * X_CC;
}

}  // namespace cgsr::lab
