#include "tests/hil/base_feeder.h"

#include <cstdio>
#include <utility>

#include <fmt/core.h>

#include "hal/rmp/messages.h"
#include "hal/socketcan/socketcan_bus.h"

namespace cgsr::hil {
namespace {

using hal::CanFrame;
using hal::rmp::MessageId;

/// What the base meets on its bus at the moment.
struct Moment {
  BaseFaults faults;
  std::optional<Duration> recorded;  ///< the time of the recording whose motion it says; nothing: its own.
};

/// The bus as the base meets it, with the faults of the moment on the way.
class FaultyBus final : public hal::CanBus {
 public:
  FaultyBus(std::unique_ptr<hal::CanBus> bus, const Moment& moment, RecordedMotion* motion)
      : bus_(std::move(bus)), faults_(moment.faults), moment_(moment), motion_(motion) {}

  Result<void> start() override { return bus_->start(); }

  tl::expected<void, hal::CanSendFailure> send(const CanFrame& own) override {
    CanFrame frame = own;
    if (motion_ != nullptr && moment_.recorded) motion_->replace(frame, *moment_.recorded);
    if (faults_.silent) return {};
    if (faults_.powered_off)
      return frame.id == kStatus ? bus_->send(powered_off()) : tl::expected<void, hal::CanSendFailure>{};
    if (!faults_.emergency_stop || frame.id != kStatus) return bus_->send(frame);
    // Status word 2 is the third big-endian word: both sides report the emergency stop; word 1: the motors are off.
    CanFrame changed = frame;
    changed.data[3] = static_cast<std::uint8_t>(changed.data[3] & ~hal::rmp::word1::kMotorsEnabled);
    changed.data[4] = static_cast<std::uint8_t>(changed.data[4] | (hal::rmp::word2::kEmergencyStop >> 8));
    changed.data[5] = static_cast<std::uint8_t>(changed.data[5] | (hal::rmp::word2::kEmergencyStop & 0xFF));
    return bus_->send(changed);
  }

  std::size_t receive(MonoTime until, std::span<CanFrame> into) override {
    const std::size_t count = bus_->receive(until, into);
    return faults_.emergency_stop || faults_.powered_off ? 0 : count;
  }

  [[nodiscard]] hal::CanState state() const override { return bus_->state(); }
  [[nodiscard]] hal::CanCounters counters() const override { return bus_->counters(); }
  void stop() override { bus_->stop(); }

 private:
  static constexpr auto kStatus = static_cast<std::uint16_t>(MessageId::kStatus);

  /// What the box of the user interface sends while the base has no power, its battery in the third word.
  static CanFrame powered_off() {
    CanFrame frame;
    frame.id = static_cast<std::uint16_t>(MessageId::kShutdown);
    frame.size = 8;
    frame.data = {0, 0, 0, 0, 0x01, 0x8A, 0, 0};
    return frame;
  }

  std::unique_ptr<hal::CanBus> bus_;
  const BaseFaults& faults_;
  const Moment& moment_;
  RecordedMotion* motion_;
};

class SegwayFeeder final : public BaseFeeder {
 public:
  SegwayFeeder(std::unique_ptr<hal::CanBus> bus, MonoTime now, double keep_s, RecordedMotion* motion)
      : base_(std::make_unique<FaultyBus>(std::move(bus), moment_, motion), sim::BaseParameters{}, {.time = now}) {
    truth_.reserve(static_cast<std::size_t>(keep_s * 100.0));
  }

  void advance_to(MonoTime now, const BaseFaults& faults, std::optional<Duration> recorded) override {
    moment_ = {faults, recorded};
    base_.advance_to(now);
    if (truth_.size() < truth_.capacity()) truth_.push_back(base_.state_at(now));
  }

  Result<void> write_truth(const std::string& file) const override {
    std::FILE* const out = std::fopen(file.c_str(), "w");
    if (out == nullptr) return fail(fmt::format("{}: cannot be created", file));
    for (const sim::BaseState& state : truth_) {
      fmt::print(out, "{:.6f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f}\n", to_seconds(state.stamp.time_since_epoch()),
                 state.x_m, state.y_m, state.heading_rad, state.velocity.forward_mps, state.velocity.left_radps);
    }
    std::fclose(out);
    return {};
  }

 private:
  Moment moment_;
  sim::SimulatedRmp base_;
  std::vector<sim::BaseState> truth_;
};

}  // namespace

Result<std::unique_ptr<BaseFeeder>> BaseFeeder::start(const std::string& interface, MonoTime now, double keep_s,
                                                      RecordedMotion* motion) {
  hal::socketcan::SocketCanParameters parameters;
  parameters.interface = interface;
  parameters.bit_rate = 0;
  const std::vector<hal::socketcan::IdFilter> filters{{static_cast<std::uint16_t>(MessageId::kCommand)},
                                                      {static_cast<std::uint16_t>(MessageId::kShutdown)}};
  auto bus = std::make_unique<hal::socketcan::SocketCanBus>(parameters, filters, hal::socketcan::make_can_socket());
  if (auto started = bus->start(); !started) return tl::unexpected(started.error());
  bus->stop();  // the base starts it again: only so is its refusal heard
  return std::make_unique<SegwayFeeder>(std::move(bus), now, keep_s, motion);
}

}  // namespace cgsr::hil
