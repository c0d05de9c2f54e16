#include "src/boot/robot_state.h"

#include <algorithm>
#include <array>
#include <utility>

#include "src/boot/device_wait.h"
#include "src/boot/first_image.h"

namespace cgsr::boot {
namespace {

constexpr int kTriesInLockStep = 30;
constexpr Duration kPatience = seconds(5.0);
constexpr Duration kPatienceOfOneLook = seconds(0.1);  // in which a stop signal is noticed
constexpr Duration kPatienceOfOneTry = seconds(1.0);   // of a service: the watchdog is pinged between them

}  // namespace

Devices::~Devices() {
  if (base) base->stop();
  if (switches) switches->stop();
  if (camera) camera->stop();
}

Result<ImageLease> RobotState::first_image() {
  hal::Camera& camera = *devices.camera;
  if (!setup.live()) {
    return first_good_image(camera, [this, tries = kTriesInLockStep]() mutable -> std::optional<MonoTime> {
      if (tries-- == 0) return std::nullopt;
      return std::exchange(devices.next_due, devices.next_due + devices.mode.frame_period);
    });
  }
  const auto wait_for_image = [&](Duration patience) {
    const MonoTime end = clocks.real.now() + patience;
    return first_good_image(camera, [&, end]() -> std::optional<MonoTime> {
      const MonoTime now = clocks.real.now();
      if (now >= end || StopOnSignals::received() != 0) return std::nullopt;
      return std::min(end, now + kPatienceOfOneLook);
    });
  };
  // The camera streams and is to be stopped in order: a signal ends the wait, not the process.
  const bool was_loading = loading.has_value();
  loading.reset();
  StopRequest* const waits = setup.options.wait_for_devices;
  auto image =
      waits == nullptr || !setup.config.real_camera()
          ? wait_for_image(kPatience)
          : open_when_there("first image", clocks.real, *waits, [&] { return wait_for_image(kPatienceOfOneTry); });
  if (StopOnSignals::received() != 0) return fail("the first image was waited for when a signal came");
  if (was_loading) loading.emplace(kInterruptedWhileLoading);
  return image;
}

tasks::VisionSurroundings RobotState::surroundings() const {
  std::array<bool, stages::kLampLines> lamps{};
  std::ranges::transform(setup.config.switches.lamps(), lamps.begin(), [](const auto& name) { return !name.empty(); });
  return {stages::OdometryTrack(setup.config.odometry),
          stages::Switchboard(lamps, devices.mode.frame_period, seconds(setup.config.switches.answer_timeout_s))};
}

}  // namespace cgsr::boot
