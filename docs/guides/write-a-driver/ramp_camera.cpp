#include "docs/guides/write-a-driver/ramp_camera.h"

#include <algorithm>

#include <fmt/format.h>

namespace cgsr::hal {
namespace {

constexpr int kSlots = 4;                     // one that is written, two held downstream, one in the ring
constexpr Duration kSlice = seconds(0.01);    // stop() ends a wait within 50 ms
constexpr std::uint8_t kNeutralChroma = 128;  // BT.601, limited range
constexpr int kBlack = 16;
constexpr int kLevels = 220;

}  // namespace

Result<CameraMode> RampCamera::start() {
  if (running_) return fail("the ramp camera is started already: stop it first");
  if (parameters_.width_px % 2 != 0) {
    return fail(fmt::format("the ramp camera's width is {} px: expected an even number (YUYV)", parameters_.width_px));
  }
  if (auto shaped = pool_.shape(kSlots, parameters_.width_px, parameters_.height_px); !shaped) {
    return tl::unexpected(shaped.error());
  }
  sequence_ = 0;
  due_ = clock_.now();
  running_ = true;
  return CameraMode{parameters_.width_px, parameters_.height_px, PixelFormat::kYuyv, period()};
}

tl::expected<ImageLease, CaptureFailure> RampCamera::next_image(MonoTime give_up_at) {
  if (!wait_until(std::min(due_, give_up_at))) return tl::unexpected(CaptureFailure::kDisconnected);
  if (due_ > give_up_at) return tl::unexpected(CaptureFailure::kTimeout);
  const MonoTime stamp = due_;
  const std::uint64_t sequence = sequence_++;
  due_ += period();
  const int slot = pool_.take();
  if (slot < 0) {
    const std::lock_guard lock(problem_mutex_);
    problem_ = fmt::format("image {}: all {} slots are on lease: it is lost", sequence, kSlots);
    return tl::unexpected(CaptureFailure::kNoSlot);
  }
  paint(pool_.pixels(slot), sequence);
  return ImageLease(pool_, slot, pool_.view(slot), sequence, stamp);
}

std::string RampCamera::last_problem() const {
  const std::lock_guard lock(problem_mutex_);
  return problem_;
}

/// \return false when the camera was stopped meanwhile.
bool RampCamera::wait_until(MonoTime end) {
  for (MonoTime now = clock_.now(); running_ && now < end; now = clock_.now()) {
    clock_.sleep_until(std::min(end, now + kSlice));
  }
  return running_;
}

void RampCamera::paint(std::uint8_t* pixels, std::uint64_t sequence) const {
  for (int y = 0; y < parameters_.height_px; ++y) {
    std::uint8_t* const row = pixels + y * pool_.stride_bytes();
    for (int x = 0; x < parameters_.width_px; ++x) {
      const auto level = (static_cast<std::uint64_t>(x) + sequence) % kLevels;
      row[2 * x] = static_cast<std::uint8_t>(kBlack + level);
      row[2 * x + 1] = kNeutralChroma;
    }
  }
}

}  // namespace cgsr::hal
