// Readers give images back while the camera that lent them closes and frees its buffers.
#include "hal/v4l2/image_slots.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/stress.h"

namespace cgsr::hal::v4l2 {
namespace {

constexpr int kReaders = 4;

// The camera waits for a slot when the last one comes back and its device is gone: the reader is still about to wake it.
TEST(ImageSlots, AreOnLeaseUntilTheReaderIsDoneWithThem) {
  std::atomic<bool> waking{false};
  std::atomic<bool> may_go_on{false};
  ImageSlots slots([&] {
    waking = true;
    while (!may_go_on) std::this_thread::yield();
  });
  slots.lend(3);
  slots.set_starving(true);
  EXPECT_TRUE(slots.any_on_lease());
  std::thread reader([&] { ImageLease(slots, 3, {}, 0, {}); });
  while (!waking) std::this_thread::yield();
  EXPECT_TRUE(slots.any_on_lease()) << "the reader is still in give_back()";
  EXPECT_EQ(slots.take_returned(), 8u);
  EXPECT_TRUE(slots.any_on_lease()) << "the reader is still in give_back()";
  may_go_on = true;
  reader.join();
  EXPECT_FALSE(slots.any_on_lease());
}

// For the address and thread sanitizers, which see an access to what was freed; without them it is a crash at best.
TEST(ImageSlotsStress, ReadersGiveBackWhileTheCameraCloses) {
  std::array<std::atomic<ImageSlots*>, kReaders> lent{};
  std::atomic<bool> over{false};
  std::array<std::thread, kReaders> readers;
  for (int i = 0; i < kReaders; ++i) {
    readers[static_cast<std::size_t>(i)] = std::thread([&, i] {
      while (!over) {
        ImageSlots* const lender = lent[static_cast<std::size_t>(i)].exchange(nullptr, std::memory_order_acquire);
        if (lender == nullptr) {
          std::this_thread::yield();
          continue;
        }
        ImageLease(*lender, i, {}, 0, {});
      }
    });
  }
  const std::uint64_t closings = test::stress_handovers() / 400;
  for (std::uint64_t closing = 0; closing < closings; ++closing) {
    auto woken = std::make_unique<std::atomic<int>>(0);
    auto slots = std::make_unique<ImageSlots>([&count = *woken] {
      std::this_thread::yield();
      count.fetch_add(1, std::memory_order_relaxed);
    });
    slots->set_starving(true);
    for (int i = 0; i < kReaders; ++i) slots->lend(i);
    for (auto& place : lent) place.store(slots.get(), std::memory_order_release);
    while (slots->any_on_lease()) {
      if (closing % 2 == 0) static_cast<void>(slots->take_returned());
    }
    slots.reset();
    EXPECT_EQ(woken->load(), kReaders) << closing;
  }
  over = true;
  for (auto& reader : readers) reader.join();
}

}  // namespace
}  // namespace cgsr::hal::v4l2
