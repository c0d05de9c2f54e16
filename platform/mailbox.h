#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

namespace cgsr {

/// The latest value from one writer thread to one reader thread: a triple buffer. Both sides are wait-free, whatever
/// the other does; values may be move-only. A value that a newer one overtook unread is destroyed by the writer at once
/// and counted, so that a lease in it is given back then and not later.
///
/// Memory orders. The three slots belong to the writer (`back_`), the reader (`front_`) and to nobody (`middle_`, which
/// also says whether its value is fresh). Owning a slot means being the only one to touch it, and slots change hands in
/// one place: an exchange on `middle_`. Both sides exchange with acquire-release. The release half publishes everything
/// done to the slot given away (the writer's new value, the reader's emptying); the acquire half, reading what the
/// partner's exchange released, makes that visible before the slot received is touched. The reader's first look at the
/// fresh flag is relaxed: it only decides whether to exchange, and the exchange orders.
template <class T>
class Mailbox {
  static_assert(std::is_nothrow_move_constructible_v<T> && std::is_nothrow_destructible_v<T>);

 public:
  Mailbox() = default;
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  /// Writer. Replaces whatever was there.
  void put(T value) noexcept {
    slots_[back_].emplace(std::move(value));
    const auto received = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel);
    back_ = received & kIndex;
    slots_[back_].reset();
    if ((received & kFresh) != 0) add_one(overtaken_);
    add_one(written_);
  }

  /// Reader. \return the newest value if it has not been taken or seen yet.
  std::optional<T> take() noexcept {
    if (!refresh()) return std::nullopt;
    return std::exchange(slots_[front_], std::nullopt);
  }

  /// Reader. \return the newest value, seen before or not; nullptr before the first and after take(). Valid until the
  /// next call of the reader.
  const T* latest() noexcept {
    refresh();
    return slots_[front_] ? &*slots_[front_] : nullptr;
  }

  /// Any thread: values ever put, and values that a newer one replaced before the reader came.
  [[nodiscard]] std::uint64_t written() const noexcept { return written_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t overtaken() const noexcept { return overtaken_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::uint32_t kIndex = 3;
  static constexpr std::uint32_t kFresh = 4;

  /// \return whether the front slot now holds a value that was not there before.
  bool refresh() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    slots_[front_].reset();
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }

  static void add_one(std::atomic<std::uint64_t>& count) noexcept {
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  std::array<std::optional<T>, 3> slots_{};
  alignas(64) std::atomic<std::uint32_t> middle_{1};
  alignas(64) std::uint32_t back_ = 0;  // the writer's
  std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> overtaken_{0};
  alignas(64) std::uint32_t front_ = 2;  // the reader's
};

}  // namespace cgsr
