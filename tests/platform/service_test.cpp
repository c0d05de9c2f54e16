#include "platform/service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

namespace cgsr {
namespace {

using std::chrono::milliseconds;
using testing::IsEmpty;

constexpr MonoTime at(int ms) {
  return MonoTime{milliseconds(ms)};
}

/// Stands in for the service manager: the socket that NOTIFY_SOCKET names.
class Manager {
 public:
  Manager() : path_(std::filesystem::temp_directory_path() / ("cgsr-notify-" + std::to_string(getpid()))) {
    std::filesystem::remove(path_);
    socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path_.c_str(), sizeof(address.sun_path) - 1);
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
      throw std::runtime_error("bind");
    setenv("NOTIFY_SOCKET", path_.c_str(), 1);
  }
  ~Manager() {
    unsetenv("NOTIFY_SOCKET");
    close(socket_);
    std::filesystem::remove(path_);
  }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  /// \return the next message, empty when there is none.
  std::string received() {
    std::array<char, 256> buffer{};
    const auto length = recv(socket_, buffer.data(), buffer.size(), 0);
    return length <= 0 ? std::string() : std::string(buffer.data(), static_cast<std::size_t>(length));
  }

 private:
  std::filesystem::path path_;
  int socket_ = -1;
};

TEST(Service, TellsTheManager) {
  Manager manager;
  service::notify_ready();
  EXPECT_EQ(manager.received(), "READY=1");
  service::notify_status("30 images a second");
  EXPECT_EQ(manager.received(), "STATUS=30 images a second");
  service::ping_watchdog();
  EXPECT_EQ(manager.received(), "WATCHDOG=1");
  service::notify_stopping();
  EXPECT_EQ(manager.received(), "STOPPING=1");
}

TEST(Service, DoesNothingWithoutAManager) {
  unsetenv("NOTIFY_SOCKET");
  unsetenv("WATCHDOG_USEC");
  service::notify_ready();
  service::ping_watchdog();
  EXPECT_EQ(service::watchdog_period(), std::nullopt);
}

TEST(Service, PingsTwicePerWatchdogLimit) {
  setenv("WATCHDOG_USEC", "2000000", 1);
  setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
  EXPECT_EQ(service::watchdog_period(), std::chrono::seconds(1));
  setenv("WATCHDOG_PID", "1", 1);  // meant for another process
  EXPECT_EQ(service::watchdog_period(), std::nullopt);
  unsetenv("WATCHDOG_USEC");
  unsetenv("WATCHDOG_PID");
}

TEST(Heartbeats, NameWhoIsSilentAndSinceWhen) {
  Heartbeats heartbeats;
  const auto vision = heartbeats.add("vision", milliseconds(200), at(0));
  const auto motion = heartbeats.add("motion", milliseconds(50), at(0));
  EXPECT_THAT(heartbeats.silent_at(at(50)), IsEmpty());
  heartbeats.beat(motion, at(100));
  EXPECT_THAT(heartbeats.silent_at(at(150)), IsEmpty());
  heartbeats.beat(vision, at(150));
  const auto silent = heartbeats.silent_at(at(160));
  ASSERT_EQ(silent.size(), 1U);
  EXPECT_EQ(silent[0].name, "motion");
  EXPECT_EQ(silent[0].lasting, milliseconds(60));
}

TEST(Heartbeats, RefuseMoreThreadsThanThereIsRoomFor) {
  Heartbeats heartbeats;
  for (std::size_t i = 0; i < Heartbeats::kMost; ++i) heartbeats.add("thread", milliseconds(1), at(0));
  EXPECT_THROW(heartbeats.add("one more", milliseconds(1), at(0)), std::out_of_range);
}

TEST(Heartbeats, TheWatchdogIsPingedOnlyWhileAllBeat) {
  Manager manager;
  Heartbeats heartbeats;
  const auto vision = heartbeats.add("vision", milliseconds(200), at(0));
  const auto motion = heartbeats.add("motion", milliseconds(50), at(0));
  EXPECT_THAT(supervise(heartbeats, at(40)), IsEmpty());
  EXPECT_EQ(manager.received(), "WATCHDOG=1");
  heartbeats.beat(vision, at(90));
  EXPECT_EQ(supervise(heartbeats, at(90)).size(), 1U);
  EXPECT_EQ(manager.received(), "");
  heartbeats.beat(motion, at(100));
  EXPECT_THAT(supervise(heartbeats, at(100)), IsEmpty());
  EXPECT_EQ(manager.received(), "WATCHDOG=1");
}

TEST(HeartbeatsStress, BeatsAndLooksAtOnce) {
  Heartbeats heartbeats;
  const auto number = heartbeats.add("motion", std::chrono::seconds(1), at(0));
  std::thread thread([&] {
    for (int ms = 1; ms <= 50'000; ++ms) heartbeats.beat(number, at(ms));
  });
  for (int look = 0; look < 1000; ++look) EXPECT_THAT(heartbeats.silent_at(at(1000)), IsEmpty());
  thread.join();
  EXPECT_THAT(heartbeats.silent_at(at(51'000)), IsEmpty());
  EXPECT_EQ(heartbeats.silent_at(at(51'001)).size(), 1U);
}

}  // namespace
}  // namespace cgsr
