#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>

namespace cgsr {

template <class T>
class Pool;

/// A share in one value of a Pool: read-only, copyable, from any thread. The value returns to the pool with its last lease. Empty by default.
///
/// Copying and destroying never allocate and never block.
template <class T>
class Lease {
 public:
  Lease() = default;
  Lease(const Lease& other) noexcept : storage_(other.storage_), slot_(other.slot_) {
    // Relaxed: whoever copies holds a share already, so the count cannot reach zero meanwhile.
    if (slot_ != nullptr) slot_->shares.fetch_add(1, std::memory_order_relaxed);
  }
  Lease(Lease&& other) noexcept : storage_(std::move(other.storage_)), slot_(std::exchange(other.slot_, nullptr)) {}
  Lease& operator=(Lease other) noexcept {
    std::swap(storage_, other.storage_);
    std::swap(slot_, other.slot_);
    return *this;
  }
  ~Lease() {
    // Release: what this reader read is over before the pool's next taker, which acquires, writes.
    if (slot_ != nullptr) slot_->shares.fetch_sub(1, std::memory_order_release);
  }

  [[nodiscard]] explicit operator bool() const noexcept { return slot_ != nullptr; }
  const T& operator*() const noexcept { return slot_->value; }
  const T* operator->() const noexcept { return &slot_->value; }
  [[nodiscard]] const T* get() const noexcept { return slot_ == nullptr ? nullptr : &slot_->value; }

  /// The value for writing. Only for whoever took it from the pool, before the first copy of the lease is made.
  [[nodiscard]] T& edit() noexcept { return slot_->value; }

 private:
  friend class Pool<T>;
  struct Slot {
    explicit Slot(T v) : value(std::move(v)) {}
    T value;
    std::atomic<std::uint32_t> shares{0};
  };
  using Storage = std::deque<Slot>;

  Lease(std::shared_ptr<Storage> storage, Slot& slot) noexcept : storage_(std::move(storage)), slot_(&slot) {}

  std::shared_ptr<Storage> storage_;  // a lease may outlive its pool
  Slot* slot_ = nullptr;
};

/// A fixed number of large values (masks, label images) that one thread fills and others read: no copy and no allocation after construction.
///
/// Threads: take from one thread; leases anywhere.
template <class T>
class Pool {
 public:
  /// \param count  of values, each a copy of `prototype`; at least as many as are read at once, and one more to write.
  Pool(std::size_t count, const T& prototype) : storage_(std::make_shared<typename Lease<T>::Storage>()) {
    for (std::size_t i = 0; i < count; ++i) storage_->emplace_back(prototype);
  }

  /// \return a lease on a value that nobody reads, with its old content; empty when all are read.
  [[nodiscard]] Lease<T> take() noexcept {
    for (auto& slot : *storage_) {
      if (slot.shares.load(std::memory_order_acquire) != 0) continue;
      slot.shares.store(1, std::memory_order_relaxed);
      return Lease<T>(storage_, slot);
    }
    return {};
  }

 private:
  std::shared_ptr<typename Lease<T>::Storage> storage_;
};

}  // namespace cgsr
