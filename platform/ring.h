#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

namespace cgsr {

/// What a producer does with a value for which there is no room. Either way the newest is lost, it is counted, nobody
/// waits.
enum class Overflow : std::uint8_t {
  kRefuse,   ///< push says so and the value stays with the producer, who must look: a switch command, an image lease.
  kDiscard,  ///< push destroys it: what may be lossy by design, such as records for housekeeping.
};

struct RingStatistics {
  std::size_t capacity = 0;
  std::size_t high_water = 0;  ///< most values that lay in the ring at once, as the producer saw it: never too small.
  std::uint64_t pushed = 0;
  std::uint64_t dropped = 0;  ///< found no room.
  std::uint64_t skipped = 0;  ///< passed over by pop_newest.
};

/// One producer thread, one consumer thread, `kCapacity` values in a line between them. Lock-free, wait-free, no
/// allocation, no system call; values may be move-only. The storage is written at construction, so that no page of it
/// faults later.
///
/// Memory orders. `tail_` counts values ever pushed and is written by the producer alone, `head_` counts values ever
/// taken and is written by the consumer alone; 64 bits do not wrap in 500 years at 1 GHz. A value in slot i is handed
/// over twice:
///  (1) The producer builds the value, then stores tail_ with release. The consumer loads tail_ with acquire and only
///      then touches the slot: it sees the whole value.
///  (2) The consumer moves out and destroys the value, then stores head_ with release. The producer loads head_ with
///      acquire and only then builds into the slot again: the old value is gone for good before the new one is begun.
///
/// Each loads its own counter relaxed, since nobody else writes it. Statistics are relaxed: they order nothing.
///
/// Why not boost::lockfree::spsc_queue: it counts no drops and no high water, and leaves the policy to every caller.
template <class T, std::size_t kCapacity, Overflow kOverflow = Overflow::kRefuse>
class Ring {
  static_assert(kCapacity > 0);
  static_assert(std::is_nothrow_move_constructible_v<T> && std::is_nothrow_destructible_v<T>);

 public:
  Ring() = default;
  Ring(const Ring&) = delete;
  Ring& operator=(const Ring&) = delete;
  ~Ring() {
    while (pop()) {
    }
  }

  /// Producer. \return whether the value went in; when not, `value` is untouched and still the caller's.
  [[nodiscard]] bool push(T&& value) noexcept requires(kOverflow == Overflow::kRefuse) {
    return try_push(std::move(value));
  }

  /// Producer. Takes the value in any case; destroys it when the ring is full.
  void push(T value) noexcept requires(kOverflow == Overflow::kDiscard) {
    static_cast<void>(try_push(std::move(value)));
  }

  /// Consumer. \return the oldest value, nothing when the ring is empty.
  std::optional<T> pop() noexcept {
    const auto head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return std::nullopt;
    T* const place = slot(head);
    std::optional<T> value(std::move(*place));
    std::destroy_at(place);
    head_.store(head + 1, std::memory_order_release);
    return value;
  }

  /// Consumer. \return the newest value that is there; those before it are destroyed and counted as skipped.
  std::optional<T> pop_newest() noexcept {
    const auto tail = tail_.load(std::memory_order_acquire);
    for (auto head = head_.load(std::memory_order_relaxed); head + 1 < tail; ++head) {
      std::destroy_at(slot(head));
      head_.store(head + 1, std::memory_order_release);
      add_one(skipped_);
    }
    return pop();
  }

  /// Any thread; a snapshot whose figures may be one push apart from each other.
  [[nodiscard]] RingStatistics statistics() const noexcept {
    return {kCapacity, high_water_.load(std::memory_order_relaxed), tail_.load(std::memory_order_relaxed),
            dropped_.load(std::memory_order_relaxed), skipped_.load(std::memory_order_relaxed)};
  }

 private:
  struct Slot {
    alignas(T) std::array<std::byte, sizeof(T)> bytes;
  };
  static constexpr std::size_t kCacheLine = 64;

  T* slot(std::uint64_t count) noexcept {
    return std::launder(reinterpret_cast<T*>(slots_[count % kCapacity].bytes.data()));
  }

  /// One thread writes each count, so no read-modify-write is needed.
  static void add_one(std::atomic<std::uint64_t>& count) noexcept {
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  bool try_push(T&& value) noexcept {
    const auto tail = tail_.load(std::memory_order_relaxed);
    const auto used = static_cast<std::size_t>(tail - head_.load(std::memory_order_acquire));
    if (used == kCapacity) {
      add_one(dropped_);
      return false;
    }
    std::construct_at(slot(tail), std::move(value));
    if (used + 1 > high_water_.load(std::memory_order_relaxed)) high_water_.store(used + 1, std::memory_order_relaxed);
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  alignas(kCacheLine) std::atomic<std::uint64_t> tail_{0};  // this line is written by the producer
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::size_t> high_water_{0};
  alignas(kCacheLine) std::atomic<std::uint64_t> head_{0};  // this one by the consumer
  std::atomic<std::uint64_t> skipped_{0};
  alignas(kCacheLine) std::array<Slot, kCapacity> slots_{};
};

}  // namespace cgsr
