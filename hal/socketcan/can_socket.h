#pragma once

#include <linux/can.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "platform/error.h"
#include "platform/time.h"

namespace cgsr::hal::socketcan {

/// A frame as the kernel hands it over, error frames included.
struct RawFrame {
  can_frame frame{};
  MonoTime stamp{};        ///< when the kernel received it; never later than the moment of reading.
  std::uint32_t lost = 0;  ///< frames that the socket dropped so far because nobody read them in time.
};

/// The state of the controller as the driver of the interface reports it.
struct LinkReport {
  bool known = false;  ///< false: a virtual interface, or a driver that does not report.
  int can_state = 0;   ///< enum can_state of linux/can/netlink.h.
  std::uint32_t bit_rate = 0;
};

/// The system calls of a raw CAN socket, so that a test can replace the kernel. Functions return 0 or an errno.
class CanSocket {
 public:
  virtual ~CanSocket() = default;

  /// Opens the socket on an interface that is up: non-blocking, these filters and no others, every error class but
  /// single bus errors, receive stamps, no echo of its own frames, the shortest send queue the kernel allows.
  virtual Result<void> open(const std::string& interface, std::span<const can_filter> filters) = 0;

  /// Never blocks. EAGAIN and ENOBUFS: the queue is full.
  virtual int send(const can_frame& frame) = 0;

  /// Never blocks. EAGAIN: nothing there.
  virtual int receive(RawFrame& into) = 0;

  virtual void close() = 0;

  /// Asks the driver of the interface; may block for milliseconds.
  virtual LinkReport report(const std::string& interface) = 0;

  /// Restarts a controller that is off the bus; may block. Needs CAP_NET_ADMIN.
  virtual int restart(const std::string& interface) = 0;
};

/// The kernel's.
std::unique_ptr<CanSocket> make_can_socket();

/// What CanSocket does with a socket that is open, for tests on other kinds of sockets. Same meaning.
int send_frame(int fd, const can_frame& frame);
int receive_frame(int fd, RawFrame& into);

}  // namespace cgsr::hal::socketcan
