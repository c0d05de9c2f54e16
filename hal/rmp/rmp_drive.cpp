#include "hal/rmp/rmp_drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hal/rmp/codec.h"
#include "hal/rmp/scales.h"

namespace cgsr::hal::rmp {
namespace {

constexpr Duration kCommandGap = seconds(0.010);    // the base wants them no faster, in the mean
constexpr Duration kCycleJitter = seconds(0.0005);  // a control cycle that begins so much early has its turn
constexpr Duration kRepeatAfter = seconds(0.100);   // and no slower than every 0.3 s
constexpr Duration kModeAskedAgain = seconds(0.500);
constexpr Duration kIntruderStays =
    seconds(1.000);  // one message of another commander, or of a base that is off, counts so long
constexpr std::size_t kFramesAtOnce = 32;
constexpr int kMostReadings = 256;  // 8192 frames, seconds of a full bus: only a bus that never ends is cut off

bool is_zero(const Twist& twist) {
  return twist.forward_mps == 0.0 && twist.left_radps == 0.0;
}

}  // namespace

RmpDrive::RmpDrive(std::unique_ptr<CanBus> bus, const RmpParameters& parameters)
    : bus_(std::move(bus)), parameters_(parameters), listener_(parameters) {}

RmpDrive::~RmpDrive() {
  stop();
}

Result<void> RmpDrive::start() {
  if (started_) return fail("the RMP is started already");
  if (auto joined = bus_->start(); !joined) return joined;
  started_ = true;
  listener_ = Listener(parameters_);
  speech_ = Speech{};
  was_ready_ = false;
  standing_ = DriveFault::kStarting;
  latched_ = DriveFault::kNone;
  return {};
}

tl::expected<void, DriveFailure> RmpDrive::command(const Twist& twist, MonoTime now) {
  if (!started_) return tl::unexpected(DriveFailure::kNotStarted);
  if (!std::isfinite(twist.forward_mps) || !std::isfinite(twist.left_radps)) {
    return tl::unexpected(DriveFailure::kSendFailed);
  }
  listen(now);
  judge(now);
  speech_.wanted = twist;
  speech_.wanted_at = now;
  speak(now);
  judge(now);  // to speak may have shown that nobody takes it
  if (standing_ != DriveFault::kNone) return tl::unexpected(failure());
  if (speech_.refused) return tl::unexpected(DriveFailure::kSendFailed);
  if (latched_ != DriveFault::kNone && !is_zero(twist)) return tl::unexpected(DriveFailure::kNotReady);
  return {};
}

tl::expected<Odometry, DriveFailure> RmpDrive::odometry(MonoTime now) {
  if (!started_) return tl::unexpected(DriveFailure::kNotStarted);
  listen(now);
  judge(now);
  // What is new (a stop above all) goes out at once, the same again only in time.
  const bool something_new = speech_.commands == 0 || motion_due(now) != speech_.last;
  const bool time_to_repeat = !speech_.tried_at || now - *speech_.tried_at >= kRepeatAfter;
  if (speech_.wanted_at && (mode_due(now) || something_new || time_to_repeat)) speak(now);

  if (!listener_.complete() || listener_.stale(now)) return tl::unexpected(DriveFailure::kNoFeedback);
  return listener_.odometry();
}

void RmpDrive::stop() {
  if (!started_) return;
  if (speech_.wanted_at) {
    CanFrame zero = encode(Command{});
    zero.stamp = now_;
    (void)bus_->send(zero);  // refused: nothing more can be done, the base stops by itself
  }
  bus_->stop();
  started_ = false;
}

tl::expected<void, DriveFault> RmpDrive::rearm(MonoTime now) {
  if (!started_) return tl::unexpected(DriveFault::kStarting);
  listen(now);
  judge(now);
  // A base that was switched on with its emergency stop open has not been asked for its mode: it is now.
  const bool lacks_mode_alone = standing_ == DriveFault::kMotorsOff && !was_ready_ && wanted_mode();
  if (standing_ == DriveFault::kNone || lacks_mode_alone) latched_ = DriveFault::kNone;
  if (standing_ != DriveFault::kNone) return tl::unexpected(standing_);
  speech_.wanted = Twist{};  // what was asked for before is forgotten
  return {};
}

RmpCounters RmpDrive::counters() const {
  return {.feedback = listener_.counters(),
          .bus = bus_->counters(),
          .commands = speech_.commands,
          .unsent = speech_.unsent};
}

void RmpDrive::listen(MonoTime now) {
  now_ = now;
  std::array<CanFrame, kFramesAtOnce> frames;
  for (int reading = 0; reading < kMostReadings; ++reading) {
    const std::size_t count = bus_->receive(now, frames);
    for (std::size_t i = 0; i < count; ++i) listener_.take(frames[i], std::min(frames[i].stamp, now));
    if (count < frames.size()) return;
  }
}

void RmpDrive::judge(MonoTime now) {
  standing_ = standing_fault(now);
  if (standing_ == DriveFault::kNone) was_ready_ = true;
  if (standing_ == DriveFault::kNone || standing_ == DriveFault::kStarting) return;
  listener_.break_series();
  const bool asleep = standing_ == DriveFault::kPoweredOff || standing_ == DriveFault::kFeedbackLost ||
                      standing_ == DriveFault::kMotorsOff;
  // The first fault stays, but lost feedback gives way to what explains it.
  const bool says_more = latched_ == DriveFault::kNone || latched_ == DriveFault::kFeedbackLost;
  if (says_more && (was_ready_ || !asleep)) latched_ = standing_;
}

DriveFault RmpDrive::standing_fault(MonoTime now) {
  const bool stale = listener_.stale(now);
  const auto recent = [now](const std::optional<MonoTime>& stamp) { return stamp && now - *stamp < kIntruderStays; };
  if (bus_->state() == CanState::kBusOff) return DriveFault::kBusOff;
  if (bus_->state() == CanState::kGone) return DriveFault::kLinkLost;
  if (speech_.full_in_a_row >= parameters_.max_refusals) return DriveFault::kLinkLost;
  if (recent(listener_.foreign_command_at())) return DriveFault::kSecondCommander;
  if (recent(listener_.powered_off_at())) return DriveFault::kPoweredOff;
  if (stale) return DriveFault::kFeedbackLost;
  if (!listener_.complete()) return DriveFault::kStarting;
  if (const auto fault = reported_fault(listener_.report()); fault != DriveFault::kNone) return fault;
  if (listener_.yaw_check() == YawCheck::Verdict::kContradicts) return DriveFault::kYawContradiction;
  if (const auto mode = wanted_mode(); mode && *mode != listener_.report().power.mode) return DriveFault::kMotorsOff;
  return listener_.sets_in_a_row() < parameters_.min_ready_sets ? DriveFault::kStarting : DriveFault::kNone;
}

DriveFailure RmpDrive::failure() const {
  switch (standing_) {
    case DriveFault::kBusOff:
    case DriveFault::kLinkLost:
      return DriveFailure::kSendFailed;
    case DriveFault::kFeedbackLost:
      return DriveFailure::kNoFeedback;
    case DriveFault::kStarting:
      return listener_.complete() ? DriveFailure::kNotReady : DriveFailure::kNoFeedback;
    default:
      return DriveFailure::kNotReady;
  }
}

Command RmpDrive::motion_due(MonoTime now) const {
  const bool holds = speech_.wanted_at && now - *speech_.wanted_at <= seconds(parameters_.hold_s);
  return holds && fault() == DriveFault::kNone ? to_command(speech_.wanted, parameters_.scales) : Command{};
}

std::optional<OperationalMode> RmpDrive::wanted_mode() const {
  switch (parameters_.mode_at_start) {
    case ModeAtStart::kTractor:
      return OperationalMode::kTractor;
    case ModeAtStart::kBalance:
      return OperationalMode::kBalance;
    case ModeAtStart::kKeep:
      break;
  }
  return std::nullopt;
}

bool RmpDrive::mode_due(MonoTime now) const {
  // Only of a base that wakes up and is well: later a person is to look at it first.
  if (was_ready_ || latched_ != DriveFault::kNone || standing_ != DriveFault::kMotorsOff || !wanted_mode())
    return false;
  return !speech_.mode_asked_at || now - *speech_.mode_asked_at >= kModeAskedAgain;
}

void RmpDrive::speak(MonoTime now) {
  if (speech_.turn && now + kCycleJitter < *speech_.turn) return;  // has to wait for its turn
  Command command = motion_due(now);
  if (mode_due(now)) {
    command = {.configuration = static_cast<std::uint16_t>(Configuration::kOperationalMode),
               .parameter = static_cast<std::uint16_t>(*wanted_mode())};
    speech_.mode_asked_at = now;
  }
  CanFrame frame = encode(command);
  frame.stamp = now;
  speech_.tried_at = now;
  speech_.turn = std::max(now, speech_.turn.value_or(now)) + kCommandGap;
  const auto sent = bus_->send(frame);
  speech_.refused = !sent;
  if (!sent) {
    ++speech_.unsent;
    if (sent.error() == CanSendFailure::kQueueFull) ++speech_.full_in_a_row;
    return;
  }
  ++speech_.commands;
  speech_.full_in_a_row = 0;
  speech_.last = command;
  listener_.said(command);
}

}  // namespace cgsr::hal::rmp
