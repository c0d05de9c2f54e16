#include "hal/replay/replay_camera.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <thread>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "hal/replay/bgr_to_yuyv.h"

namespace cgsr::hal {
namespace {

constexpr double kSlowest_hz = 0.1;
constexpr double kFastest_hz = 500.0;
constexpr double kUsual_hz = 30.0;
constexpr Duration kSlice = std::chrono::milliseconds(10);       // stop() is noticed this often while waiting for time
constexpr Duration kSlotSlice = std::chrono::microseconds(200);  // and this often while waiting for a slot

bool plausible(double rate_hz) {
  return rate_hz >= kSlowest_hz && rate_hz <= kFastest_hz;
}

}  // namespace

ReplayCamera::ReplayCamera(ReplayParameters parameters, Clock* clock)
    : parameters_(std::move(parameters)), clock_(clock) {}

// ---- starting ----------------------------------------------------------------------------------------------------------

Result<CameraMode> ReplayCamera::start() {
  const std::lock_guard lock(stream_mutex_);
  if (running_) return fail(fmt::format("replay of '{}': started twice", parameters_.path));
  try {
    return open();
  } catch (const std::exception& thrown) {  // OpenCV, memory
    return fail(fmt::format("replay of '{}': {}", parameters_.path, thrown.what()));
  }
}

Result<CameraMode> ReplayCamera::open() {
  if (auto good = check_parameters(); !good) return tl::unexpected(good.error());
  const MonoTime go_on = stamp();  // as fast as possible, stamps rise across a restart
  auto source = open_source(parameters_.path);
  if (!source) return tl::unexpected(source.error());
  source_ = std::move(*source);
  notes_ = source_->notes();
  if (auto found = find_mode(); !found) return tl::unexpected(found.error());
  if (auto shaped = pool_.shape(parameters_.slots, mode_.width_px, mode_.height_px); !shaped) {
    return tl::unexpected(shaped.error());
  }
  if (auto rewound = rewind_to_first(); !rewound) return tl::unexpected(rewound.error());
  remember({});
  sequence_ = 0;
  origin_ = parameters_.pace == ReplayPace::kOwnRate ? clock_->now() : go_on;
  running_ = true;
  return mode_;
}

Result<void> ReplayCamera::check_parameters() const {
  const auto& p = parameters_;
  const auto wrong = [&](const std::string& what) { return fail(fmt::format("replay of '{}': {}", p.path, what)); };
  if (p.pace == ReplayPace::kOwnRate && clock_ == nullptr) return wrong("its own rate needs a clock");
  if ((p.width_px == 0) != (p.height_px == 0)) return wrong("width_px and height_px go together");
  if (p.width_px < 0 || p.width_px > kLongestSide_px || p.width_px % 2 != 0 || p.height_px < 0 ||
      p.height_px > kLongestSide_px) {
    return wrong(fmt::format("cannot be scaled to {}x{}: up to {} on a side, the width even", p.width_px, p.height_px,
                             kLongestSide_px));
  }
  if (p.rate_hz != 0.0 && !plausible(p.rate_hz)) {
    return wrong(fmt::format("rate_hz = {} is not in {}..{} Hz", p.rate_hz, kSlowest_hz, kFastest_hz));
  }
  if (p.slots < 1 || p.slots > SlotPool::kMostSlots) {
    return wrong(fmt::format("slots = {} is not in 1..{}", p.slots, SlotPool::kMostSlots));
  }
  if (p.first < 0 || p.count < 0) return wrong("first and count cannot be negative");
  return {};
}

Result<void> ReplayCamera::find_mode() {
  stored_size_ = {};
  if (auto rewound = rewind_to_first(); !rewound) return rewound;
  int refused = 0;
  for (stage(Pixels::kWanted); staged_ == Staged::kRefused; stage(Pixels::kWanted)) {
    ++refused;
    pass_over();
  }
  if (staged_ == Staged::kEnd) {
    if (refused == 0) return fail(fmt::format("'{}' has no image {}", parameters_.path, parameters_.first));
    return fail(fmt::format("none of the {} images of '{}' can be read; the last: {}", refused, parameters_.path,
                            last_problem()));
  }
  stored_size_ = bgr_.size();
  const bool scales = parameters_.width_px > 0;
  mode_.width_px = scales ? parameters_.width_px : stored_size_.width / 2 * 2;
  mode_.height_px = scales ? parameters_.height_px : stored_size_.height;
  if (mode_.width_px < 2) return fail(fmt::format("'{}': images are one pixel wide", parameters_.path));
  if (mode_.width_px == stored_size_.width - 1) {
    notes_.push_back(
        fmt::format("images are {} px wide: the last column is dropped, YUYV has an even width", stored_size_.width));
  }
  auto period = frame_period();
  if (!period) return tl::unexpected(period.error());
  mode_.frame_period = *period;
  return {};
}

Result<Duration> ReplayCamera::frame_period() {
  double rate_hz = parameters_.rate_hz != 0.0 ? parameters_.rate_hz : source_->claimed_rate_hz();
  if (!plausible(rate_hz)) {
    if (rate_hz != 0.0)
      notes_.push_back(fmt::format("{} Hz claimed by the file is no rate: {} Hz", rate_hz, kUsual_hz));
    rate_hz = kUsual_hz;
  }
  return Duration{std::llround(1e9 / rate_hz)};
}

Result<void> ReplayCamera::rewind_to_first() {
  if (auto rewound = source_->rewind(); !rewound) return rewound;
  for (int i = 0; i < parameters_.first; ++i) {
    if (source_->skip() == ReadOutcome::kEnd) {
      return fail(fmt::format("'{}' has only {} images: none to begin with at first = {}", parameters_.path, i,
                              parameters_.first));
    }
  }
  taken_ = 0;
  good_this_round_ = false;
  staged_ = Staged::kNothing;
  return {};
}

// ---- reading -----------------------------------------------------------------------------------------------------------

// Makes sure that staged_ is not kNothing: the image of number sequence_ (in bgr_, if wanted), its refusal, or the end.
void ReplayCamera::stage(Pixels pixels) {
  if (staged_ != Staged::kNothing) return;
  staged_ = read_next(pixels);
  if (staged_ != Staged::kEnd || !parameters_.loop || !good_this_round_) return;
  if (auto rewound = rewind_to_first(); !rewound) {
    remember(rewound.error().message);
    staged_ = Staged::kEnd;
    return;
  }
  staged_ = read_next(pixels);
}

ReplayCamera::Staged ReplayCamera::read_next(Pixels pixels) {
  if (parameters_.count > 0 && taken_ >= parameters_.count) return Staged::kEnd;
  const ReadOutcome outcome = pixels == Pixels::kWanted ? source_->read(bgr_) : source_->skip();
  if (!source_->problem().empty()) remember(source_->problem());
  if (outcome == ReadOutcome::kEnd) return Staged::kEnd;
  ++taken_;
  if (outcome == ReadOutcome::kRefused) return Staged::kRefused;
  if (pixels == Pixels::kWanted && !size_is_right()) return Staged::kRefused;
  good_this_round_ = true;
  return Staged::kImage;
}

bool ReplayCamera::size_is_right() {
  const auto here = [&] {
    return fmt::format("'{}', image {} is {}x{}", parameters_.path, parameters_.first + taken_ - 1, bgr_.cols,
                       bgr_.rows);
  };
  if (bgr_.cols > kLongestSide_px || bgr_.rows > kLongestSide_px) {
    remember(fmt::format("{}: more than {} on a side is refused", here(), kLongestSide_px));
    return false;
  }
  if (stored_size_.area() > 0 && bgr_.size() != stored_size_) {
    remember(
        fmt::format("{}: the stream is {}x{} since its first image", here(), stored_size_.width, stored_size_.height));
    return false;
  }
  return true;
}

// The image that is staged, or comes next, is done with, delivered or not.
void ReplayCamera::pass_over() {
  staged_ = Staged::kNothing;
  ++sequence_;
}

// A driver's buffers hold as many images as there are slots; what came before those is gone.
void ReplayCamera::skip_overdue() {
  const MonoTime now = clock_->now();
  const Duration held = parameters_.slots * mode_.frame_period;
  const std::uint64_t from = sequence_;
  while (stamp() + held < now) {
    stage(Pixels::kUnwanted);
    if (staged_ == Staged::kEnd) break;
    pass_over();
  }
  if (sequence_ > from) {
    remember(fmt::format("images {} to {} are lost: nobody asked for them in time", from, sequence_ - 1));
  }
}

// ---- streaming ---------------------------------------------------------------------------------------------------------

tl::expected<ImageLease, CaptureFailure> ReplayCamera::next_image(MonoTime give_up_at) {
  const std::lock_guard lock(stream_mutex_);
  if (!running_) return tl::unexpected(CaptureFailure::kDisconnected);
  try {
    if (parameters_.pace == ReplayPace::kOwnRate) skip_overdue();
    stage(Pixels::kWanted);
    if (staged_ == Staged::kEnd) {
      return tl::unexpected(parameters_.loop ? CaptureFailure::kDisconnected : CaptureFailure::kEndOfStream);
    }
    if (auto due = wait_until_due(give_up_at); !due) return tl::unexpected(due.error());
    if (staged_ == Staged::kRefused) {
      pass_over();
      return tl::unexpected(CaptureFailure::kCorrupt);
    }
    auto slot = wait_for_slot(give_up_at);
    if (!slot) return tl::unexpected(slot.error());
    return lend(*slot);
  } catch (const std::exception& thrown) {  // OpenCV, memory
    remember(fmt::format("'{}', image {}: {}", parameters_.path, sequence_, thrown.what()));
    pass_over();
    return tl::unexpected(CaptureFailure::kCorrupt);
  }
}

tl::expected<void, CaptureFailure> ReplayCamera::wait_until_due(MonoTime give_up_at) {
  const MonoTime due = stamp();
  if (parameters_.pace == ReplayPace::kOwnRate) {
    const MonoTime end = std::min(due, give_up_at);
    for (MonoTime now = clock_->now(); now < end; now = clock_->now()) {
      if (!running_) return tl::unexpected(CaptureFailure::kDisconnected);
      const MonoTime wake_up_at = std::min(end, now + kSlice);
      clock_->sleep_until(wake_up_at);
      if (clock_->now() < wake_up_at) {
        remember("the simulated time has ended");
        return tl::unexpected(CaptureFailure::kEndOfStream);
      }
    }
  }
  if (!running_) return tl::unexpected(CaptureFailure::kDisconnected);
  if (due <= give_up_at) return {};
  return tl::unexpected(CaptureFailure::kTimeout);
}

tl::expected<int, CaptureFailure> ReplayCamera::wait_for_slot(MonoTime give_up_at) {
  if (const int slot = pool_.take(); slot >= 0) return slot;
  if (parameters_.pace == ReplayPace::kOwnRate) {
    remember(fmt::format("image {} is lost: all {} slots are on lease", sequence_, pool_.slots()));
    pass_over();
    return tl::unexpected(CaptureFailure::kNoSlot);
  }
  // Stamps are the time and stand still meanwhile: patience is counted in the host's.
  const auto began = std::chrono::steady_clock::now();
  const Duration patience = give_up_at - stamp();
  while (running_) {
    std::this_thread::sleep_for(kSlotSlice);
    if (const int slot = pool_.take(); slot >= 0) return slot;
    if (std::chrono::steady_clock::now() - began < patience) continue;
    remember(fmt::format("image {} waits: all {} slots are on lease", sequence_, pool_.slots()));
    return tl::unexpected(CaptureFailure::kTimeout);
  }
  return tl::unexpected(CaptureFailure::kDisconnected);
}

ImageLease ReplayCamera::lend(int slot) {
  ImageLease lease(pool_, slot, pool_.view(slot), sequence_, stamp());  // from here on the slot comes back by itself
  const cv::Mat* image = &bgr_;
  if (parameters_.width_px > 0 && bgr_.size() != cv::Size(mode_.width_px, mode_.height_px)) {
    const bool shrinks = mode_.width_px <= bgr_.cols && mode_.height_px <= bgr_.rows;
    cv::resize(bgr_, scaled_, {mode_.width_px, mode_.height_px}, 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
    image = &scaled_;
  }
  bgr_to_yuyv(image->data, static_cast<std::ptrdiff_t>(image->step[0]), mode_.width_px, mode_.height_px,
              pool_.pixels(slot), pool_.stride_bytes());
  pass_over();
  return lease;
}

void ReplayCamera::stop() {
  running_ = false;
}

void ReplayCamera::remember(std::string problem) {
  const std::lock_guard lock(problem_mutex_);
  problem_ = std::move(problem);
}

std::string ReplayCamera::last_problem() const {
  const std::lock_guard lock(problem_mutex_);
  return problem_;
}

}  // namespace cgsr::hal
