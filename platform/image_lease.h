#pragma once

#include <cstdint>
#include <utility>

#include "platform/image_view.h"
#include "platform/time.h"

namespace cgsr {

/// Who lends images out and takes their slots back.
class ImageLender {
 public:
  virtual ~ImageLender() = default;

  /// Takes slot `slot` back. Threads: any; never blocks, never allocates.
  virtual void give_back(int slot) noexcept = 0;
};

/// The right to read one image where the camera put it, until the lease ends. Move-only; giving back is its destructor's work.
/// Whoever wants to keep the pixels copies them, off the frame path.
class ImageLease {
 public:
  ImageLease() = default;
  ImageLease(ImageLender& lender, int slot, const ImageView& view, std::uint64_t sequence, MonoTime stamp)
      : lender_(&lender), slot_(slot), view_(view), sequence_(sequence), stamp_(stamp) {}
  ImageLease(ImageLease&& other) noexcept { swap(other); }
  ImageLease& operator=(ImageLease&& other) noexcept {
    ImageLease(std::move(other)).swap(*this);
    return *this;
  }
  ImageLease(const ImageLease&) = delete;
  ImageLease& operator=(const ImageLease&) = delete;
  ~ImageLease() {
    if (lender_ != nullptr) lender_->give_back(slot_);
  }

  [[nodiscard]] explicit operator bool() const { return lender_ != nullptr; }
  [[nodiscard]] const ImageView& view() const { return view_; }
  /// Counts the images of the camera from 0, lost ones included: a gap is a loss.
  [[nodiscard]] std::uint64_t sequence() const { return sequence_; }
  /// Start of the exposure.
  [[nodiscard]] MonoTime stamp() const { return stamp_; }

 private:
  void swap(ImageLease& other) noexcept {
    std::swap(lender_, other.lender_);
    std::swap(slot_, other.slot_);
    std::swap(view_, other.view_);
    std::swap(sequence_, other.sequence_);
    std::swap(stamp_, other.stamp_);
  }

  ImageLender* lender_ = nullptr;
  int slot_ = -1;
  ImageView view_;
  std::uint64_t sequence_ = 0;
  MonoTime stamp_{};
};

}  // namespace cgsr
