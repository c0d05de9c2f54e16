#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "hal/can_bus.h"
#include "hal/drive.h"
#include "hal/fault_latch.h"
#include "hal/rmp/listener.h"
#include "hal/rmp/parameters.h"

namespace cgsr::hal::rmp {

/// Counts since start(); none of them ever falls.
struct RmpCounters {
  FeedbackCounters feedback;
  CanCounters bus;
  std::uint64_t commands = 0;  ///< sent.
  std::uint64_t unsent = 0;    ///< refused by the bus.
};

/// A Segway RMP 50/100/200/400 over any CAN bus.
///
/// Sends the newest command at most every 10 ms in the mean, and never sooner than 9.5 ms after another, so that control
/// cycles that jitter each send theirs; a newer one waits for its turn. Repeats it while command() is silent for up to hold_s, then zero: the base itself would go on for 400 ms. Listens whenever command() or odometry() is
/// called, so one of them must be, every 30 ms or so.
///
/// Until the first command() it says nothing at all, not even in stop(): a dry run leaves the base to others.
/// Zero goes out, whatever is commanded, as long as fault() is not kNone. Every fault latches (FaultLatch) except,
/// before the base was ready for the first time, that it is off, silent or without motors: those are waited for.
///
/// Threads: as Drive; counters, report, fault and rearm from the motion thread.
class RmpDrive final : public Drive, public FaultLatch {
 public:
  /// \param bus  not null, not started.
  RmpDrive(std::unique_ptr<CanBus> bus, const RmpParameters& parameters);
  ~RmpDrive() override;
  RmpDrive(const RmpDrive&) = delete;
  RmpDrive& operator=(const RmpDrive&) = delete;

  Result<void> start() override;

  /// Velocities beyond what the base takes are bounded. While something is wrong zero fails too, but is sent all the
  /// same.
  /// \return kSendFailed: bus off, link lost, or this one frame was refused. kNoFeedback: feedback never came whole or
  /// is too old.
  ///         kNotReady: any other fault, or a velocity other than zero while a fault waits for rearm().
  tl::expected<void, DriveFailure> command(const Twist& twist, MonoTime now) override;

  /// \return kNoFeedback also when a needed message is older than feedback_timeout_s.
  tl::expected<Odometry, DriveFailure> odometry(MonoTime now) override;

  void stop() override;

  [[nodiscard]] DriveFault fault() const override { return standing_ != DriveFault::kNone ? standing_ : latched_; }
  tl::expected<void, DriveFault> rearm(MonoTime now) override;

  [[nodiscard]] const RmpReport& report() const { return listener_.report(); }
  [[nodiscard]] RmpCounters counters() const;
  /// \return which needed message is awaited longest, and since when; nothing before all have come once.
  [[nodiscard]] std::optional<FeedbackAge::Oldest> oldest_feedback(MonoTime now) const { return listener_.oldest(now); }

 private:
  /// What was said last, and what there is to say.
  struct Speech {
    Twist wanted;
    std::optional<MonoTime> wanted_at;
    std::optional<MonoTime> tried_at;
    std::optional<MonoTime> turn;  // the next message may go
    std::optional<MonoTime> mode_asked_at;
    Command last;  // what the bus took last
    std::uint64_t commands = 0;
    std::uint64_t unsent = 0;
    bool refused = false;  // the last try was
    int full_in_a_row = 0;
  };

  void listen(MonoTime now);
  void judge(MonoTime now);
  [[nodiscard]] DriveFault standing_fault(MonoTime now);
  [[nodiscard]] DriveFailure failure() const;
  [[nodiscard]] Command motion_due(MonoTime now) const;
  [[nodiscard]] std::optional<OperationalMode> wanted_mode() const;
  [[nodiscard]] bool mode_due(MonoTime now) const;
  void speak(MonoTime now);

  std::unique_ptr<CanBus> bus_;
  RmpParameters parameters_;
  bool started_ = false;
  Listener listener_;
  Speech speech_;
  bool was_ready_ = false;
  DriveFault standing_ = DriveFault::kStarting;
  DriveFault latched_ = DriveFault::kNone;
  MonoTime now_{};
};

}  // namespace cgsr::hal::rmp
