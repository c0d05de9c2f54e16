#include "tools/sim/render_world.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/imgproc.hpp>

#include "hal/sim/render/photographer.h"
#include "tools/sim/truth_pictures.h"
#include "tools/sim/world_file.h"

namespace cgsr::sim {
namespace {

// Room lamps burn unless told otherwise; what robots carry does not.
Result<SwitchStates> lines(const Scene& scene, const PictureRequest& request) {
  SwitchStates states;
  for (const Lamp& lamp : scene.lamps) {
    if (!lamp.switch_name.empty()) states[lamp.switch_name] = lamp.carried_by < 0;
  }
  for (const auto& [names, on] : {std::pair(&request.on, true), std::pair(&request.off, false)}) {
    for (const std::string& name : *names) {
      const auto line = states.find(name);
      if (line == states.end()) {
        std::vector<std::string> there;
        for (const auto& [other, state] : states) there.push_back("'" + other + "'");
        return fail(fmt::format("no lamp is switched by a line '{}'; there {}", name,
                                there.empty() ? "is none" : fmt::format("are {}", fmt::join(there, ", "))));
      }
      line->second = on;
    }
  }
  return states;
}

/// \param figure  of the robot whose view it is; -1: nobody's.  \return an error where a lamp is on whose robot is not in the picture.
Result<void> check_carried_lamps(const Scene& scene, const SwitchStates& switches, int figure) {
  for (const Lamp& lamp : scene.lamps) {
    if (lamp.carried_by < 0 || lamp.carried_by == figure || lamp.switch_name.empty()) continue;
    if (!switches.at(lamp.switch_name)) continue;
    return fail(
        fmt::format("the lamp of line '{0}' is carried by '{1}', which is not in this picture: --robot {1}, without "
                    "another place for the camera, is its view",
                    lamp.switch_name, scene.figures[static_cast<std::size_t>(lamp.carried_by)].name));
  }
  return {};
}

Result<const World::View*> find_view(const World& world, const std::string& name) {
  std::vector<std::string> names;
  for (const World::View& view : world.views) {
    if (view.name == name) return &view;
    names.push_back("'" + view.name + "'");
  }
  return fail(fmt::format("the world '{}' has no view '{}'; it has {}", world.scene.name, name,
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace

Result<Take> compose(const World& world, const PictureRequest& request) {
  const auto switches = lines(world.scene, request);
  if (!switches) return tl::unexpected(switches.error());
  const auto robot = find_robot(world, request.robot);
  if (!robot) return tl::unexpected(robot.error());
  Take take;
  take.sensor = world.sensor;
  take.sensor.noise = request.noise;
  const RobotBody& body = world.scene.robots[static_cast<std::size_t>(*robot)];
  take.camera = request.size ? body.camera.scaled_to(request.size->width_px, request.size->height_px) : body.camera;
  if (!request.lens) take.camera = take.camera.without_distortion();

  double at_s = request.at_s.value_or(0.0);
  if (request.X_WC) {
    take.moment.X_WC = *request.X_WC;
  } else if (!request.view.empty()) {
    const auto view = find_view(world, request.view);
    if (!view) return tl::unexpected(view.error());
    take.moment.X_WC = (*view)->X_WC;
    at_s = request.at_s.value_or((*view)->at_s);
  } else {
    take.robot = *robot;
  }
  const auto lit = check_carried_lamps(world.scene, *switches, take.robot < 0 ? -1 : body.figure);
  if (!lit) return tl::unexpected(lit.error());
  // A robot sees itself, not the others of the file, which start where it does.
  const std::vector<Pose> X_WR = take.robot < 0 ? std::vector<Pose>{} : scripted_robots(world, at_s);
  take.moment.state = state_at(world.scene, at_s, *switches, X_WR);
  if (take.robot < 0) return take;
  for (const RobotBody& other : world.scene.robots) {
    take.moment.state.presence[static_cast<std::size_t>(other.figure)].present = other.figure == body.figure;
  }
  take.moment.X_WC = X_WR[static_cast<std::size_t>(take.robot)] * mount_of(body);
  return take;
}

Result<void> render_world(const World& world, const PictureRequest& request, const PictureFiles& files) {
  if (auto good = check_picture_path(files.output); !good) return good;
  const auto take = compose(world, request);
  if (!take) return tl::unexpected(take.error());
  const auto lamp = find_lamp(world, files.lamp);
  if (!lamp) return tl::unexpected(lamp.error());
  auto photographer = Photographer::make(world.scene, take->camera, {request.threads, request.edge_samples});
  if (!photographer) return tl::unexpected(photographer.error());

  cv::Mat yuyv(take->camera.height_px, take->camera.width_px, CV_8UC2);
  (*photographer)
      ->take({take->moment}, take->sensor, {request.seed, 0},
             {yuyv.data, yuyv.cols, yuyv.rows, static_cast<std::ptrdiff_t>(yuyv.step)});
  if (auto written = write_picture(files.output, as_bgr(yuyv)); !written || files.truth_folder.empty()) return written;
  Renderer& renderer = (*photographer)->renderer();
  const Truth truth = truth_at(renderer, take->moment.state, take->moment.X_WC, {take->robot, *lamp, true, {}});
  return write_truth_pictures(renderer, truth, {take->robot, *lamp, true, {}}, files.truth_folder);
}

}  // namespace cgsr::sim
