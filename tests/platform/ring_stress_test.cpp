#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <thread>

#include "platform/image_lease.h"
#include "platform/ring.h"
#include "tests/support/stress.h"

namespace cgsr {
namespace {

/// A value that shows when it was torn, read too early, or overwritten too soon. Large enough for a hand-over to take
/// time.
struct Message {
  explicit Message(std::uint64_t number) { words.fill(number); }
  [[nodiscard]] bool whole() const {
    for (const auto word : words) {
      if (word != words[0]) return false;
    }
    return true;
  }
  [[nodiscard]] std::uint64_t number() const { return words[0]; }
  std::array<std::uint64_t, 12> words{};
};

// Nothing is lost, doubled or out of order when the producer tries until there is room. The slots are used again and
// again: with capacity 3 the buffer wraps at every third message.
template <std::size_t kCapacity>
void every_message_arrives() {
  const auto count = test::stress_handovers();
  Ring<Message, kCapacity> ring;
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < count; ++i) {
      while (!ring.push(Message(i))) std::this_thread::yield();
    }
  });
  std::uint64_t expected = 0, torn = 0, out_of_order = 0;
  while (expected < count) {
    const auto message = ring.pop();
    if (!message) {
      std::this_thread::yield();
      continue;
    }
    torn += message->whole() ? 0 : 1;
    out_of_order += message->number() == expected ? 0 : 1;
    ++expected;
  }
  producer.join();
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(out_of_order, 0U);
  EXPECT_EQ(ring.pop(), std::nullopt) << "more came out than went in";
  EXPECT_EQ(ring.statistics().pushed, count);
  EXPECT_LE(ring.statistics().high_water, kCapacity);
}

TEST(RingStress, EveryMessageArrivesOfCapacityOne) {
  every_message_arrives<1>();
}
TEST(RingStress, EveryMessageArrivesOfCapacityThree) {
  every_message_arrives<3>();
}
TEST(RingStress, EveryMessageArrivesOfCapacitySixtyFour) {
  every_message_arrives<64>();
}

// A producer that never waits, a consumer that is slow: the producer gets through, what arrives is in order and whole,
// and what was lost was counted, to the last one.
TEST(RingStress, ASlowConsumerCostsCountedMessagesAndNoTime) {
  const auto count = test::stress_handovers();
  Ring<Message, 8, Overflow::kDiscard> ring;
  std::atomic<bool> done{false};
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < count; ++i) ring.push(Message(i));
    done = true;
  });
  std::uint64_t received = 0, torn = 0, out_of_order = 0, next = 0;
  const auto receive = [&](const Message& message) {
    torn += message.whole() ? 0 : 1;
    out_of_order += message.number() >= next ? 0 : 1;
    next = message.number() + 1;
    ++received;
  };
  while (!done) {
    if (const auto message = ring.pop()) receive(*message);
    if (received % 64 == 0) std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
  producer.join();
  while (const auto message = ring.pop()) receive(*message);

  const auto statistics = ring.statistics();
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(out_of_order, 0U);
  EXPECT_EQ(statistics.pushed, received);
  EXPECT_EQ(statistics.pushed + statistics.dropped, count);
  EXPECT_GT(statistics.dropped, 0U);
  EXPECT_EQ(statistics.high_water, 8U);
}

/// A camera of six slots that notices when one is given back that was not lent.
class CheckingLender final : public ImageLender {
 public:
  void give_back(int slot) noexcept override {
    if (!lent_[static_cast<std::size_t>(slot)].exchange(false)) ++wrong_;
  }
  int lend() {
    for (std::size_t slot = 0; slot < lent_.size(); ++slot) {
      if (!lent_[slot].exchange(true)) return static_cast<int>(slot);
    }
    return -1;
  }
  [[nodiscard]] int wrong() const { return wrong_; }
  [[nodiscard]] bool all_back() const {
    for (const auto& lent : lent_) {
      if (lent) return false;
    }
    return true;
  }

 private:
  std::array<std::atomic<bool>, 6> lent_{};
  std::atomic<int> wrong_{0};
};

// The path of the images: leases through a short ring, of which the consumer takes the newest. Every slot comes back
// exactly once.
TEST(RingStress, EveryLeaseIsGivenBackOnce) {
  const auto count = test::stress_handovers();
  CheckingLender camera;
  std::atomic<bool> done{false};
  std::uint64_t without_slot = 0;
  std::uint64_t received = 0, out_of_order = 0;
  RingStatistics statistics;
  {
    Ring<ImageLease, 2> ring;
    std::thread producer([&] {
      for (std::uint64_t i = 0; i < count; ++i) {
        const int slot = camera.lend();
        if (slot < 0) {
          ++without_slot;
          std::this_thread::yield();
          continue;
        }
        ImageLease lease(camera, slot, {}, i, {});
        static_cast<void>(ring.push(std::move(lease)));  // a refused lease ends here
      }
      done = true;
    });
    std::uint64_t next = 0;
    for (bool last = false; !last;) {
      last = done;  // asked before the look, so that the last look comes after the last push
      const auto lease = ring.pop_newest();
      if (!lease) continue;
      out_of_order += lease->sequence() >= next ? 0 : 1;
      next = lease->sequence() + 1;
      ++received;
    }
    producer.join();
    statistics = ring.statistics();
  }
  EXPECT_EQ(camera.wrong(), 0);
  EXPECT_TRUE(camera.all_back());
  EXPECT_EQ(out_of_order, 0U);
  EXPECT_EQ(statistics.pushed + statistics.dropped + without_slot, count);
  EXPECT_EQ(received + statistics.skipped, statistics.pushed);
  EXPECT_GT(received, 0U);
}

}  // namespace
}  // namespace cgsr
