#include "src/boot/robot_plan.h"

#include <functional>
#include <utility>

namespace cgsr::boot {

void add_robot_steps(BootPlan& plan, RobotState& state) {
  const auto add = [&](const char* name, std::vector<std::string> needs, Result<void> (*step)(RobotState&),
                       std::function<void()> undo = {}) {
    plan.add({name, std::move(needs), [&state, step] { return step(state); }, std::move(undo)});
  };
  // Work that cannot be interrupted and may take seconds: a map, a plug-in. A first image is waited for in order.
  const auto load = [&](const char* name, std::vector<std::string> needs, Result<void> (*step)(RobotState&)) {
    const auto run = [&state, step] {
      state.loading.emplace(kInterruptedWhileLoading);
      auto done = step(state);
      state.loading.reset();
      return done;
    };
    plan.add({name, std::move(needs), run});
  };
  // A device needs the simulated home only where it is part of it: what is wrong with the others is found all the same.
  const auto home_if = [](bool simulated) {
    return simulated ? std::vector<std::string>{"simulation"} : std::vector<std::string>{};
  };
  const config::Robot& config = state.setup.config;
  load("simulation", {}, open_simulation);
  add("camera", home_if(config.simulated_camera()), start_camera, [&state] { state.devices.camera->stop(); });
  // What is only read comes first: `cgsr check` finds what is wrong with it whether or not there is a camera.
  load("model", {}, load_model);
  load("map", {}, load_map);
  load("calibration", {}, read_calibration);
  load("optics", {"camera", "calibration"}, fit_calibration);
  load("object", {"optics", "model"}, make_object);
  load("localization", {"optics", "map"}, make_localization);
  load("light", {"optics", "localization"}, make_light);
  load("people", {}, load_people);
  load("identification", {"people"}, make_people);
  load("task", {"localization", "identification"}, make_task);
  load("loop", {"camera"}, make_loop);
  add("outputs", {"loop"}, open_outputs);
  add("base", home_if(config.simulated_base()), start_base, [&state] { state.devices.base->stop(); });
  add("switches", home_if(config.simulated_switches()), start_switches, [&state] { state.devices.switches->stop(); });
}

}  // namespace cgsr::boot
