#include "src/sinks/message_queue.h"

#include <algorithm>
#include <cstring>

namespace cgsr::sinks {
namespace {

constexpr std::uint64_t kLengthBytes = 8;
constexpr std::uint64_t kGoToStart = ~std::uint64_t{0};

constexpr std::uint64_t rounded(std::uint64_t bytes) {
  return (bytes + 7) / 8 * 8;
}

}  // namespace

MessageQueue::MessageQueue(std::size_t capacity_bytes) : block_(rounded(std::max<std::size_t>(capacity_bytes, 64))) {}

std::uint8_t* MessageQueue::reserve(std::size_t bytes) noexcept {
  const std::uint64_t capacity = block_.size();
  if (bytes > capacity) return nullptr;
  const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
  const std::uint64_t used = tail - head_.load(std::memory_order_acquire);
  const std::uint64_t need = kLengthBytes + rounded(bytes);
  const std::uint64_t to_end = capacity - tail % capacity;
  const std::uint64_t skipped = to_end < need ? to_end : 0;
  if (used + skipped + need > capacity) return nullptr;
  if (skipped > 0) std::memcpy(&block_[tail % capacity], &kGoToStart, kLengthBytes);
  std::uint8_t* const place = &block_[(tail + skipped) % capacity];
  const std::uint64_t length = bytes;
  std::memcpy(place, &length, kLengthBytes);
  reserved_tail_ = tail + skipped + need;
  return place + kLengthBytes;
}

void MessageQueue::commit() noexcept {
  tail_.store(reserved_tail_, std::memory_order_release);
}

std::span<const std::uint8_t> MessageQueue::front() noexcept {
  const std::uint64_t capacity = block_.size();
  std::uint64_t head = head_.load(std::memory_order_relaxed);
  if (head == tail_.load(std::memory_order_acquire)) return {};
  std::uint64_t length = 0;
  std::memcpy(&length, &block_[head % capacity], kLengthBytes);
  if (length == kGoToStart) {
    head += capacity - head % capacity;
    std::memcpy(&length, block_.data(), kLengthBytes);
  }
  next_head_ = head + kLengthBytes + rounded(length);
  return {&block_[head % capacity] + kLengthBytes, length};
}

void MessageQueue::pop() noexcept {
  head_.store(next_head_, std::memory_order_release);
}

}  // namespace cgsr::sinks
