// What goes wrong between the driver and a CAN interface: each with its state, bounded restarts, and no motion by itself.

#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "hal/rmp/rmp_drive.h"
#include "hal/socketcan/controller_state.h"
#include "hal/socketcan/socketcan_bus.h"
#include "tests/drivers/scripted_can.h"

namespace cgsr {
namespace {

using hal::CanFrame;
using hal::CanSendFailure;
using hal::CanState;
using hal::socketcan::RawFrame;
using hal::socketcan::SocketCanBus;
using hal::socketcan::SocketCanParameters;

struct SocketCanFault : testing::Test {
  SocketCanFault()
      : bus(SocketCanParameters{}, {{0x400, 0x7F8}, {0x413}}, std::make_unique<test::ScriptedCanSocket>(kernel)) {}

  void SetUp() override { ASSERT_TRUE(bus.start()); }

  std::size_t look(double s) {
    now = MonoTime{seconds(s)};
    return bus.receive(now, frames);
  }

  /// The restarting thread has its own pace.
  bool restarted(int times) {
    for (int i = 0; i < 500 && kernel.restarts < times; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return kernel.restarts == times;
  }

  test::ScriptedCan kernel;
  SocketCanBus bus;
  MonoTime now{};
  std::array<CanFrame, 8> frames;
};

TEST_F(SocketCanFault, AFullQueueIsSaidAndIsNotGone) {
  for (const int error : {ENOBUFS, EAGAIN}) {
    kernel.send_error = error;
    const auto sent = bus.send({.id = 0x413, .size = 8});
    ASSERT_FALSE(sent);
    EXPECT_EQ(sent.error(), CanSendFailure::kQueueFull);
    EXPECT_EQ(bus.state(), CanState::kActive);
  }
  EXPECT_EQ(bus.counters().refused, 2U);
  kernel.send_error = 0;
  EXPECT_TRUE(bus.send({.id = 0x413, .size = 8}));
}

TEST_F(SocketCanFault, StatesComeFromErrorFrames) {
  kernel.error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING);
  look(1.0);
  EXPECT_EQ(bus.state(), CanState::kWarning);
  kernel.error(CAN_ERR_CRTL | CAN_ERR_ACK, CAN_ERR_CRTL_TX_PASSIVE | CAN_ERR_CRTL_TX_WARNING);
  look(1.1);
  EXPECT_EQ(bus.state(), CanState::kPassive);
  kernel.error(CAN_ERR_ACK);  // says nothing about the state
  look(1.2);
  EXPECT_EQ(bus.state(), CanState::kPassive);
  kernel.error(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE);
  look(1.3);
  EXPECT_EQ(bus.state(), CanState::kActive);
  EXPECT_EQ(bus.counters().error_passive, 1U);
}

TEST_F(SocketCanFault, ErrorFramesAreNeverHandedOut) {
  kernel.error(CAN_ERR_ACK);
  kernel.data({.id = 0x401, .size = 8, .stamp = MonoTime{seconds(0.5)}});
  ASSERT_EQ(look(1.0), 1U);
  EXPECT_EQ(frames[0].id, 0x401);
}

TEST_F(SocketCanFault, RemoteFramesLongIdsAndOthersIdsAreLeftOut) {
  RawFrame raw;
  raw.frame.can_dlc = 8;
  for (const canid_t id : {0x401U | CAN_EFF_FLAG, 0x401U | CAN_RTR_FLAG, 0x500U}) {
    raw.frame.can_id = id;
    kernel.arrive(raw);
  }
  EXPECT_TRUE(kernel.incoming.empty()) << "the kernel's filters";
  for (const canid_t id : {0x401U | CAN_EFF_FLAG, 0x401U | CAN_RTR_FLAG}) {
    raw.frame.can_id = id;
    kernel.incoming.push_back(raw);
  }
  EXPECT_EQ(look(1.0), 0U) << "and the driver's own";
}

TEST_F(SocketCanFault, BusOffIsRestartedABoundedNumberOfTimesWithAWaitThatDoubles) {
  double t = 1.0;
  for (int i = 0; i < SocketCanParameters{}.max_restarts; ++i) {
    kernel.error(CAN_ERR_BUSOFF);
    look(t);
    EXPECT_EQ(bus.state(), CanState::kBusOff);
    EXPECT_EQ(bus.send({.id = 0x413, .size = 8}).error(), CanSendFailure::kBusOff);
    const double wait_s = 0.1 * (1 << i);
    look(t + wait_s - 0.01);
    EXPECT_EQ(kernel.restarts, i) << "too early";
    look(t + wait_s + 0.01);
    ASSERT_TRUE(restarted(i + 1));
    kernel.error(CAN_ERR_RESTARTED);
    look(t + wait_s + 0.02);
    EXPECT_EQ(bus.state(), CanState::kActive);
    t += wait_s + 0.1;
  }
  kernel.error(CAN_ERR_BUSOFF);
  for (double later = t; later < t + 30.0; later += 0.5) look(later);
  EXPECT_EQ(bus.state(), CanState::kBusOff);
  EXPECT_EQ(kernel.restarts, SocketCanParameters{}.max_restarts) << "it gave up";
  EXPECT_EQ(bus.counters().bus_off, 6U);
  EXPECT_EQ(bus.counters().restarts, 5U);
}

TEST_F(SocketCanFault, ARestartThatIsRefusedIsTriedAgainAndKept) {
  kernel.restart_error = EPERM;
  kernel.error(CAN_ERR_BUSOFF);
  look(1.0);
  look(1.2);
  ASSERT_TRUE(restarted(1));
  look(1.3);
  look(1.6);
  ASSERT_TRUE(restarted(2));
  bus.stop();  // joins the thread
  EXPECT_EQ(bus.restart_error(), EPERM);
}

TEST_F(SocketCanFault, AnInterfaceThatGoesAwayIsGoneAndComesBack) {
  kernel.exists = false;
  look(1.0);
  EXPECT_EQ(bus.state(), CanState::kGone);
  EXPECT_EQ(bus.send({.id = 0x413, .size = 8}).error(), CanSendFailure::kGone);
  look(1.5);
  EXPECT_EQ(bus.state(), CanState::kGone);
  kernel.exists = true;
  look(1.61);
  EXPECT_EQ(bus.state(), CanState::kActive);
  EXPECT_EQ(kernel.opened, 2);
  EXPECT_TRUE(bus.send({.id = 0x413, .size = 8}));
}

TEST_F(SocketCanFault, AnInterfaceThatGoesAwayIsNoticedBySendingToo) {
  kernel.send_error = ENETDOWN;
  EXPECT_EQ(bus.send({.id = 0x413, .size = 8}).error(), CanSendFailure::kGone);
  EXPECT_EQ(bus.state(), CanState::kGone);
  EXPECT_EQ(bus.last_error(), ENETDOWN);
}

TEST_F(SocketCanFault, LostFramesAreCounted) {
  kernel.lost = 7;
  kernel.data({.id = 0x401, .size = 8, .stamp = MonoTime{seconds(0.9)}});
  kernel.error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW);
  look(1.0);
  EXPECT_EQ(bus.counters().lost, 8U);
}

// The kernel's stamps are of the wall clock: set while a frame waits, they come out hours wrong.
TEST_F(SocketCanFault, AStampCannotLieBeforeTheSocketWasLastEmpty) {
  look(10.0);
  kernel.data({.id = 0x401, .size = 8, .stamp = MonoTime{seconds(10.0 - 3600.0)}});
  ASSERT_EQ(look(10.01), 1U);
  EXPECT_EQ(frames[0].stamp, MonoTime{seconds(10.0)});
}

TEST(SocketCanStart, SaysWhatIsWrongWithTheInterface) {
  test::ScriptedCan kernel;
  SocketCanBus bus(SocketCanParameters{}, {{0x413}}, std::make_unique<test::ScriptedCanSocket>(kernel));
  kernel.exists = false;
  const auto missing = bus.start();
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("can0"), std::string::npos);
  kernel.exists = true;
  kernel.link = {.known = true, .can_state = CAN_STATE_ERROR_ACTIVE, .bit_rate = 250'000};
  const auto slow = bus.start();
  ASSERT_FALSE(slow);
  EXPECT_NE(slow.error().message.find("250000"), std::string::npos) << slow.error().message;
  kernel.link.bit_rate = 500'000;
  kernel.link.can_state = CAN_STATE_BUS_OFF;
  ASSERT_TRUE(bus.start());
  EXPECT_EQ(bus.state(), CanState::kBusOff);
}

TEST(SocketCanStart, TheKernelsOwnSaysThatThereIsNoSuchInterface) {
  SocketCanParameters parameters;
  parameters.interface = "nocan7";
  SocketCanBus bus(parameters, {{0x413}}, hal::socketcan::make_can_socket());
  const auto started = bus.start();
  ASSERT_FALSE(started);
  const auto& message = started.error().message;
  EXPECT_TRUE(message.find("nocan7") != std::string::npos || message.find("can-raw") != std::string::npos) << message;
}

// The same system calls on a socket pair: a kernel's queue that fills, an end that closes, what is no frame.
TEST(SocketCanDescriptor, SendsReceivesAndSaysWhatFailed) {
  std::array<int, 2> ends{};
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()), 0);
  RawFrame got;
  EXPECT_EQ(hal::socketcan::receive_frame(ends[1], got), EAGAIN);
  can_frame frame{};
  frame.can_id = 0x413;
  frame.can_dlc = 8;
  frame.data[0] = 42;
  ASSERT_EQ(hal::socketcan::send_frame(ends[0], frame), 0);
  ASSERT_EQ(hal::socketcan::receive_frame(ends[1], got), 0);
  EXPECT_EQ(got.frame.can_id, 0x413U);
  EXPECT_EQ(got.frame.data[0], 42);
  EXPECT_GT(got.stamp, MonoTime{});

  int error = 0;
  for (int i = 0; i < 100'000 && error == 0; ++i) error = hal::socketcan::send_frame(ends[0], frame);
  EXPECT_EQ(error, EAGAIN);
  while (hal::socketcan::receive_frame(ends[1], got) == 0) {
  }
  ASSERT_EQ(send(ends[0], "abc", 3, 0), 3);
  EXPECT_EQ(hal::socketcan::receive_frame(ends[1], got), EBADMSG);
  close(ends[0]);
  EXPECT_EQ(hal::socketcan::receive_frame(ends[1], got), ENODEV);
  EXPECT_NE(hal::socketcan::send_frame(ends[1], frame), 0);
  close(ends[1]);
}

}  // namespace
}  // namespace cgsr
