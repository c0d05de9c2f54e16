#include "hal/sim/scene/scene.h"

#include <cmath>
#include <cstddef>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

bool is_on(const Lamp& lamp, const SwitchStates& switches) {
  if (lamp.switch_name.empty()) return lamp.on;
  const auto line = switches.find(lamp.switch_name);
  return line != switches.end() && line->second;
}

// Candela of a source that shines equally everywhere: lumens / 4 pi.
Rgb intensity(const Lamp& lamp, double time_s) {
  const float brightest = lamp.color.maxCoeff();
  const auto candela = static_cast<float>(lamp.lumens / (4.0 * kPi));
  return lamp.color.cwiseProduct(factor_at(lamp.script, time_s)) * (candela / brightest);
}

/// Where somebody on a path stands who keeps a distance from the robot: sideways of the path, so that both pass each other.
Eigen::Vector3d stepped_aside(const PathPoint& point, const Eigen::Vector3d& p_WR, double keeps_m) {
  const double c = cosine(point.heading_rad);
  const double s = sine(point.heading_rad);
  const Eigen::Vector3d to_robot = p_WR - point.p_W;
  const double ahead_m = c * to_robot.x() + s * to_robot.y();
  const double left_m = c * to_robot.y() - s * to_robot.x();
  if (ahead_m * ahead_m + left_m * left_m >= keeps_m * keeps_m) return point.p_W;
  const double beside_m = std::sqrt(keeps_m * keeps_m - ahead_m * ahead_m);
  const double to_left_m = left_m < -keeps_m / 3.0 ? left_m + beside_m : left_m - beside_m;
  return point.p_W + to_left_m * Eigen::Vector3d(-s, c, 0.0);
}

}  // namespace

int Scene::add_material(Material material) {
  materials.push_back(std::move(material));
  return static_cast<int>(materials.size()) - 1;
}

Part& Scene::add_static(std::string part_name, Mesh mesh, int material, const Pose& X_WP) {
  mesh.transform(X_WP);
  Part part;
  part.name = std::move(part_name);
  part.mesh = std::move(mesh);
  part.material = material;
  parts.push_back(std::move(part));
  return parts.back();
}

SceneState state_at(const Scene& scene, double time_s, const SwitchStates& switches, const std::vector<Pose>& X_WR) {
  SceneState state;
  state.time_s = time_s;
  for (const Figure& figure : scene.figures) {
    const PathPoint point = figure.path.at(time_s);
    PresenceKey presence = presence_at(figure.presence, time_s);
    if (figure.kind == FigureKind::kRobot) presence.present = false;
    state.X_WJ.push_back(pose_joints(figure, pose_on_path(point), time_s, point.walked_m, point.speed_mps));
    state.presence.push_back(presence);
  }
  for (std::size_t i = 0; i < scene.robots.size() && i < X_WR.size(); ++i) {
    const auto figure = static_cast<std::size_t>(scene.robots[i].figure);
    state.X_WJ[figure] = pose_joints(scene.figures[figure], X_WR[i], time_s, 0.0, 0.0);
    state.presence[figure].present = true;
  }
  state.ambient_lux = scene.ambient.illuminance_lux.cwiseProduct(factor_at(scene.ambient.script, time_s));
  for (const Lamp& lamp : scene.lamps) {
    LampState now;
    now.p_WL = lamp.p_WL;
    bool there = true;
    if (lamp.carried_by >= 0) {
      const auto carrier = static_cast<std::size_t>(lamp.carried_by);
      now.p_WL = state.X_WJ[carrier][0] * lamp.p_WL;
      there = state.presence[carrier].present;
    }
    if (there && is_on(lamp, switches)) {
      now.intensity_cd = intensity(lamp, time_s);
      state.ambient_lux += now.intensity_cd * static_cast<float>(4.0 * kPi * lamp.bounce);
    }
    state.lamps.push_back(now);
  }
  return state;
}

void heed_robot(const Scene& scene, const Pose& X_WR, SceneState& state) {
  for (std::size_t i = 0; i < scene.figures.size(); ++i) {
    const Figure& figure = scene.figures[i];
    if (!figure.watches_robot && figure.makes_way_m == 0.0) continue;
    PathPoint point = figure.path.at(state.time_s);
    point.p_W = stepped_aside(point, X_WR.translation(), figure.makes_way_m);
    const Eigen::Vector3d way = X_WR.translation() - point.p_W;
    if (figure.watches_robot) point.heading_rad = arc_tangent(way.y(), way.x());
    state.X_WJ[i] = pose_joints(figure, pose_on_path(point), state.time_s, point.walked_m, point.speed_mps);
  }
}

bool is_present(const Part& part, const SceneState& state) {
  if (part.figure < 0) return true;
  const PresenceKey& presence = state.presence[static_cast<std::size_t>(part.figure)];
  return presence.present && (part.outfit < 0 || part.outfit == presence.outfit);
}

Pose pose_at(const Eigen::Vector3d& p_W, double heading_rad) {
  return pose_on_path({p_W, heading_rad, 0.0, 0.0});
}

Pose look_at(const Eigen::Vector3d& p_W, const Eigen::Vector3d& p_WQ) {
  const Eigen::Vector3d forward = (p_WQ - p_W).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Pose X_WC = Pose::Identity();
  X_WC.translation() = p_W;
  X_WC.linear().col(0) = right;
  X_WC.linear().col(1) = forward.cross(right);
  X_WC.linear().col(2) = forward;
  return X_WC;
}

}  // namespace cgsr::sim
