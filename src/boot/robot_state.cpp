#include "src/boot/robot_state.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace cgsr::boot {

Devices::~Devices() {
  if (base) base->stop();
  if (switches) switches->stop();
  if (camera) camera->stop();
}

Result<ImageLease> RobotState::first_image() {
  auto image = devices.camera->next_image(setup.live() ? clocks.real.now() + seconds(5.0) : devices.next_due);
  if (!image) return fail(fmt::format("no first image: {}", devices.camera->last_problem()));
  devices.next_due += devices.mode.frame_period;
  return std::move(*image);
}

tasks::VisionSurroundings RobotState::surroundings() const {
  std::array<bool, stages::kLampLines> lamps{};
  std::ranges::transform(setup.config.switches.lamps(), lamps.begin(), [](const auto& name) { return !name.empty(); });
  return {stages::OdometryTrack(setup.config.odometry),
          stages::Switchboard(lamps, devices.mode.frame_period, seconds(setup.config.switches.answer_timeout_s))};
}

}  // namespace cgsr::boot
