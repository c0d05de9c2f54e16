#include "hal/replay/slot_pool.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <random>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace cgsr::hal {
namespace {

TEST(SlotPool, LendsEverySlotOnceAndThenNone) {
  for (const int slots : {1, 6, SlotPool::kMostSlots}) {
    SlotPool pool;
    ASSERT_TRUE(pool.shape(slots, 32, 8));
    std::set<int> taken;
    for (int i = 0; i < slots; ++i) taken.insert(pool.take());
    EXPECT_EQ(taken.size(), static_cast<std::size_t>(slots));
    EXPECT_EQ(*taken.begin(), 0);
    EXPECT_EQ(*taken.rbegin(), slots - 1);
    EXPECT_EQ(pool.take(), -1);
    EXPECT_EQ(pool.on_lease(), slots);
    pool.give_back(slots / 2);
    EXPECT_EQ(pool.take(), slots / 2);
  }
}

TEST(SlotPool, SlotsDoNotOverlap) {
  SlotPool pool;
  ASSERT_TRUE(pool.shape(3, 10, 4));
  for (int slot = 0; slot < 3; ++slot) {
    const ImageView view = pool.view(slot);
    EXPECT_EQ(view.width_px, 10);
    EXPECT_GE(view.stride_bytes, 20);
    std::memset(pool.pixels(slot), slot + 1, static_cast<std::size_t>(view.stride_bytes * view.height_px));
  }
  for (int slot = 0; slot < 3; ++slot) {
    EXPECT_EQ(pool.view(slot).row(0)[0], slot + 1);
    EXPECT_EQ(pool.view(slot).row(3)[19], slot + 1);
  }
}

TEST(SlotPool, ChangesSizeOnlyWhenNothingIsOnLease) {
  SlotPool pool;
  ASSERT_TRUE(pool.shape(2, 10, 4));
  const int slot = pool.take();
  EXPECT_TRUE(pool.shape(2, 10, 4)) << "the same size is no change";
  const auto changed = pool.shape(2, 20, 4);
  ASSERT_FALSE(changed);
  EXPECT_NE(changed.error().message.find("1 images of 10x4"), std::string::npos) << changed.error().message;
  pool.give_back(slot);
  EXPECT_TRUE(pool.shape(2, 20, 4));
}

// One thread takes and writes, two read what they were given and give it back in any order. Whoever reads sees one value all
// over his slot; ThreadSanitizer sees that nothing but the pool makes that so.
TEST(SlotPoolStress, AReaderNeverSeesTheNextWriter) {
  SlotPool pool;
  ASSERT_TRUE(pool.shape(5, 16, 2));
  const auto bytes = static_cast<std::size_t>(pool.stride_bytes()) * 2;
  const char* long_run = std::getenv("CGSR_STRESS_HANDOVERS");
  const int hand_overs = long_run != nullptr ? std::atoi(long_run) : 40'000;
  std::atomic<int> mailboxes[2] = {{-1}, {-1}};
  std::atomic<int> mixed{0};
  const auto read = [&](std::atomic<int>& mailbox) {
    std::vector<int> kept;  // up to two at a time, the newer one goes first every other time
    for (bool done = false; !done;) {
      const int slot = mailbox.exchange(-1, std::memory_order_acquire);
      done = slot == -2;
      if (slot >= 0) kept.push_back(slot);
      if (slot < 0 && !done) {
        std::this_thread::yield();
        continue;
      }
      while (kept.size() > (done ? 0U : 1U)) {
        const int oldest = kept.front();
        const std::uint8_t* pixels = pool.view(oldest).data;
        if (!std::all_of(pixels, pixels + bytes, [&](std::uint8_t value) { return value == pixels[0]; })) ++mixed;
        kept.erase(kept.begin());
        pool.give_back(oldest);
      }
    }
  };
  std::thread first([&] { read(mailboxes[0]); });
  std::thread second([&] { read(mailboxes[1]); });
  for (int i = 0; i < hand_overs; ++i) {
    int slot = pool.take();
    for (; slot < 0; slot = pool.take()) std::this_thread::yield();
    std::memset(pool.pixels(slot), i % 251, bytes);
    for (int empty = -1; !mailboxes[i % 2].compare_exchange_weak(empty, slot, std::memory_order_release); empty = -1) {
      std::this_thread::yield();
    }
  }
  for (auto& mailbox : mailboxes) {
    for (int empty = -1; !mailbox.compare_exchange_weak(empty, -2); empty = -1) std::this_thread::yield();
  }
  first.join();
  second.join();
  EXPECT_EQ(mixed, 0);
  EXPECT_EQ(pool.on_lease(), 0);
}

}  // namespace
}  // namespace cgsr::hal
