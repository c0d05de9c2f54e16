#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "hal/sim/scene/figure.h"
#include "hal/sim/scene/lamp.h"
#include "hal/sim/scene/material.h"
#include "hal/sim/scene/mesh.h"
#include "hal/sim/scene/robot.h"

namespace cgsr::sim {

/// One rigid piece with one material. Its index in the scene is its identity in truth images.
struct Part {
  std::string name;
  Mesh mesh;  ///< in W when static, else in its joint's frame.
  int material = 0;
  int figure = -1;           ///< -1: static.
  int joint = 0;             ///< of the figure.
  int outfit = -1;           ///< worn only in this outfit of the figure; -1: always.
  bool casts_shadow = true;  ///< false for tape and paint lying on something, and for glowing lamps.
  int lamp = -1;             ///< glows as this lamp does; -1: by its material.
  bool in_map = true;        ///< a static part that the robot's map holds.
};

/// Everything that does not depend on time.
struct Scene {
  std::string name;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Part> parts;
  std::vector<Figure> figures;
  std::vector<RobotBody> robots;
  std::vector<Lamp> lamps;
  Ambient ambient;

  int add_material(Material material);
  /// Adds a static part, moved to `X_WP`.
  Part& add_static(std::string part_name, Mesh mesh, int material, const Pose& X_WP = Pose::Identity());
};

/// Which named lines are on. A line that is not named is off.
using SwitchStates = std::map<std::string, bool, std::less<>>;

struct LampState {
  Eigen::Vector3d p_WL = Eigen::Vector3d::Zero();
  Rgb intensity_cd = Rgb::Zero();  ///< zero when off.
};

/// The scene at one moment.
struct SceneState {
  double time_s = 0.0;
  std::vector<std::vector<Pose>> X_WJ;  ///< [figure][joint]
  std::vector<PresenceKey> presence;    ///< [figure]
  std::vector<LampState> lamps;         ///< [lamp]
  Rgb ambient_lux = Rgb::Zero();        ///< with what comes back from walls of the lamps that are on.
};

/// \param X_WR  the poses of the robots, in the order of `scene.robots`; robots without one are absent.
SceneState state_at(const Scene& scene, double time_s, const SwitchStates& switches = {},
                    const std::vector<Pose>& X_WR = {});

/// Turns whoever watches the robot (Figure::watches_robot) towards it, and puts whoever makes way for it (Figure::makes_way_m) aside, to its
/// own right; to its left where the robot is on its right.
void heed_robot(const Scene& scene, const Pose& X_WR, SceneState& state);

/// Is the part there at that moment?
bool is_present(const Part& part, const SceneState& state);

/// A pose at p_W, turned by `heading_rad` about z.
Pose pose_at(const Eigen::Vector3d& p_W, double heading_rad = 0.0);

/// The pose of a camera at p_W that looks at p_WQ with its image upright; they may not lie above each other.
Pose look_at(const Eigen::Vector3d& p_W, const Eigen::Vector3d& p_WQ);

}  // namespace cgsr::sim
