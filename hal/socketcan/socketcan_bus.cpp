#include "hal/socketcan/socketcan_bus.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fmt/format.h>

#include "hal/socketcan/controller_state.h"

namespace cgsr::hal::socketcan {
namespace {

constexpr int kMaxOtherFrames = 1024;  // error frames in a row before the next call goes on

can_frame to_kernel(const CanFrame& frame) {
  can_frame out{};
  out.can_id = frame.id & CAN_SFF_MASK;
  out.can_dlc = std::min<std::uint8_t>(frame.size, CAN_MAX_DLEN);
  std::copy_n(frame.data.begin(), out.can_dlc, std::begin(out.data));
  return out;
}

CanFrame from_kernel(const RawFrame& raw) {
  CanFrame frame;
  frame.id = static_cast<std::uint16_t>(raw.frame.can_id & CAN_SFF_MASK);
  frame.size = std::min<std::uint8_t>(raw.frame.can_dlc, CAN_MAX_DLEN);
  std::copy_n(std::begin(raw.frame.data), frame.size, frame.data.begin());
  frame.stamp = raw.stamp;
  return frame;
}

bool queue_is_full(int error) {
  return error == ENOBUFS || error == EAGAIN || error == EWOULDBLOCK;
}

}  // namespace

SocketCanBus::SocketCanBus(SocketCanParameters parameters, const std::vector<IdFilter>& filters,
                           std::unique_ptr<CanSocket> socket)
    : parameters_(std::move(parameters)), socket_(std::move(socket)) {
  // The flags belong to the mask: neither 29-bit ids nor remote frames look like ours.
  constexpr canid_t kFlags = CAN_EFF_FLAG | CAN_RTR_FLAG;
  for (const IdFilter& filter : filters) filters_.push_back({filter.id, filter.mask | kFlags});
}

SocketCanBus::~SocketCanBus() {
  stop();
}

Result<void> SocketCanBus::start() {
  const std::string& name = parameters_.interface;
  if (started_) return fail(fmt::format("CAN: '{}' is started already", name));
  if (auto opened = socket_->open(name, filters_); !opened) return opened;
  const LinkReport link = socket_->report(name);
  if (link.known && parameters_.bit_rate != 0 && link.bit_rate != static_cast<std::uint32_t>(parameters_.bit_rate)) {
    socket_->close();
    return fail(
        fmt::format("CAN: '{0}' runs at {1} bit/s, expected {2}: `ip link set {0} down; ip link set {0} up type "
                    "can bitrate {2}`",
                    name, link.bit_rate, parameters_.bit_rate));
  }
  counters_ = {};
  state_ = CanState::kActive;
  if (link.known) enter(to_state(link.can_state));
  last_error_ = 0;
  socket_lost_ = 0;
  early_.reset();
  drained_until_ = last_stamp_ = MonoTime::min();
  reopen_at_.reset();
  restart_at_.reset();
  restarts_in_window_ = 0;
  restart_error_.store(0, std::memory_order_relaxed);
  quit_.store(false, std::memory_order_relaxed);
  restarter_ = std::thread([this] { restart_loop(); });
  started_ = true;
  return {};
}

void SocketCanBus::stop() {
  if (!started_) return;
  started_ = false;
  socket_->close();  // what send() took is the interface's and still goes out
  quit_.store(true, std::memory_order_relaxed);
  restart_wanted_.wake();
  restarter_.join();
}

// ---- state --------------------------------------------------------------------------------------------------------------

void SocketCanBus::enter(CanState state) {
  if (state == state_) return;
  if (state_ == CanState::kBusOff && state != CanState::kGone) ++counters_.restarts;
  if (state == CanState::kBusOff) ++counters_.bus_off;
  if (state == CanState::kPassive) ++counters_.error_passive;
  if (state != CanState::kBusOff) restart_at_.reset();
  state_ = state;
}

void SocketCanBus::lose(int error) {
  last_error_ = error;
  enter(CanState::kGone);
}

void SocketCanBus::take_error_frame(const can_frame& frame) {
  const ErrorNews news = read_error_frame(frame);
  if (news.overrun) ++counters_.lost;
  if (news.state) enter(*news.state);
}

/// Brings back what can be brought back, as often as allowed.
void SocketCanBus::look_after(MonoTime now) {
  if (state_ == CanState::kBusOff) return restart_if_due(now);
  if (state_ != CanState::kGone) return;
  if (!reopen_at_) reopen_at_ = now + seconds(parameters_.reopen_wait_s);
  if (now < *reopen_at_) return;
  reopen_at_ = now + seconds(parameters_.reopen_wait_s);
  if (!socket_->open(parameters_.interface, filters_)) return;
  reopen_at_.reset();
  early_.reset();
  socket_lost_ = 0;
  drained_until_ = now;
  enter(CanState::kActive);  // if it is worse, error frames tell
}

void SocketCanBus::restart_if_due(MonoTime now) {
  if (now - window_began_ > seconds(parameters_.restart_window_s) && !restart_at_) {
    window_began_ = now;
    restarts_in_window_ = 0;
  }
  if (restarts_in_window_ >= parameters_.max_restarts) return;
  if (!restart_at_) {
    if (restarts_in_window_ == 0) window_began_ = now;
    restart_at_ = now + seconds(parameters_.restart_wait_s) * (std::int64_t{1} << std::min(restarts_in_window_, 10));
  }
  if (now < *restart_at_) return;
  restart_at_.reset();
  ++restarts_in_window_;
  restart_wanted_.wake();  // an error frame tells whether it took
}

void SocketCanBus::restart_loop() {
  for (;;) {
    restart_wanted_.wait();
    if (quit_.load(std::memory_order_relaxed)) return;
    restart_error_.store(socket_->restart(parameters_.interface), std::memory_order_relaxed);
  }
}

// ---- frames -------------------------------------------------------------------------------------------------------------

tl::expected<void, CanSendFailure> SocketCanBus::send(const CanFrame& frame) {
  const auto refuse = [this](CanSendFailure failure) {
    ++counters_.refused;
    return tl::unexpected(failure);
  };
  if (!started_ || state_ == CanState::kGone) return refuse(CanSendFailure::kGone);
  if (state_ == CanState::kBusOff) return refuse(CanSendFailure::kBusOff);
  const int error = socket_->send(to_kernel(frame));
  if (error == 0) {
    ++counters_.sent;
    return {};
  }
  if (queue_is_full(error)) return refuse(CanSendFailure::kQueueFull);
  lose(error);
  return refuse(CanSendFailure::kGone);
}

/// \return whether a data frame was read; error frames on the way change the state.
bool SocketCanBus::next_frame(CanFrame& into) {
  for (int other = 0; other < kMaxOtherFrames; ++other) {
    RawFrame raw;
    const int error = socket_->receive(raw);
    if (error == EAGAIN || error == EWOULDBLOCK || error == EINTR) return false;
    if (error == EBADMSG) continue;  // no classic frame
    if (error != 0) {
      lose(error);
      return false;
    }
    if (raw.lost > socket_lost_) {
      counters_.lost += raw.lost - socket_lost_;
      socket_lost_ = raw.lost;
    }
    if ((raw.frame.can_id & CAN_ERR_FLAG) != 0) {
      take_error_frame(raw.frame);
      continue;
    }
    if ((raw.frame.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG)) != 0) continue;
    into = from_kernel(raw);
    return true;
  }
  return false;
}

std::size_t SocketCanBus::receive(MonoTime until, std::span<CanFrame> into) {
  if (!started_) return 0;
  std::size_t count = 0;
  while (count < into.size() && state_ != CanState::kGone) {
    CanFrame frame;
    if (early_) {
      frame = *early_;
      early_.reset();
    } else if (!next_frame(frame)) {
      drained_until_ = std::max(drained_until_, until);
      break;
    }
    // It did not arrive before the socket was last found empty, whatever a wall clock that was set makes of its stamp.
    frame.stamp = std::max({frame.stamp, drained_until_, last_stamp_});
    if (frame.stamp > until) {
      early_ = frame;
      break;
    }
    last_stamp_ = frame.stamp;
    into[count++] = frame;
  }
  counters_.received += count;
  look_after(until);
  return count;
}

}  // namespace cgsr::hal::socketcan
