#include "hal/socketcan/can_socket.h"

#include <libsocketcan.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

namespace cgsr::hal::socketcan {
namespace {

std::string words(int error) {
  return std::generic_category().message(error);
}

MonoTime now_on(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return MonoTime{std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec)};
}

/// The kernel stamps with the wall clock. Both clocks are read now: a wall clock that is set between the arrival and the
/// reading makes the stamp wrong, so it is kept from lying in the future; the caller knows what it cannot lie before.
MonoTime to_monotonic(const timespec& wall) {
  const MonoTime now = now_on(CLOCK_MONOTONIC);
  const Duration age =
      now_on(CLOCK_REALTIME) - MonoTime{std::chrono::seconds(wall.tv_sec) + std::chrono::nanoseconds(wall.tv_nsec)};
  return now - std::max(age, Duration::zero());
}

template <class Value>
int set_option(int fd, int level, int option, const Value& value) {
  return setsockopt(fd, level, option, &value, sizeof(value));
}

/// libsocketcan complains on stderr of an interface without a controller (vcan): such a one is not asked.
bool has_controller(const std::string& interface) {
  std::error_code ignored;
  return std::filesystem::exists("/sys/class/net/" + interface + "/device", ignored);
}

/// \return the option that was refused, or null.
const char* set_options(int fd, std::span<const can_filter> filters) {
  const can_err_mask_t errors = CAN_ERR_MASK & ~can_err_mask_t{CAN_ERR_BUSERROR};  // those can flood
  if (setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), static_cast<socklen_t>(filters.size_bytes())) != 0)
    return "the filters";
  if (set_option(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors) != 0) return "error frames";
  if (set_option(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, 0) != 0) return "no echo";
  if (set_option(fd, SOL_SOCKET, SO_TIMESTAMPNS, 1) != 0) return "receive stamps";
  if (set_option(fd, SOL_SOCKET, SO_RXQ_OVFL, 1) != 0) return "the count of lost frames";
  if (set_option(fd, SOL_SOCKET, SO_SNDBUF, 1) != 0) return "a short send queue";  // raised to the kernel's minimum
  return nullptr;
}

/// \return what keeps the interface from being used, with what mends it; empty: nothing.
std::string interface_problem(int fd, const std::string& interface, int& index) {
  ifreq request{};
  if (interface.empty() || interface.size() >= IFNAMSIZ)
    return fmt::format("'{}' cannot be the name of a network interface", interface);
  std::copy(interface.begin(), interface.end(), std::begin(request.ifr_name));
  if (ioctl(fd, SIOCGIFINDEX, &request) != 0) {
    return fmt::format("there is no interface '{}' ({}): see `ip link show type can`, or load the adapter's driver",
                       interface, words(errno));
  }
  index = request.ifr_ifindex;
  if (ioctl(fd, SIOCGIFFLAGS, &request) != 0) return fmt::format("'{}': {}", interface, words(errno));
  if ((request.ifr_flags & IFF_UP) == 0) {
    return fmt::format(
        "'{0}' is down: `ip link set {0} up type can bitrate 500000`, or config/network/80-cgsr-can.network",
        interface);
  }
  return {};
}

class KernelCanSocket final : public CanSocket {
 public:
  KernelCanSocket() = default;
  ~KernelCanSocket() override { KernelCanSocket::close(); }
  KernelCanSocket(const KernelCanSocket&) = delete;
  KernelCanSocket& operator=(const KernelCanSocket&) = delete;

  Result<void> open(const std::string& interface, std::span<const can_filter> filters) override {
    close();
    fd_ = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (fd_ < 0) return fail(fmt::format("CAN: this kernel has no CAN sockets ({}): `modprobe can-raw`", words(errno)));
    int index = 0;
    if (const auto problem = interface_problem(fd_, interface, index); !problem.empty()) return give_up(problem);
    if (const char* refused = set_options(fd_, filters)) {
      return give_up(fmt::format("'{}': the kernel refuses {} ({})", interface, refused, words(errno)));
    }
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = index;
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the sockets API
    if (bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
      return give_up(fmt::format("'{}' is no CAN interface ({})", interface, words(errno)));
    }
    return {};
  }

  int send(const can_frame& frame) override { return send_frame(fd_, frame); }
  int receive(RawFrame& into) override { return receive_frame(fd_, into); }

  void close() override {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }

  LinkReport report(const std::string& interface) override {
    LinkReport link;
    if (!has_controller(interface)) return link;
    link.known = can_get_state(interface.c_str(), &link.can_state) == 0;
    can_bittiming timing{};
    if (link.known && can_get_bittiming(interface.c_str(), &timing) == 0) link.bit_rate = timing.bitrate;
    return link;
  }

  int restart(const std::string& interface) override {
    errno = 0;
    if (can_do_restart(interface.c_str()) == 0) return 0;
    return errno != 0 ? errno : EPERM;
  }

 private:
  Result<void> give_up(const std::string& problem) {
    close();
    return fail("CAN: " + problem);
  }

  int fd_ = -1;
};

}  // namespace

int send_frame(int fd, const can_frame& frame) {
  const ssize_t sent = ::send(fd, &frame, sizeof(frame), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent == static_cast<ssize_t>(sizeof(frame))) return 0;
  return sent < 0 ? errno : EIO;
}

int receive_frame(int fd, RawFrame& into) {
  iovec data{&into.frame, sizeof(into.frame)};
  alignas(cmsghdr) std::array<char, 256> control{};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = recvmsg(fd, &message, MSG_DONTWAIT);
  if (size < 0) return errno;
  if (size == 0) return ENODEV;
  if (size != static_cast<ssize_t>(sizeof(can_frame))) return EBADMSG;

  into.stamp = now_on(CLOCK_MONOTONIC);
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET) continue;
    if (part->cmsg_type == SO_TIMESTAMPNS) {
      timespec wall{};
      std::memcpy(&wall, CMSG_DATA(part), sizeof(wall));
      into.stamp = to_monotonic(wall);
    } else if (part->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&into.lost, CMSG_DATA(part), sizeof(into.lost));
    }
  }
  return 0;
}

std::unique_ptr<CanSocket> make_can_socket() {
  return std::make_unique<KernelCanSocket>();
}

}  // namespace cgsr::hal::socketcan
