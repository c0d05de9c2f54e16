#include "hal/sim/home/simulated_camera.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <fmt/format.h>

namespace cgsr::sim {

using hal::CaptureFailure;

SimulatedCamera::SimulatedCamera(const hal::CameraMode& mode, Duration delay, MonoTime end,
                                 std::vector<CameraEventSpec> script, Draw draw, Now now)
    : mode_(mode), delay_(delay), end_(end), script_(std::move(script)), draw_(std::move(draw)), now_(std::move(now)) {
  const std::size_t bytes = 2 * static_cast<std::size_t>(mode.width_px) * static_cast<std::size_t>(mode.height_px);
  pixels_.assign(kSlots, std::vector<std::uint8_t>(bytes));
  freezes_ = std::any_of(script_.begin(), script_.end(),
                         [](const CameraEventSpec& event) { return event.what == CameraTrouble::kFrozen; });
}

Result<hal::CameraMode> SimulatedCamera::start() {
  if (started_) return fail("the simulated camera is already started");
  const MonoTime now = now_();
  if (happening(CameraTrouble::kGone, now) != nullptr) {
    return fail(fmt::format("the simulated camera is gone at {:.2f} s, by script", to_seconds(now.time_since_epoch())));
  }
  // What fell due while it was stopped was never exposed.
  while (stamp_of(next_) < now) ++next_;
  first_ = next_;
  problem_.clear();
  started_ = true;
  return mode_;
}

tl::expected<ImageLease, CaptureFailure> SimulatedCamera::next_image(MonoTime give_up_at) {
  if (!started_) return failure(CaptureFailure::kDisconnected, "the simulated camera is not started");
  for (;;) {
    const MonoTime stamp = stamp_of(next_);
    if (stamp >= end_) return failure(CaptureFailure::kEndOfStream, "the scenario is over");
    if (happening(CameraTrouble::kGone, std::min(stamp, give_up_at)) != nullptr) {
      return failure(CaptureFailure::kDisconnected, "the simulated camera is gone, by script");
    }
    const CameraEventSpec* late = happening(CameraTrouble::kLate, stamp);
    const MonoTime there_at = stamp + delay_ + (late != nullptr ? seconds(late->late_s) : Duration::zero());
    if (there_at > give_up_at) return failure(CaptureFailure::kTimeout, "no image is due by then");
    const std::uint64_t number = next_++;
    if (late != nullptr) {
      while (stamp_of(next_) + delay_ <= there_at) ++next_;
    }
    if (happening(CameraTrouble::kDropped, stamp) != nullptr) continue;
    if (happening(CameraTrouble::kCorrupt, stamp) != nullptr) {
      return failure(CaptureFailure::kCorrupt, fmt::format("image {} is corrupt, by script", number - first_));
    }
    return take(number);
  }
}

tl::expected<ImageLease, CaptureFailure> SimulatedCamera::take(std::uint64_t number) {
  const std::uint32_t free = free_.load(std::memory_order_acquire);
  if (free == 0) {
    return failure(CaptureFailure::kNoSlot, fmt::format("all {} slots are on lease: image {} is lost", kSlots, number));
  }
  const int slot = std::countr_zero(free);
  free_.fetch_and(~(1U << slot), std::memory_order_relaxed);  // one taker: nobody else clears bits
  auto& pixels = pixels_[static_cast<std::size_t>(slot)];
  const std::ptrdiff_t stride_bytes = std::ptrdiff_t{mode_.width_px} * 2;
  const bool frozen = happening(CameraTrouble::kFrozen, stamp_of(number)) != nullptr && !last_pixels_.empty();
  draw_(number, stamp_of(number), {pixels.data(), mode_.width_px, mode_.height_px, stride_bytes});
  if (frozen) {
    pixels = last_pixels_;
  } else if (freezes_) {
    last_pixels_ = pixels;
  }
  const ImageView view{pixels.data(), mode_.width_px, mode_.height_px, stride_bytes, PixelFormat::kYuyv};
  return ImageLease(*this, slot, view, number - first_, stamp_of(number));
}

const CameraEventSpec* SimulatedCamera::happening(CameraTrouble what, MonoTime at) const {
  const double at_s = to_seconds(at.time_since_epoch());
  const auto found = std::find_if(script_.begin(), script_.end(), [&](const CameraEventSpec& event) {
    return event.what == what && event.from_s <= at_s && at_s < event.to_s;
  });
  return found == script_.end() ? nullptr : &*found;
}

tl::expected<ImageLease, CaptureFailure> SimulatedCamera::failure(CaptureFailure failure, std::string words) {
  if (failure != CaptureFailure::kTimeout) problem_ = std::move(words);
  return tl::unexpected(failure);
}

void SimulatedCamera::give_back(int slot) noexcept {
  free_.fetch_or(1U << static_cast<unsigned>(slot), std::memory_order_release);
}

}  // namespace cgsr::sim
