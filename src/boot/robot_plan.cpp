#include "src/boot/robot_plan.h"

#include <functional>
#include <utility>

namespace cgsr::boot {

void add_robot_steps(BootPlan& plan, RobotState& state) {
  const auto add = [&](const char* name, std::vector<std::string> needs, Result<void> (*step)(RobotState&),
                       std::function<void()> undo = {}) {
    plan.add({name, std::move(needs), [&state, step] { return step(state); }, std::move(undo)});
  };
  add("simulation", {}, open_simulation);
  add("camera", {"simulation"}, open_camera, [&state] { state.devices.camera->stop(); });
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
  add("base", {"simulation"}, open_base, [&state] { state.devices.base->stop(); });
  add("switches", {"simulation"}, open_switches, [&state] { state.devices.switches->stop(); });
}

}  // namespace cgsr::boot
