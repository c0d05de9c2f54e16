// A factory for each kind of device, and the tables by which a robot's file chooses.
#include "src/boot/device_kinds.h"

#include <algorithm>
#include <array>
#include <utility>

#include "hal/dummy/dummy_switches.h"
#include "hal/dummy/kinematic_drive.h"
#include "hal/gpiod/gpiod_switches.h"
#include "hal/replay/replay_camera.h"
#include "hal/rmp/rmp_drive.h"
#include "hal/socketcan/can_socket.h"
#include "hal/socketcan/socketcan_bus.h"
#include "hal/v4l2/find_camera.h"
#include "hal/v4l2/v4l2_camera.h"
#include "hal/v4l2/video_device.h"
#include "src/boot/time_shifted_can_bus.h"

namespace cgsr::boot {
namespace {

template <class Device>
using Made = Result<std::unique_ptr<Device>>;

template <class Kind, class Product>
struct Factory {
  Kind kind;
  Result<Product> (*make)(const DeviceContext& context);
};

/// Every kind that a file may name has its factory, in the same order.
template <class Kind, class Product, std::size_t kFactories, std::size_t kNames>
constexpr bool complete(const std::array<Factory<Kind, Product>, kFactories>& factories,
                        const std::array<Named<Kind>, kNames>& names) {
  if (kFactories != kNames) return false;
  for (std::size_t i = 0; i < kNames; ++i) {
    if (factories[i].kind != names[i].value) return false;
  }
  return true;
}

template <class Kind, class Product, std::size_t kCount>
Result<Product> make(const std::array<Factory<Kind, Product>, kCount>& factories, Kind kind,
                     const DeviceContext& context) {
  return std::ranges::find(factories, kind, &Factory<Kind, Product>::kind)->make(context);
}

Result<OpenCamera> replay_camera(const DeviceContext& context) {
  auto camera = std::make_unique<hal::ReplayCamera>(context.config.camera.replay, &context.clock);
  auto mode = camera->start();
  if (!mode) return tl::unexpected(mode.error());
  auto notes = camera->notes();
  return OpenCamera{std::move(camera), *mode, MonoTime{}, std::move(notes)};
}

Result<OpenCamera> simulated_camera(const DeviceContext& context) {
  auto camera = context.simulation->take_camera();
  auto mode = camera->start();
  if (!mode) return tl::unexpected(mode.error());
  return OpenCamera{std::move(camera), *mode, MonoTime{context.simulation->image_delay()}, {}};
}

Result<OpenCamera> video_device(const DeviceContext& context) {
  auto camera = std::make_unique<hal::v4l2::V4l2Camera>(context.config.camera.v4l2, hal::v4l2::make_video_device(),
                                                        hal::v4l2::find_camera);
  auto mode = camera->start();
  if (!mode) return tl::unexpected(mode.error());
  auto notes = camera->notes();
  return OpenCamera{std::move(camera), *mode, MonoTime{}, std::move(notes)};
}

using OpenCameraFactory = Factory<config::CameraKind, OpenCamera>;
constexpr std::array kCameras{OpenCameraFactory{config::CameraKind::kReplay, replay_camera},
                              OpenCameraFactory{config::CameraKind::kSim, simulated_camera},
                              OpenCameraFactory{config::CameraKind::kV4l2, video_device}};
static_assert(complete(kCameras, config::kCameraKindNames));

Made<hal::CanBus> simulated_can_bus(const DeviceContext& context) {
  auto bus = context.simulation->take_can_bus();
  if (context.simulation_origin == MonoTime{}) return bus;
  return std::make_unique<TimeShiftedCanBus>(std::move(bus), context.simulation_origin);
}

Made<hal::CanBus> socketcan_bus(const DeviceContext& context) {
  return make_socketcan_bus(context.config.base.socketcan);
}

using CanBusFactory = Factory<config::CanKind, std::unique_ptr<hal::CanBus>>;
constexpr std::array kCanBuses{CanBusFactory{config::CanKind::kSim, simulated_can_bus},
                               CanBusFactory{config::CanKind::kSocketCan, socketcan_bus}};
static_assert(complete(kCanBuses, config::kCanKindNames));

Made<hal::Drive> kinematic_base(const DeviceContext& context) {
  return std::make_unique<hal::KinematicDrive>(context.config.base.kinematic);
}

Made<hal::Drive> rmp_base(const DeviceContext& context) {
  auto bus = make(kCanBuses, context.config.base.can, context);
  if (!bus) return tl::unexpected(bus.error());
  return std::make_unique<hal::rmp::RmpDrive>(std::move(*bus), context.config.base.rmp);
}

using BaseFactory = Factory<config::BaseKind, std::unique_ptr<hal::Drive>>;
constexpr std::array kBases{BaseFactory{config::BaseKind::kKinematic, kinematic_base},
                            BaseFactory{config::BaseKind::kRmp, rmp_base}};
static_assert(complete(kBases, config::kBaseKindNames));

/// The lines that the robot's file names.
Made<hal::Switches> dummy_switches(const DeviceContext& context) {
  const config::Switches& names = context.config.switches;
  std::vector<hal::DummyLine> lines;
  if (!names.arming_line.empty()) lines.push_back({names.arming_line, hal::LineDirection::kInput, false});
  for (const std::string& lamp : names.lamps()) {
    if (!lamp.empty()) lines.push_back({lamp, hal::LineDirection::kOutput, false});
  }
  return std::make_unique<hal::DummySwitches>(std::move(lines));
}

Made<hal::Switches> simulated_switches(const DeviceContext& context) {
  return context.simulation->take_switches();
}

/// The lines that the robot's file names: a line that is named twice is requested once, and check_lines says what it is.
Made<hal::Switches> gpiod_switches(const DeviceContext& context) {
  const config::Switches& named = context.config.switches;
  std::vector<hal::gpiod::LineWish> wishes;
  const auto add = [&wishes](const std::string& name, bool output, bool active_low) {
    const bool there = std::ranges::any_of(wishes, [&name](const auto& wish) { return wish.name == name; });
    if (!name.empty() && !there) wishes.push_back({name, output, active_low});
  };
  add(named.arming_line, false, named.gpiod.arming_active_low);
  for (std::size_t i = 0; i < stages::kLampLines; ++i) add(named.lamps()[i], true, named.gpiod.lamps()[i]);
  return std::make_unique<hal::gpiod::GpiodSwitches>(std::move(wishes), hal::gpiod::make_line_access(), context.clock);
}

using SwitchesFactory = Factory<config::SwitchesKind, std::unique_ptr<hal::Switches>>;
constexpr std::array kSwitches{SwitchesFactory{config::SwitchesKind::kDummy, dummy_switches},
                               SwitchesFactory{config::SwitchesKind::kSim, simulated_switches},
                               SwitchesFactory{config::SwitchesKind::kGpiod, gpiod_switches}};
static_assert(complete(kSwitches, config::kSwitchesKindNames));

}  // namespace

std::unique_ptr<hal::CanBus> make_socketcan_bus(const hal::socketcan::SocketCanParameters& parameters) {
  const std::vector<hal::socketcan::IdFilter> kRmpIds{{0x400, 0x7F8}, {0x410, 0x7F8}, {0x680, 0x7F0}};
  return std::make_unique<hal::socketcan::SocketCanBus>(parameters, kRmpIds, hal::socketcan::make_can_socket());
}

Result<OpenCamera> open_camera(const DeviceContext& context) {
  return make(kCameras, context.config.camera.kind, context);
}

Result<std::unique_ptr<hal::Drive>> make_base(const DeviceContext& context) {
  return make(kBases, context.config.base.kind, context);
}

Result<std::unique_ptr<hal::Switches>> make_switches(const DeviceContext& context) {
  return make(kSwitches, context.config.switches.kind, context);
}

}  // namespace cgsr::boot
