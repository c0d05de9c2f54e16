#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "hal/can_bus.h"
#include "platform/time.h"

namespace cgsr::sim {

enum class BusTrouble : std::uint8_t {
  kBaseSilent,       ///< what the base sends gets lost; it hears everything.
  kIdLost,           ///< what the base sends under one id gets lost.
  kUnplugged,        ///< the host's cable is out: its queue fills, its controller goes error passive, neither hears the
                     ///< other. What waits in the queue goes out when the cable is back.
  kBusOff,           ///< the host's controller is off the bus.
  kGone,             ///< the host's interface is gone.
  kSecondCommander,  ///< somebody else sends `frame` every 20 ms.
};

/// Trouble from `from` until just before `to`.
struct BusEvent {
  BusTrouble trouble = BusTrouble::kBaseSilent;
  MonoTime from{};
  MonoTime to = MonoTime::max();
  hal::CanFrame frame{};  ///< kIdLost: its id. kSecondCommander: all but the stamp.
};

/// A CAN bus of 500 kbit/s with two nodes, the host (the robot's computer) and the base, and room for a third that is
/// only heard.
///
/// There is no time in it but the stamps: a frame arrives when it has travelled over the wire, which carries one at a
/// time in the order they were sent; receive(until) hands out what has arrived by then. Same calls, same frames, same
/// stamps. Not modelled: arbitration between frames that wait at the same time, stuff bits, single errors.
///
/// Threads: the two ports may live in different threads. It takes a lock and is for simulation only; send and receive
/// do not allocate. The bus must outlive its ports.
class VirtualCanBus {
 public:
  explicit VirtualCanBus(std::vector<BusEvent> script = {});
  VirtualCanBus(const VirtualCanBus&) = delete;
  VirtualCanBus& operator=(const VirtualCanBus&) = delete;

  /// \return a port for the node; any number, all of them the same node.
  std::unique_ptr<hal::CanBus> host();
  std::unique_ptr<hal::CanBus> base();

  /// A third node sends `frame` at its stamp: both others hear it.
  void inject(const hal::CanFrame& frame);

  /// Called with `until` before the host receives, so that the base can catch up with the time. Set before anything
  /// moves.
  void before_host_receives(std::function<void(MonoTime)> catch_up) { catch_up_ = std::move(catch_up); }

  /// Called with every frame that travels over the wire, whoever hears it, stamped with its arrival. Set before
  /// anything moves.
  void tap(std::function<void(const hal::CanFrame&)> listener) { tap_ = std::move(listener); }

 private:
  static constexpr std::size_t kReceiveCapacity = 4096;
  static constexpr std::size_t kSendCapacity = 10;  // Linux' default for a CAN interface

  enum Node : std::uint8_t { kHost, kBase, kThird };

  /// First in, first out; never grows.
  template <std::size_t Capacity>
  class Queue {
   public:
    bool push(const hal::CanFrame& frame);
    [[nodiscard]] const hal::CanFrame* front() const { return count_ == 0 ? nullptr : &frames_[first_]; }
    void pop();
    void clear() { count_ = 0; }

   private:
    std::vector<hal::CanFrame> frames_ = std::vector<hal::CanFrame>(Capacity);
    std::size_t first_ = 0;
    std::size_t count_ = 0;
  };

  struct NodeState {
    bool started = false;
    MonoTime now{};
    hal::CanState state = hal::CanState::kGone;
    hal::CanCounters counters;
    Queue<kReceiveCapacity> received;
    Queue<kSendCapacity> waiting;  // host, unplugged
  };

  class Port;

  [[nodiscard]] bool troubled(BusTrouble trouble, MonoTime at) const;
  [[nodiscard]] bool reaches(Node to, Node from, const hal::CanFrame& frame) const;
  void settle(MonoTime now);
  void look_at_state(NodeState& node, Node which, MonoTime now);
  void transmit(const hal::CanFrame& frame, Node from);
  tl::expected<void, hal::CanSendFailure> send(Node which, const hal::CanFrame& frame);
  std::size_t receive(Node which, MonoTime until, std::span<hal::CanFrame> into);

  mutable std::mutex mutex_;
  std::vector<BusEvent> script_;
  std::vector<MonoTime> next_foreign_;  // for each event of the script
  std::array<NodeState, 2> nodes_;
  MonoTime wire_free_at_ = MonoTime::min();
  std::function<void(MonoTime)> catch_up_ = [](MonoTime) {};
  std::function<void(const hal::CanFrame&)> tap_ = [](const hal::CanFrame&) {};
};

}  // namespace cgsr::sim
