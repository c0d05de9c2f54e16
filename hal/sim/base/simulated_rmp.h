#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "hal/can_bus.h"
#include "hal/drive.h"
#include "hal/sim/base/base_parameters.h"
#include "hal/sim/base/segway_body.h"
#include "hal/sim/base/wire.h"
#include "platform/time.h"

namespace cgsr::sim {

enum class BaseTrouble : std::uint8_t {
  kEmergencyStop,   ///< motors off, status word 2 says so. They come back by themselves when it is released.
  kLowBattery,      ///< only a status bit.
  kSafetyShutdown,  ///< motors off and a status bit.
  kMotorsOff,       ///< motors off, no bit.
  kPowerOff,        ///< the set stops, the user interface sends 0x0412. Switched on again it counts from zero.
  kStatusBits,      ///< `word1` and `word2` on top of what is so.
};

/// Trouble from `from` until just before `to`.
struct BaseEvent {
  BaseTrouble trouble = BaseTrouble::kEmergencyStop;
  MonoTime from{};
  MonoTime to = MonoTime::max();
  std::uint16_t word1 = 0;
  std::uint16_t word2 = 0;
};

/// Where the robot really is. X_WR: the point between the wheels on the floor, heading about z. The body, and all that
/// it carries, is pitched about the axle (BaseParameters::axle_height_m above that point), positive leaning forward; it
/// does not roll.
struct BaseState {
  MonoTime stamp{};
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< not wrapped.
  double pitch_rad = 0.0;
  double pitch_rate_radps = 0.0;
  hal::Twist velocity;  ///< over the ground.
};

/// Where it begins.
struct BasePlacement {
  MonoTime time{};
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  std::uint64_t seed = 1;
};

/// A Segway RMP 200 as it is seen from its CAN bus: takes commands, moves, and every 10 ms sends its set of status
/// messages in the order of a real bus. Without a command for 0.4 s it slews to zero.
///
/// It lives on a grid of milliseconds from BasePlacement::time on, its servo loop on every tenth; at a servo frame it
/// takes the commands that arrived by then. So it does not matter how often it is asked to catch up, only what was sent
/// when. Obeyed: motion, the scales of velocity, acceleration and turn, gain schedule (only reported), balance lockout,
/// operational mode, integrator reset, shutdown. Not modelled: falling over, the current limit, terrain, batteries that
/// drain.
///
/// Threads: every member from any thread; takes a lock, for simulation only. Catching up does not allocate.
class SimulatedRmp {
 public:
  /// \param bus  its port, not null, not started.
  SimulatedRmp(std::unique_ptr<hal::CanBus> bus, const BaseParameters& parameters, const BasePlacement& placement,
               std::vector<BaseEvent> script = {});

  /// Lives until `time`; an earlier time changes nothing.
  void advance_to(MonoTime time);

  /// \return the truth at `time`, catching up when that is later than ever before. Up to a second ago it is remembered
  /// exactly (linear within the millisecond); before that the oldest that is.
  BaseState state_at(MonoTime time);

  [[nodiscard]] double axle_height_m() const { return parameters_.axle_height_m; }

 private:
  struct Settings {
    int max_velocity = 16;      // of 16
    int max_acceleration = 16;  // of 16
    int max_turn = 16;          // of 16
    int gain_schedule = 0;
    bool balance_locked = false;
  };

  void step();
  void servo_frame();
  void take_frames();
  void obey(const Order& order);
  void configure(int item, int value);
  void aim();
  void send_set();
  void send(hal::CanFrame frame);
  void switch_on();
  void remember();
  [[nodiscard]] bool troubled(BaseTrouble trouble) const;
  [[nodiscard]] BaseState current() const;

  mutable std::mutex mutex_;
  std::unique_ptr<hal::CanBus> bus_;
  BaseParameters parameters_;
  WireScales scales_;
  std::vector<BaseEvent> script_;
  SegwayBody body_;
  Noise pitch_noise_;
  MonoTime begin_;
  MonoTime now_;
  std::uint64_t steps_ = 0;

  bool powered_ = true;
  bool shut_down_ = false;  // by 0x0412 or by mode: for good
  BaseMode mode_;
  Settings settings_;
  Order order_;
  std::optional<MonoTime> order_at_;
  BodyTarget target_;

  // What the integrators count from: counts = base + floor(way since).
  std::uint32_t base_left_ = 0, base_right_ = 0, base_fore_aft_ = 0, base_yaw_ = 0;
  double left_from_m_ = 0.0, right_from_m_ = 0.0, fore_aft_from_m_ = 0.0, yaw_from_m_ = 0.0;
  std::uint16_t servo_count_ = 0;
  std::uint16_t ticker_ = 0;
  std::uint64_t sets_ = 0;

  std::vector<BaseState> history_;  // a ring, one for each millisecond
  std::uint64_t remembered_ = 0;
};

}  // namespace cgsr::sim
