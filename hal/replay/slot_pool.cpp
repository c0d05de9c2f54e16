#include "hal/replay/slot_pool.h"

#include <bit>

#include <fmt/format.h>

namespace cgsr::hal {

Result<void> SlotPool::shape(int slots, int width_px, int height_px) {
  if (slots == slots_ && width_px == width_px_ && height_px == height_px_) return {};
  if (on_lease() > 0) {
    return fail(fmt::format("{} images of {}x{} are still on lease: they must end before images of {}x{} can come",
                            on_lease(), width_px_, height_px_, width_px, height_px));
  }
  constexpr std::ptrdiff_t kRowAlignment = 64;  // a row starts where a cache line would, relative to the first
  stride_bytes_ = (2 * std::ptrdiff_t{width_px} + kRowAlignment - 1) / kRowAlignment * kRowAlignment;
  slot_bytes_ = static_cast<std::size_t>(stride_bytes_) * static_cast<std::size_t>(height_px);
  pixels_.assign(slot_bytes_ * static_cast<std::size_t>(slots), 0);
  slots_ = slots;
  width_px_ = width_px;
  height_px_ = height_px;
  free_.store(slots == kMostSlots ? ~std::uint64_t{0} : (std::uint64_t{1} << slots) - 1, std::memory_order_release);
  return {};
}

int SlotPool::take() noexcept {
  const std::uint64_t free = free_.load(std::memory_order_acquire);
  if (free == 0) return -1;
  const int slot = std::countr_zero(free);
  free_.fetch_and(~(std::uint64_t{1} << slot), std::memory_order_relaxed);  // one taker: nobody else clears bits
  return slot;
}

void SlotPool::give_back(int slot) noexcept {
  free_.fetch_or(std::uint64_t{1} << slot, std::memory_order_release);
}

ImageView SlotPool::view(int slot) const {
  return {pixels_.data() + slot_bytes_ * static_cast<std::size_t>(slot), width_px_, height_px_, stride_bytes_,
          PixelFormat::kYuyv};
}

int SlotPool::on_lease() const noexcept {
  return slots_ - std::popcount(free_.load(std::memory_order_acquire));
}

}  // namespace cgsr::hal
