// The CAN buses, held to the contract of their interface; and the Segway's driver over a socket, held to that of a base.

#include <net/if.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include "hal/rmp/rmp_drive.h"
#include "hal/sim/base/virtual_segway.h"
#include "hal/socketcan/socketcan_bus.h"
#include "platform/clock.h"
#include "tests/drivers/scripted_can.h"
#include "tests/hal/can_bus_contract.h"
#include "tests/hal/drive_contract.h"

namespace cgsr::hal {
namespace {

using socketcan::IdFilter;
using socketcan::SocketCanBus;
using socketcan::SocketCanParameters;

constexpr MonoTime kBegin{seconds(1000.0)};
const std::vector<IdFilter> kRmpIds = {{0x400, 0x7F8}, {0x410, 0x7F8}, {0x680, 0x7F0}};

CanFrame to_hal(const can_frame& frame, MonoTime stamp) {
  CanFrame out{.id = static_cast<std::uint16_t>(frame.can_id), .size = frame.can_dlc, .stamp = stamp};
  std::copy(std::begin(frame.data), std::end(frame.data), out.data.begin());
  return out;
}

CanBusRig scripted_bus() {
  struct World {
    test::ScriptedCan kernel;
    MonoTime now = kBegin;
    std::size_t received = 0;
  };
  auto world = std::make_shared<World>();
  CanBusRig rig;
  rig.world = world;
  rig.bus = std::make_unique<SocketCanBus>(SocketCanParameters{}, kRmpIds,
                                           std::make_unique<test::ScriptedCanSocket>(world->kernel));
  rig.now = [world] { return world->now; };
  rig.wait = [world](double s) { world->now += seconds(s); };
  rig.say = [world](CanFrame frame) {
    frame.stamp = world->now;
    world->kernel.data(frame);
  };
  rig.received = [world] {
    std::vector<CanFrame> frames;
    for (; world->received < world->kernel.outgoing.size(); ++world->received)
      frames.push_back(to_hal(world->kernel.outgoing[world->received], world->now));
    return frames;
  };
  return rig;
}

CanBusRig virtual_bus() {
  struct World {
    sim::VirtualCanBus bus;
    std::unique_ptr<CanBus> other = bus.base();
    MonoTime now = kBegin;
  };
  auto world = std::make_shared<World>();
  (void)world->other->start();
  CanBusRig rig;
  rig.world = world;
  rig.bus = world->bus.host();
  rig.now = [world] { return world->now; };
  rig.wait = [world](double s) { world->now += seconds(s); };
  rig.say = [world](CanFrame frame) {
    frame.stamp = world->now;
    (void)world->other->send(frame);
  };
  rig.received = [world] {
    std::vector<CanFrame> frames(64);
    frames.resize(world->other->receive(world->now, frames));
    return frames;
  };
  return rig;
}

/// Over the kernel's virtual interface vcan0, where there is one: `ip link add vcan0 type vcan; ip link set vcan0 up`.
CanBusRig vcan_bus() {
  if (if_nametoindex("vcan0") == 0) return {};
  struct World {
    std::unique_ptr<socketcan::CanSocket> other = socketcan::make_can_socket();
    RealClock clock;
  };
  auto world = std::make_shared<World>();
  const can_filter all{};
  if (!world->other->open("vcan0", {&all, 1})) return {};
  SocketCanParameters parameters;
  parameters.interface = "vcan0";
  CanBusRig rig;
  rig.world = world;
  rig.bus = std::make_unique<SocketCanBus>(parameters, kRmpIds, socketcan::make_can_socket());
  rig.now = [world] { return world->clock.now(); };
  rig.wait = [](double s) { std::this_thread::sleep_for(seconds(s)); };
  rig.say = [world](const CanFrame& frame) {
    can_frame out{};
    out.can_id = frame.id;
    out.can_dlc = frame.size;
    std::copy(frame.data.begin(), frame.data.end(), std::begin(out.data));
    ASSERT_EQ(world->other->send(out), 0);
  };
  rig.received = [world] {
    std::vector<CanFrame> frames;
    socketcan::RawFrame raw;
    while (world->other->receive(raw) == 0) {
      if (raw.frame.can_id == 0x413) frames.push_back(to_hal(raw.frame, raw.stamp));
    }
    return frames;
  };
  return rig;
}

INSTANTIATE_TEST_SUITE_P(Buses, CanBusContract,
                         testing::Values(CanBusCase{"socket", scripted_bus}, CanBusCase{"virtual", virtual_bus},
                                         CanBusCase{"vcan", vcan_bus}),
                         CaseName());

/// The Segway of the simulation behind the scripted kernel's socket.
DriveRig segway_behind_a_socket() {
  struct World {
    sim::VirtualSegway segway{{}, sim::BasePlacement{.time = kBegin}};
    std::unique_ptr<CanBus> port = segway.host_port();
    test::ScriptedCan kernel;
    MonoTime now = kBegin;
  };
  auto world = std::make_shared<World>();
  (void)world->port->start();
  World* raw = world.get();
  world->kernel.on_send = [raw](const can_frame& frame) { (void)raw->port->send(to_hal(frame, raw->now)); };
  world->kernel.before_receive = [raw] {
    std::array<CanFrame, 64> frames;
    for (std::size_t count = frames.size(); count == frames.size();) {
      count = raw->port->receive(raw->now, frames);
      for (std::size_t i = 0; i < count; ++i) raw->kernel.data(frames[i]);
    }
  };
  DriveRig rig;
  rig.world = world;
  rig.drive = std::make_unique<rmp::RmpDrive>(
      std::make_unique<SocketCanBus>(SocketCanParameters{}, kRmpIds,
                                     std::make_unique<test::ScriptedCanSocket>(world->kernel)),
      rmp::RmpParameters{});
  rig.run_to = [raw](MonoTime time) {
    raw->now = time;
    raw->segway.base().advance_to(time);
  };
  return rig;
}

INSTANTIATE_TEST_SUITE_P(SocketCan, DriveContract, testing::Values(DriveCase{"segway", segway_behind_a_socket}),
                         CaseName());

}  // namespace
}  // namespace cgsr::hal
