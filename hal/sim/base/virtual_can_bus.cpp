#include "hal/sim/base/virtual_can_bus.h"

#include <algorithm>

namespace cgsr::sim {
namespace {

using hal::CanCounters;
using hal::CanFrame;
using hal::CanSendFailure;
using hal::CanState;

constexpr Duration kForeignPeriod = seconds(0.020);

// 500 kbit/s; 47 bits around the data of a frame with an 11-bit id, the pause behind it included, without stuff bits.
Duration time_on_wire(const CanFrame& frame) {
  return std::chrono::microseconds(2 * (47 + 8 * frame.size));
}

}  // namespace

template <std::size_t Capacity>
bool VirtualCanBus::Queue<Capacity>::push(const CanFrame& frame) {
  if (count_ == Capacity) return false;
  frames_[(first_ + count_++) % Capacity] = frame;
  return true;
}

template <std::size_t Capacity>
void VirtualCanBus::Queue<Capacity>::pop() {
  first_ = (first_ + 1) % Capacity;
  --count_;
}

class VirtualCanBus::Port final : public hal::CanBus {
 public:
  Port(VirtualCanBus& bus, Node which) : bus_(bus), which_(which), node_(bus.nodes_[which]) {}

  Result<void> start() override {
    const std::lock_guard lock(bus_.mutex_);
    if (node_.started) return fail("the virtual CAN port is started already");
    node_.started = true;
    node_.state = CanState::kActive;
    node_.counters = {};
    node_.received.clear();
    node_.waiting.clear();
    return {};
  }

  tl::expected<void, CanSendFailure> send(const CanFrame& frame) override { return bus_.send(which_, frame); }

  std::size_t receive(MonoTime until, std::span<CanFrame> into) override {
    if (which_ == kHost) bus_.catch_up_(until);  // without the lock: the base uses the bus
    return bus_.receive(which_, until, into);
  }

  [[nodiscard]] CanState state() const override {
    const std::lock_guard lock(bus_.mutex_);
    return node_.started ? node_.state : CanState::kGone;
  }

  [[nodiscard]] CanCounters counters() const override {
    const std::lock_guard lock(bus_.mutex_);
    return node_.counters;
  }

  void stop() override {
    const std::lock_guard lock(bus_.mutex_);
    node_.started = false;
  }

 private:
  VirtualCanBus& bus_;
  Node which_;
  NodeState& node_;
};

VirtualCanBus::VirtualCanBus(std::vector<BusEvent> script) : script_(std::move(script)) {
  for (const auto& event : script_) next_foreign_.push_back(event.from);
}

std::unique_ptr<hal::CanBus> VirtualCanBus::host() {
  return std::make_unique<Port>(*this, kHost);
}
std::unique_ptr<hal::CanBus> VirtualCanBus::base() {
  return std::make_unique<Port>(*this, kBase);
}

void VirtualCanBus::inject(const CanFrame& frame) {
  const std::lock_guard lock(mutex_);
  settle(frame.stamp);
  transmit(frame, kThird);
}

bool VirtualCanBus::troubled(BusTrouble trouble, MonoTime at) const {
  return std::any_of(script_.begin(), script_.end(), [&](const BusEvent& event) {
    return event.trouble == trouble && event.from <= at && at < event.to;
  });
}

bool VirtualCanBus::reaches(Node to, Node from, const CanFrame& frame) const {
  if (to == from || !nodes_[to].started) return false;
  const MonoTime at = frame.stamp;
  const bool over_the_cable = from == kHost || to == kHost;
  if (over_the_cable && troubled(BusTrouble::kUnplugged, at)) return false;
  if (to != kHost) return true;
  if (troubled(BusTrouble::kBusOff, at) || troubled(BusTrouble::kGone, at)) return false;
  if (from != kBase) return true;
  if (troubled(BusTrouble::kBaseSilent, at)) return false;
  return std::none_of(script_.begin(), script_.end(), [&](const BusEvent& event) {
    return event.trouble == BusTrouble::kIdLost && event.from <= at && at < event.to && event.frame.id == frame.id;
  });
}

// What the passing of time alone does: the second commander sends, and a queue that waited for its cable goes out.
void VirtualCanBus::settle(MonoTime now) {
  for (std::size_t i = 0; i < script_.size(); ++i) {
    const auto& event = script_[i];
    if (event.trouble != BusTrouble::kSecondCommander) continue;
    for (auto& next = next_foreign_[i]; next <= now && next < event.to; next += kForeignPeriod) {
      CanFrame frame = event.frame;
      frame.stamp = next;
      transmit(frame, kThird);
    }
  }
  auto& host = nodes_[kHost];
  if (troubled(BusTrouble::kUnplugged, now)) return;
  for (const CanFrame* frame = host.waiting.front(); frame != nullptr; frame = host.waiting.front()) {
    CanFrame late = *frame;
    late.stamp = now;
    transmit(late, kHost);
    host.waiting.pop();
  }
}

void VirtualCanBus::look_at_state(NodeState& node, Node which, MonoTime now) {
  node.now = std::max(node.now, now);
  if (which != kHost) return;
  const auto before = node.state;
  node.state = troubled(BusTrouble::kGone, node.now)        ? CanState::kGone
               : troubled(BusTrouble::kBusOff, node.now)    ? CanState::kBusOff
               : troubled(BusTrouble::kUnplugged, node.now) ? CanState::kPassive
                                                            : CanState::kActive;
  if (before == node.state) return;
  if (node.state == CanState::kBusOff) ++node.counters.bus_off;
  if (node.state == CanState::kPassive) ++node.counters.error_passive;
  if (before == CanState::kBusOff) ++node.counters.restarts;
}

void VirtualCanBus::transmit(const CanFrame& frame, Node from) {
  CanFrame on_wire = frame;
  on_wire.stamp = std::max(frame.stamp, wire_free_at_) + time_on_wire(frame);
  wire_free_at_ = on_wire.stamp;
  tap_(on_wire);
  for (const Node to : {kHost, kBase}) {
    if (reaches(to, from, on_wire) && !nodes_[to].received.push(on_wire)) ++nodes_[to].counters.lost;
  }
}

tl::expected<void, CanSendFailure> VirtualCanBus::send(Node which, const CanFrame& frame) {
  const std::lock_guard lock(mutex_);
  settle(frame.stamp);
  auto& node = nodes_[which];
  look_at_state(node, which, frame.stamp);
  const auto refuse = [&node](CanSendFailure failure) {
    ++node.counters.refused;
    return tl::unexpected(failure);
  };
  if (!node.started || node.state == CanState::kGone) return refuse(CanSendFailure::kGone);
  if (node.state == CanState::kBusOff) return refuse(CanSendFailure::kBusOff);
  if (node.state == CanState::kPassive) {
    if (!node.waiting.push(frame)) return refuse(CanSendFailure::kQueueFull);
  } else {
    transmit(frame, which);
  }
  ++node.counters.sent;
  return {};
}

std::size_t VirtualCanBus::receive(Node which, MonoTime until, std::span<CanFrame> into) {
  const std::lock_guard lock(mutex_);
  settle(until);
  auto& node = nodes_[which];
  look_at_state(node, which, until);
  if (!node.started) return 0;
  std::size_t count = 0;
  while (count < into.size() && node.received.front() != nullptr && node.received.front()->stamp <= until) {
    into[count++] = *node.received.front();
    node.received.pop();
  }
  node.counters.received += count;
  return count;
}

}  // namespace cgsr::sim
