#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "platform/error.h"
#include "platform/time.h"

namespace cgsr::hal {

/// One data frame of a classic CAN bus.
struct CanFrame {
  std::uint16_t id = 0;   ///< 11 bits, 0..0x7FF.
  std::uint8_t size = 0;  ///< bytes of data, 0..8; those beyond it are zero.
  std::array<std::uint8_t, 8> data{};
  MonoTime stamp{};  ///< when it was received; of a frame that is sent: when it was handed over.

  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

enum class CanSendFailure : std::uint8_t {
  kQueueFull,  ///< nobody takes the frames that wait already; this one is lost. Again and again: the link is dead.
  kBusOff,     ///< the controller took itself off the bus after too many errors.
  kGone,       ///< the interface is down, unplugged or was never started.
};
constexpr std::string_view to_string(CanSendFailure failure) {
  switch (failure) {
    case CanSendFailure::kQueueFull:
      return "queue full";
    case CanSendFailure::kBusOff:
      return "bus off";
    case CanSendFailure::kGone:
      return "interface gone";
  }
  return "";
}

/// How well the controller is with the bus (ISO 11898-1: error counters below 96, 128, 256).
enum class CanState : std::uint8_t {
  kActive,
  kWarning,
  kPassive,  ///< mostly: nobody acknowledges, the cable is out.
  kBusOff,   ///< neither sends nor receives until it is restarted.
  kGone,     ///< as CanSendFailure::kGone.
};
constexpr std::string_view to_string(CanState state) {
  switch (state) {
    case CanState::kActive:
      return "active";
    case CanState::kWarning:
      return "warning";
    case CanState::kPassive:
      return "passive";
    case CanState::kBusOff:
      return "bus off";
    case CanState::kGone:
      return "interface gone";
  }
  return "";
}

/// Counts since start(); none of them ever falls.
struct CanCounters {
  std::uint64_t sent = 0;           ///< handed to the controller.
  std::uint64_t refused = 0;        ///< of send().
  std::uint64_t received = 0;       ///< handed out by receive().
  std::uint64_t lost = 0;           ///< came, and were dropped before receive() took them.
  std::uint64_t error_passive = 0;  ///< times that state was entered.
  std::uint64_t bus_off = 0;        ///< times that state was entered.
  std::uint64_t restarts = 0;       ///< times bus-off was left.
};

/// A classic CAN bus, as one node of it sees it. Frames with 29-bit ids, remote frames and error frames never come out
/// of it, nor do the node's own.
///
/// Threads: start and stop from the service thread, the rest from one thread only (the drive's). Nothing here blocks or
/// allocates but start and stop.
class CanBus {
 public:
  virtual ~CanBus() = default;

  /// Joins the bus. \return what is wrong with the interface. Starting twice is an error; after stop() it may start
  /// again.
  virtual Result<void> start() = 0;

  /// Puts a frame into the send queue, which is short on purpose: old motion commands must not wait in it.
  /// Success means that it left this program, not that anybody heard it: only feedback tells that.
  virtual tl::expected<void, CanSendFailure> send(const CanFrame& frame) = 0;

  /// Hands out what was received up to `until`, oldest first; stamps never fall. A full span: call again.
  /// \return how many frames were written to `into`; 0 also when the bus is off or gone: ask state().
  virtual std::size_t receive(MonoTime until, std::span<CanFrame> into) = 0;

  [[nodiscard]] virtual CanState state() const = 0;

  [[nodiscard]] virtual CanCounters counters() const = 0;

  /// Leaves the bus, after what send() took has gone out or 10 ms. Idempotent.
  virtual void stop() = 0;
};

}  // namespace cgsr::hal
