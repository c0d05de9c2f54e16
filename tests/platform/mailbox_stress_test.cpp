#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <thread>

#include "platform/mailbox.h"
#include "tests/support/stress.h"

namespace cgsr {
namespace {

struct Goal {
  explicit Goal(std::uint64_t number) { words.fill(number); }
  [[nodiscard]] bool whole() const {
    for (const auto word : words) {
      if (word != words[0]) return false;
    }
    return true;
  }
  std::array<std::uint64_t, 12> words{};
};

// The reader sees whole values that never go back in time, and in the end the last one; what it did not see was
// counted.
TEST(MailboxStress, LatestIsWholeAndNeverGoesBack) {
  const auto count = test::stress_handovers();
  Mailbox<Goal> mailbox;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= count; ++i) mailbox.put(Goal(i));
    done = true;
  });
  std::uint64_t last = 0, torn = 0, went_back = 0, distinct = 0;
  const auto look = [&] {
    const auto* const goal = mailbox.latest();
    if (goal == nullptr) return;
    torn += goal->whole() ? 0 : 1;
    went_back += goal->words[0] >= last ? 0 : 1;
    distinct += goal->words[0] > last ? 1 : 0;
    last = goal->words[0];
  };
  while (!done) look();
  writer.join();
  look();
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(went_back, 0U);
  EXPECT_EQ(last, count);
  EXPECT_EQ(mailbox.written(), count);
  EXPECT_EQ(mailbox.overtaken() + distinct, count);
}

// Values with an owner, taken by a reader that is slow now and then: each is destroyed exactly once, none is kept.
TEST(MailboxStress, MoveOnlyValuesAreNeitherLeakedNorDoubled) {
  const auto count = test::stress_handovers();
  std::atomic<std::int64_t> alive{0};
  struct Counted {
    explicit Counted(std::atomic<std::int64_t>& count_of_all) : counter(count_of_all) { ++counter; }
    ~Counted() { --counter; }
    std::atomic<std::int64_t>& counter;
  };
  std::uint64_t taken = 0;
  {
    Mailbox<std::unique_ptr<Counted>> mailbox;
    std::atomic<bool> done{false};
    std::thread writer([&] {
      for (std::uint64_t i = 0; i < count; ++i) mailbox.put(std::make_unique<Counted>(alive));
      done = true;
    });
    while (!done) {
      if (!mailbox.take()) continue;
      if (++taken % 1000 == 0) std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    writer.join();
    taken += mailbox.take() ? 1 : 0;
    EXPECT_EQ(mailbox.overtaken() + taken, count);
    EXPECT_EQ(alive, 0);
  }
}

}  // namespace
}  // namespace cgsr
