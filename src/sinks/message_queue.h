#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cgsr::sinks {

/// Messages of any length from one thread to one other, in order, in one block of memory that is allocated and touched at construction.
/// Lock-free; nobody waits: a message that finds no room is the producer's to count.
///
/// A message lies in one piece, behind its length; where the end of the block is too near, a mark sends the reader to the start.
/// Memory orders: `tail_` counts bytes ever committed and is written by the producer alone, with release after the message is
/// complete; the consumer loads it with acquire before it reads. `head_` counts bytes ever taken, the same the other way
/// round: the producer writes where the consumer has finished reading (as in platform/ring.h).
class MessageQueue {
 public:
  /// \param capacity_bytes  rounded up to 8, at least 64. A message of up to half of it always fits into an empty queue.
  explicit MessageQueue(std::size_t capacity_bytes);
  MessageQueue(const MessageQueue&) = delete;
  MessageQueue& operator=(const MessageQueue&) = delete;

  /// Producer. \return where to write a message of this length; nullptr: no room. commit() hands it over, another reserve() forgets it.
  std::uint8_t* reserve(std::size_t bytes) noexcept;
  void commit() noexcept;

  /// Consumer. \return the oldest message, valid until pop(); its data() is nullptr when there is none.
  std::span<const std::uint8_t> front() noexcept;
  void pop() noexcept;

  [[nodiscard]] std::size_t capacity() const { return block_.size(); }

 private:
  alignas(64) std::atomic<std::uint64_t> tail_{0};
  std::uint64_t reserved_tail_ = 0;  // of the producer: what commit() stores
  std::vector<std::uint8_t> block_;
  alignas(64) std::atomic<std::uint64_t> head_{0};
  std::uint64_t next_head_ = 0;  // of the consumer: what pop() stores
};

}  // namespace cgsr::sinks
