#include "hal/sim/render/truth_images.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "hal/sim/render/lens.h"
#include "hal/sim/render/pixel_rays.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Box around(const PixelRange& range) {
  if (range.right <= range.left || range.bottom <= range.top) return {};
  return {static_cast<double>(range.left), static_cast<double>(range.top),
          static_cast<double>(range.right - range.left), static_cast<double>(range.bottom - range.top)};
}

void widen(PixelRange& range, int x, int y) {
  range.left = std::min(range.left, x);
  range.top = std::min(range.top, y);
  range.right = std::max(range.right, x + 1);
  range.bottom = std::max(range.bottom, y + 1);
}

PixelRange nothing(const CameraModel& camera) {
  return {camera.width_px, camera.height_px, 0, 0};
}

// The part of the image in which any of the parts can be: the projected corners of their boxes, with a margin for the lens.
PixelRange reach_of(const Renderer& renderer, const Pose& X_WC, const std::vector<int>& parts) {
  const CameraModel& camera = renderer.camera();
  PixelRange range = nothing(camera);
  const Pose X_CW = X_WC.inverse();
  for (const int part : parts) {
    const Eigen::AlignedBox3f box = bounds(renderer.scene().parts[static_cast<std::size_t>(part)].mesh);
    const Tracer::Placement& X = renderer.tracer().placement(part);
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3f local = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner));
      const Vector3d p_C = X_CW * (X.R * local + X.p).cast<double>();
      if (p_C.z() < 0.05) return {0, 0, camera.width_px, camera.height_px};
      const Eigen::Vector2d xy = (p_C.head<2>() / p_C.z()).cwiseMax(-1.2).cwiseMin(1.2);
      const Eigen::Vector2d pixel = project(camera, xy);
      widen(range, static_cast<int>(std::floor(pixel.x())) - 4, static_cast<int>(std::floor(pixel.y())) - 4);
      widen(range, static_cast<int>(std::ceil(pixel.x())) + 4, static_cast<int>(std::ceil(pixel.y())) + 4);
    }
  }
  return {std::max(range.left, 0), std::max(range.top, 0), std::min(range.right, camera.width_px),
          std::min(range.bottom, camera.height_px)};
}

}  // namespace

FigureView figure_view(Renderer& renderer, const SceneState& state, const Pose& X_WC, int figure,
                       const std::vector<int>& parts, int lamp) {
  const Scene& scene = renderer.scene();
  std::vector<bool> counts(scene.parts.size(), false);
  std::vector<int> wanted;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const bool named = parts.empty() || std::find(parts.begin(), parts.end(), static_cast<int>(i)) != parts.end();
    counts[i] = scene.parts[i].figure == figure && named && is_present(scene.parts[i], state);
    if (counts[i]) wanted.push_back(static_cast<int>(i));
  }
  FigureView view;
  if (wanted.empty()) return view;

  const PixelRange reach = reach_of(renderer, X_WC, wanted);
  PixelRange visible = nothing(renderer.camera());
  PixelRange whole = nothing(renderer.camera());
  const Vector3f origin = X_WC.translation().cast<float>();
  std::vector<int> nearest(static_cast<std::size_t>(renderer.camera().width_px));
  for (int y = reach.top; y < reach.bottom; ++y) {
    cast_row(renderer, X_WC, reach, y, kSightRays,
             [&](const PixelRay& ray) { nearest[static_cast<std::size_t>(ray.x)] = ray.met.part; });
    cast_row(renderer, X_WC, reach, y, figure_rays(figure), [&](const PixelRay& ray) {
      if (ray.met.part < 0 || !counts[static_cast<std::size_t>(ray.met.part)]) return;
      ++view.whole_px;
      widen(whole, ray.x, ray.y);
      const int in_front = nearest[static_cast<std::size_t>(ray.x)];
      if (in_front < 0 || !counts[static_cast<std::size_t>(in_front)]) return;
      ++view.visible_px;
      widen(visible, ray.x, ray.y);
      if (lamp < 0) return;
      const LampState& light = state.lamps[static_cast<std::size_t>(lamp)];
      if (light.intensity_cd.maxCoeff() > 0.0F &&
          sees(renderer.tracer(), just_before(origin, ray), light.p_WL.cast<float>(), kShadowRays)) {
        ++view.lit_px;
      }
    });
  }
  view.in_view = view.visible_px > 0;
  view.visible = around(visible);
  view.whole = around(whole);
  return view;
}

std::vector<ProbeShadow> probe_shadows(Renderer& renderer, const SceneState& state, const Pose& X_WC, int robot,
                                       int lamp) {
  std::vector<ProbeShadow> shadows;
  const RobotBody& body = renderer.scene().robots[static_cast<std::size_t>(robot)];
  if (!body.has_board) return shadows;
  const ProbeBoard& board = body.board;
  const Pose& X_WR = state.X_WJ[static_cast<std::size_t>(body.figure)][0];
  const Vector3d p_WL = state.lamps[static_cast<std::size_t>(lamp)].p_WL;
  const Vector3d p_RL = X_WR.inverse() * p_WL;
  for (const Eigen::Vector2d& foot : board.cones_m) {
    ProbeShadow shadow;
    const Vector3d p_RA = board.p_RB + Vector3d(foot.x(), foot.y(), board.cone_height_m);
    shadow.p_WA = X_WR * p_RA;
    shadow.lamp_above = p_RL.z() > p_RA.z() + 1e-6;
    if (shadow.lamp_above) {
      const double t = (p_RL.z() - board.p_RB.z()) / (p_RL.z() - p_RA.z());
      const Vector3d p_RS = p_RL + t * (p_RA - p_RL);
      shadow.p_WS = X_WR * p_RS;
      const Vector3d on = p_RS - board.p_RB;
      shadow.on_board = std::abs(on.x()) < board.depth_m / 2 && std::abs(on.y()) < board.width_m / 2;
      const Vector3d above_apex = shadow.p_WA + 1e-3 * (p_WL - shadow.p_WA).normalized();
      shadow.unblocked = sees(renderer.tracer(), above_apex.cast<float>(), p_WL.cast<float>(), kShadowRays);
      const Vector3d p_CS = X_WC.inverse() * shadow.p_WS;
      if (p_CS.z() > 0.0) {
        shadow.at_px = project(renderer.camera(), p_CS.head<2>() / p_CS.z());
        const bool in_image = shadow.at_px.x() >= -0.5 && shadow.at_px.y() >= -0.5 &&
                              shadow.at_px.x() < renderer.camera().width_px - 0.5 &&
                              shadow.at_px.y() < renderer.camera().height_px - 0.5;
        const Vector3d near = shadow.p_WS + 1e-3 * (X_WC.translation() - shadow.p_WS).normalized();
        shadow.visible = shadow.on_board && shadow.unblocked && in_image &&
                         sees(renderer.tracer(), near.cast<float>(), X_WC.translation().cast<float>(), kSightRays);
      }
    }
    shadows.push_back(shadow);
  }
  return shadows;
}

}  // namespace cgsr::sim
