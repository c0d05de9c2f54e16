#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "platform/image_lease.h"

namespace cgsr::hal::v4l2 {

/// Who owns each of up to 32 image buffers: the camera (queued in the driver or free), or a reader who has it on lease.
///
/// Threads: lend and take_returned from the capture side; give_back from anywhere, lock-free. The capture side may end this once any_on_lease()
/// is false: no give_back is under way then.
class ImageSlots final : public ImageLender {
 public:
  /// \param wake  called by give_back when nothing is left to the camera; must neither block nor allocate.
  explicit ImageSlots(std::function<void()> wake) : wake_(std::move(wake)) {}

  void lend(int slot) { on_lease_.fetch_or(bit(slot), std::memory_order_relaxed); }

  void give_back(int slot) noexcept override {
    // Who is in here counts until the last thing that is touched: a slot that is seen as returned was counted before.
    giving_back_.fetch_add(1, std::memory_order_relaxed);
    // Sequentially consistent with the capture side's order, which first says that it starves and then looks: one of
    // the two sees the other.
    returned_.fetch_or(bit(slot), std::memory_order_seq_cst);
    if (starving_.load(std::memory_order_seq_cst)) wake_();
    giving_back_.fetch_sub(1, std::memory_order_release);  // pairs with any_on_lease(); the last access
  }

  /// \return the slots that came back since the last call, a bit each. Whatever their readers did is over.
  std::uint32_t take_returned() {
    const std::uint32_t back = returned_.exchange(0, std::memory_order_seq_cst);
    on_lease_.fetch_and(~back, std::memory_order_relaxed);
    return back;
  }

  /// \return whether a reader has the slot, or had it until after the last take_returned(). For the capture side.
  [[nodiscard]] bool on_lease(int slot) const { return (on_lease_.load(std::memory_order_relaxed) & bit(slot)) != 0; }

  /// The capture side waits for a slot from now on, or no longer.
  void set_starving(bool starving) { starving_.store(starving, std::memory_order_seq_cst); }

  /// \return whether a reader still has a slot, or is still about to give one back. For the capture side.
  [[nodiscard]] bool any_on_lease() const {
    // The slots first: whoever returned one of them is seen in the count (acquire, with the release of returned_), until
    // it is out (acquire, with the release of the decrement).
    if ((on_lease_.load(std::memory_order_relaxed) & ~returned_.load(std::memory_order_acquire)) != 0) return true;
    return giving_back_.load(std::memory_order_acquire) != 0;
  }

 private:
  static constexpr std::uint32_t bit(int slot) { return std::uint32_t{1} << slot; }

  std::function<void()> wake_;
  std::atomic<std::uint32_t> on_lease_{0};
  std::atomic<std::uint32_t> returned_{0};
  std::atomic<bool> starving_{false};
  std::atomic<int> giving_back_{0};
};

}  // namespace cgsr::hal::v4l2
