#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "platform/error.h"
#include "platform/image_lease.h"

namespace cgsr::hal {

/// The pixels that a camera without a driver of its own lends out: YUYV slots of one size, allocated and touched once.
///
/// Threads: shape and take from the camera's side, one at a time; give_back from anywhere, lock-free.
class SlotPool final : public ImageLender {
 public:
  static constexpr int kMostSlots = 64;

  /// Makes `slots` (1..64) slots of one size. \return an error when the size changes while slots are on lease.
  Result<void> shape(int slots, int width_px, int height_px);

  /// \return a free slot, or -1 when all are on lease.
  [[nodiscard]] int take() noexcept;
  void give_back(int slot) noexcept override;

  [[nodiscard]] std::uint8_t* pixels(int slot) { return pixels_.data() + slot_bytes_ * static_cast<std::size_t>(slot); }
  [[nodiscard]] ImageView view(int slot) const;
  [[nodiscard]] std::ptrdiff_t stride_bytes() const { return stride_bytes_; }
  [[nodiscard]] int slots() const { return slots_; }
  [[nodiscard]] int on_lease() const noexcept;

 private:
  int slots_ = 0;
  int width_px_ = 0;
  int height_px_ = 0;
  std::ptrdiff_t stride_bytes_ = 0;
  std::size_t slot_bytes_ = 0;
  std::vector<std::uint8_t> pixels_;
  // Bit i: slot i is free. give_back releases what the reader did with the pixels, take acquires it: no write of the next
  // image can be seen by the reader of the last one.
  std::atomic<std::uint64_t> free_{0};
};

}  // namespace cgsr::hal
