#include "hal/sim/truth.h"

#include <cstddef>

namespace cgsr::sim {
namespace {

std::vector<LampTruth> lamps_of(const Scene& scene, const SceneState& state) {
  std::vector<LampTruth> lamps;
  lamps.reserve(scene.lamps.size());
  for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
    lamps.push_back({scene.lamps[i].name, state.lamps[i].p_WL, state.lamps[i].intensity_cd});
  }
  return lamps;
}

ActorTruth actor_of(Renderer& renderer, const SceneState& state, const Pose& X_WC, std::size_t figure, int lamp) {
  const Figure& script = renderer.scene().figures[figure];
  const PathPoint at = script.path.at(state.time_s);
  ActorTruth actor;
  actor.name = script.name;
  actor.kind = script.kind;
  actor.present = state.presence[figure].present;
  actor.outfit = state.presence[figure].outfit;
  actor.p_WF = at.p_W;
  actor.heading_rad = at.heading_rad;
  actor.speed_mps = at.speed_mps;
  actor.view = figure_view(renderer, state, X_WC, static_cast<int>(figure), {}, lamp);
  return actor;
}

}  // namespace

int cone_count(const Scene& scene, int robot) {
  if (robot < 0 || robot >= static_cast<int>(scene.robots.size())) return 0;
  const RobotBody& body = scene.robots[static_cast<std::size_t>(robot)];
  return body.has_board ? static_cast<int>(body.board.cones_m.size()) : 0;
}

Truth truth_at(Renderer& renderer, const SceneState& state, const Pose& X_WC, const TruthOptions& options) {
  renderer.move_to(state);
  const Scene& scene = renderer.scene();
  Truth truth;
  truth.time_s = state.time_s;
  truth.X_WC = X_WC;
  truth.lamps = lamps_of(scene, state);
  const bool lamp_there = options.lamp >= 0 && options.lamp < static_cast<int>(scene.lamps.size()) &&
                          truth.lamps[static_cast<std::size_t>(options.lamp)].on();
  const int lamp = lamp_there ? options.lamp : -1;
  for (std::size_t i = 0; i < scene.figures.size(); ++i) {
    if (scene.figures[i].kind == FigureKind::kRobot) continue;
    truth.actors.push_back(actor_of(renderer, state, X_WC, i, lamp));
  }
  if (options.robot >= 0 && options.robot < static_cast<int>(scene.robots.size())) {
    const auto figure = static_cast<std::size_t>(scene.robots[static_cast<std::size_t>(options.robot)].figure);
    if (state.presence[figure].present) truth.X_WR = state.X_WJ[figure][0];
  }
  if (truth.X_WR && lamp_there) truth.probes = probe_shadows(renderer, state, X_WC, options.robot, lamp);
  truth.probes.resize(static_cast<std::size_t>(cone_count(scene, options.robot)));
  if (options.masks && lamp_there) truth.masks = shadow_masks(renderer, state, X_WC, lamp, options.mask);
  return truth;
}

}  // namespace cgsr::sim
