// The Segway over a virtual bus and the simulated lines, held to the contracts of their interfaces.

#include <memory>
#include <utility>

#include "hal/rmp/rmp_drive.h"
#include "hal/sim/base/virtual_segway.h"
#include "hal/sim/switches/simulated_switches.h"
#include "tests/hal/case_name.h"
#include "tests/hal/drive_contract.h"
#include "tests/hal/switches_contract.h"

namespace cgsr::hal {
namespace {

DriveRig make_rmp(sim::BaseMode mode) {
  sim::BaseParameters parameters;
  parameters.mode = mode;
  auto segway = std::make_shared<sim::VirtualSegway>(parameters, sim::BasePlacement{.time = MonoTime{seconds(1000.0)}});
  DriveRig rig;
  rig.world = segway;
  rig.drive = std::make_unique<rmp::RmpDrive>(segway->host_port(), rmp::RmpParameters{});
  rig.run_to = [segway](MonoTime time) { segway->base().advance_to(time); };
  return rig;
}

SwitchesRig make_lines() {
  auto lines = std::make_unique<sim::SimulatedSwitches>(
      std::vector<sim::SwitchLine>{{"lamp_left"}, {"lamp_right"}, {"arm", true}});
  SwitchesRig rig;
  rig.level = [raw = lines.get()](std::string_view name) { return raw->level(name); };
  rig.press = [raw = lines.get()](std::string_view name, bool on) { raw->press(name, on); };
  rig.switches = std::move(lines);
  return rig;
}

INSTANTIATE_TEST_SUITE_P(Rmp, DriveContract,
                         testing::Values(DriveCase{"balancing", [] { return make_rmp(sim::BaseMode::kBalance); }},
                                         DriveCase{"tractor", [] { return make_rmp(sim::BaseMode::kTractor); }}),
                         CaseName());
INSTANTIATE_TEST_SUITE_P(Simulated, SwitchesContract, testing::Values(SwitchesCase{"lines", make_lines}), CaseName());

}  // namespace
}  // namespace cgsr::hal
