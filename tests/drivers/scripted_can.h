#pragma once

#include <linux/can/error.h>
#include <linux/can/netlink.h>

#include <atomic>
#include <cerrno>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/can_bus.h"
#include "hal/socketcan/can_socket.h"

namespace cgsr::test {

/// A kernel with one CAN interface, as a script sets it. It must outlive its sockets.
struct ScriptedCan {
  bool exists = true;
  hal::socketcan::LinkReport link;
  int send_error = 0;
  int receive_error = 0;
  std::atomic<int> restarts{0};
  std::atomic<int> restart_error{0};
  int opened = 0;
  std::uint32_t lost = 0;
  std::vector<can_filter> filters;
  std::deque<hal::socketcan::RawFrame> incoming;
  std::vector<can_frame> outgoing;
  std::function<void(const can_frame&)> on_send = [](const can_frame&) {};
  std::function<void()> before_receive = [] {};

  [[nodiscard]] bool passes(const can_frame& frame) const {
    for (const auto& filter : filters) {
      if ((frame.can_id & filter.can_mask) == (filter.can_id & filter.can_mask)) return true;
    }
    return false;
  }

  void data(const hal::CanFrame& frame) {
    hal::socketcan::RawFrame raw;
    raw.frame.can_id = frame.id;
    raw.frame.can_dlc = frame.size;
    std::copy(frame.data.begin(), frame.data.end(), std::begin(raw.frame.data));
    raw.stamp = frame.stamp;
    arrive(raw);
  }

  void arrive(hal::socketcan::RawFrame raw) {
    raw.lost = lost;
    if (opened > 0 && ((raw.frame.can_id & CAN_ERR_FLAG) != 0 || passes(raw.frame))) incoming.push_back(raw);
  }

  void error(canid_t classes, std::uint8_t controller = 0) {
    hal::socketcan::RawFrame raw;
    raw.frame.can_id = CAN_ERR_FLAG | classes;
    raw.frame.can_dlc = CAN_ERR_DLC;
    raw.frame.data[1] = controller;
    arrive(raw);
  }
};

class ScriptedCanSocket final : public hal::socketcan::CanSocket {
 public:
  explicit ScriptedCanSocket(ScriptedCan& kernel) : kernel_(kernel) {}

  Result<void> open(const std::string& interface, std::span<const can_filter> filters) override {
    if (!kernel_.exists) return fail("there is no interface '" + interface + "'");
    ++kernel_.opened;
    kernel_.before_receive();  // what waited until now is not for this socket
    kernel_.filters.assign(filters.begin(), filters.end());
    kernel_.incoming.clear();
    return {};
  }
  int send(const can_frame& frame) override {
    if (!kernel_.exists) return ENETDOWN;
    if (kernel_.send_error != 0) return kernel_.send_error;
    kernel_.outgoing.push_back(frame);
    kernel_.on_send(frame);
    return 0;
  }
  int receive(hal::socketcan::RawFrame& into) override {
    kernel_.before_receive();
    if (!kernel_.exists) return ENETDOWN;
    if (kernel_.receive_error != 0) return kernel_.receive_error;
    if (kernel_.incoming.empty()) return EAGAIN;
    into = kernel_.incoming.front();
    kernel_.incoming.pop_front();
    return 0;
  }
  void close() override {}
  hal::socketcan::LinkReport report(const std::string&) override { return kernel_.link; }
  int restart(const std::string&) override {
    ++kernel_.restarts;
    return kernel_.restart_error;
  }

 private:
  ScriptedCan& kernel_;
};

}  // namespace cgsr::test
