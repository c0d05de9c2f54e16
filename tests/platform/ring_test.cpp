#include "platform/ring.h"

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <random>

#include "platform/image_lease.h"

namespace cgsr {
namespace {

TEST(Ring, HandsOverInOrder) {
  Ring<int, 4> ring;
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(int{i}));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(ring.pop(), i);
  EXPECT_EQ(ring.pop(), std::nullopt);
}

TEST(Ring, RefusesWhenFullAndLeavesTheValueWithTheProducer) {
  Ring<std::unique_ptr<int>, 2> ring;
  EXPECT_TRUE(ring.push(std::make_unique<int>(1)));
  EXPECT_TRUE(ring.push(std::make_unique<int>(2)));
  auto third = std::make_unique<int>(3);
  EXPECT_FALSE(ring.push(std::move(third)));
  ASSERT_NE(third, nullptr);  // NOLINT(bugprone-use-after-move): refused means not moved
  EXPECT_EQ(*third, 3);
  EXPECT_EQ(ring.statistics().dropped, 1U);
  EXPECT_EQ(*ring.pop().value(), 1);
  EXPECT_TRUE(ring.push(std::move(third)));
}

TEST(Ring, DiscardsTheNewestWhenFullIfThatIsItsPolicy) {
  const auto value = std::make_shared<int>(7);
  Ring<std::shared_ptr<int>, 1, Overflow::kDiscard> ring;
  for (int i = 0; i < 10; ++i) ring.push(value);
  EXPECT_EQ(value.use_count(), 2);
  EXPECT_EQ(ring.statistics().dropped, 9U);
  EXPECT_EQ(ring.statistics().pushed, 1U);
}

TEST(Ring, GivesTheNewestAndCountsWhatItPassedOver) {
  Ring<std::unique_ptr<int>, 4> ring;
  EXPECT_EQ(ring.pop_newest(), std::nullopt);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(std::make_unique<int>(i)));
  EXPECT_EQ(*ring.pop_newest().value(), 3);
  EXPECT_EQ(ring.pop_newest(), std::nullopt);
  EXPECT_EQ(ring.statistics().skipped, 3U);
}

TEST(Ring, DestroysWhatIsLeft) {
  const auto value = std::make_shared<int>(7);
  {
    Ring<std::shared_ptr<int>, 4> ring;
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(ring.push(std::shared_ptr<int>(value)));
    EXPECT_EQ(value.use_count(), 4);
  }
  EXPECT_EQ(value.use_count(), 1);
}

/// Counts the objects of its kind, moved-from ones included.
struct Counted {
  Counted() { ++alive; }
  Counted(Counted&& /*other*/) noexcept { ++alive; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --alive; }
  static inline int alive = 0;
};

TEST(Ring, DestroysEachObjectOnce) {
  {
    Ring<Counted, 3> ring;
    for (int lap = 0; lap < 5; ++lap) {
      EXPECT_TRUE(ring.push(Counted()));
      EXPECT_TRUE(ring.push(Counted()));
      EXPECT_EQ(Counted::alive, 2) << "no more than what lies in the ring";
      if (lap % 2 == 0) {
        static_cast<void>(ring.pop());
        EXPECT_EQ(Counted::alive, 1);
      }
      static_cast<void>(ring.pop_newest());
      EXPECT_EQ(Counted::alive, 0);
    }
    EXPECT_TRUE(ring.push(Counted()));
  }
  EXPECT_EQ(Counted::alive, 0);
}

class CountingLender final : public ImageLender {
 public:
  void give_back(int slot) noexcept override { last = slot, ++count; }
  int last = -1;
  int count = 0;
};

// What a ring loses or passes over is given back to the camera at once, not when its slot is used again.
TEST(Ring, GivesBackTheLeasesThatItDrops) {
  CountingLender lender;
  Ring<ImageLease, 2, Overflow::kDiscard> ring;
  for (int slot = 0; slot < 3; ++slot) ring.push(ImageLease(lender, slot, {}, 0, {}));
  EXPECT_EQ(lender.count, 1);
  EXPECT_EQ(lender.last, 2);
  const auto newest = ring.pop_newest();
  EXPECT_EQ(lender.count, 2);
  EXPECT_EQ(lender.last, 0);
}

// A ring is a bounded queue: random steps against a plain one, for capacities around the powers of two.
template <std::size_t kCapacity>
void compare_with_deque(unsigned seed) {
  std::mt19937 random(seed);
  Ring<std::unique_ptr<int>, kCapacity> ring;
  std::deque<int> model;
  std::uint64_t pushed = 0, dropped = 0, skipped = 0;
  std::size_t high_water = 0;
  for (int step = 0; step < 10'000; ++step) {
    const auto choice = random() % 16;
    if (choice < 9) {
      const bool room = model.size() < kCapacity;
      ASSERT_EQ(ring.push(std::make_unique<int>(step)), room) << step;
      if (room) model.push_back(step);
      (room ? pushed : dropped) += 1;
      high_water = std::max(high_water, model.size());
    } else if (choice < 15) {
      const auto value = ring.pop();
      ASSERT_EQ(value.has_value(), !model.empty()) << step;
      if (!value) continue;
      ASSERT_EQ(**value, model.front()) << step;
      model.pop_front();
    } else {
      const auto value = ring.pop_newest();
      ASSERT_EQ(value.has_value(), !model.empty()) << step;
      if (!value) continue;
      ASSERT_EQ(**value, model.back()) << step;
      skipped += model.size() - 1;
      model.clear();
    }
  }
  const auto statistics = ring.statistics();
  EXPECT_EQ(statistics.capacity, kCapacity);
  EXPECT_EQ(statistics.pushed, pushed);
  EXPECT_EQ(statistics.dropped, dropped);
  EXPECT_EQ(statistics.skipped, skipped);
  EXPECT_EQ(statistics.high_water, high_water);
  EXPECT_GT(dropped, 0U);
}

TEST(RingProperty, IsABoundedQueue) {
  compare_with_deque<1>(1);
  compare_with_deque<2>(2);
  compare_with_deque<3>(3);
  compare_with_deque<7>(4);
  compare_with_deque<8>(5);
}

}  // namespace
}  // namespace cgsr
