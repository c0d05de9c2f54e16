#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hal/sim/render/truth_images.h"
#include "hal/sim/scene/scene.h"

namespace cgsr::sim {

/// A lamp at one moment.
struct LampTruth {
  std::string name;
  Eigen::Vector3d p_WL = Eigen::Vector3d::Zero();
  Rgb intensity_cd = Rgb::Zero();  ///< zero when off.

  [[nodiscard]] bool on() const { return intensity_cd.maxCoeff() > 0.0F; }
};

/// Somebody or something that moves by script, robots apart.
struct ActorTruth {
  std::string name;
  FigureKind kind = FigureKind::kObject;
  bool present = false;
  int outfit = 0;
  Eigen::Vector3d p_WF = Eigen::Vector3d::Zero();  ///< where it stands: a point on its path.
  double heading_rad = 0.0;
  double speed_mps = 0.0;
  FigureView view;  ///< what the camera sees of it.
};

/// What is really there at one tick: the camera's pose, lamps, actors, shadows. For tests, reports and the simulator's own tools; the vision
/// never sees it (tools/check_layers.py).
struct Truth {
  double time_s = 0.0;
  Pose X_WC = Pose::Identity();
  std::optional<Pose> X_WR;         ///< of the robot that was asked for, while it is there.
  std::vector<LampTruth> lamps;     ///< [lamp], in the scene's order.
  std::vector<ActorTruth> actors;   ///< in the scene's order.
  std::vector<ProbeShadow> probes;  ///< one for each cone of the robot's board, whether the lamp is on or not.
  std::optional<ShadowMasks> masks;
};

struct TruthOptions {
  int robot = 0;       ///< whose pose and probes; -1: nobody's.
  int lamp = 0;        ///< whose light the probes, the masks and `lit_px` mean; -1 or a lamp that is off: nobody's.
  bool masks = false;  ///< both masks of shaded regions: seconds for a large image.
  ShadowMaskOptions mask;
};

/// Asks the scene at `state`, seen from X_WC. Nothing need have been drawn before, so a cached image has its truth too.
///
/// The same bytes on any number of threads. Cost without masks: two rays for every pixel of the actors' surroundings.
Truth truth_at(Renderer& renderer, const SceneState& state, const Pose& X_WC, const TruthOptions& options = {});

/// How many cones stand on the robot's board; 0 for a robot without one or of which there is none.
int cone_count(const Scene& scene, int robot);

/// Truth as a table for people, a row for each tick; columns are named after the scene's lamps, actors and cones. Poses are positions in
/// metres and unit quaternions, angles in degrees, boxes `left, top, width, height` in pixels; flags are 0 or 1; what is not there is empty.
std::string truth_csv_header(const Scene& scene, const TruthOptions& options = {});
std::string truth_csv_row(int image, const Truth& truth);

}  // namespace cgsr::sim
