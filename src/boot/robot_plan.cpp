#include "src/boot/robot_plan.h"

#include <functional>
#include <utility>

namespace cgsr::boot {

void add_robot_steps(BootPlan& plan, RobotState& state) {
  const auto add = [&](const char* name, std::vector<std::string> needs, Result<void> (*step)(RobotState&),
                       std::function<void()> undo = {}) {
    plan.add({name, std::move(needs), [&state, step] { return step(state); }, std::move(undo)});
  };
  // A device needs the simulated home only where it is part of it: what is wrong with the others is found all the same.
  const auto home_if = [](bool simulated) {
    return simulated ? std::vector<std::string>{"simulation"} : std::vector<std::string>{};
  };
  const config::Robot& config = state.setup.config;
  add("simulation", {}, open_simulation);
  add("camera", home_if(config.simulated_camera()), start_camera, [&state] { state.devices.camera->stop(); });
  // What is only read comes first: `cgsr check` finds what is wrong with it whether or not there is a camera.
  add("model", {}, load_model);
  add("map", {}, load_map);
  add("calibration", {}, read_calibration);
  add("optics", {"camera", "calibration"}, fit_calibration);
  add("object", {"optics", "model"}, make_object);
  add("localization", {"optics", "map"}, make_localization);
  add("light", {"optics", "localization"}, make_light);
  add("task", {"localization"}, make_task);
  add("loop", {"camera"}, make_loop);
  add("outputs", {"loop"}, open_outputs);
  add("base", home_if(config.simulated_base()), start_base, [&state] { state.devices.base->stop(); });
  add("switches", home_if(config.simulated_switches()), start_switches, [&state] { state.devices.switches->stop(); });
}

}  // namespace cgsr::boot
