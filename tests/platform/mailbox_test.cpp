#include "platform/mailbox.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <random>

namespace cgsr {
namespace {

TEST(Mailbox, IsEmptyBeforeTheFirstValue) {
  Mailbox<int> mailbox;
  EXPECT_EQ(mailbox.take(), std::nullopt);
  EXPECT_EQ(mailbox.latest(), nullptr);
}

TEST(Mailbox, HandsOverTheLatestAndCountsTheOvertaken) {
  Mailbox<std::unique_ptr<int>> mailbox;
  for (int i = 0; i < 5; ++i) mailbox.put(std::make_unique<int>(i));
  EXPECT_EQ(*mailbox.take().value(), 4);
  EXPECT_EQ(mailbox.take(), std::nullopt);
  EXPECT_EQ(mailbox.written(), 5U);
  EXPECT_EQ(mailbox.overtaken(), 4U);
}

TEST(Mailbox, ShowsTheLatestAsOftenAsAsked) {
  Mailbox<int> mailbox;
  mailbox.put(3);
  EXPECT_EQ(*mailbox.latest(), 3);
  EXPECT_EQ(*mailbox.latest(), 3);
  mailbox.put(4);
  EXPECT_EQ(*mailbox.latest(), 4);
  EXPECT_EQ(mailbox.overtaken(), 0U);
}

TEST(Mailbox, DoesNotHandOverWhatWasSeen) {
  Mailbox<int> mailbox;
  mailbox.put(3);
  EXPECT_EQ(*mailbox.latest(), 3);
  EXPECT_EQ(mailbox.take(), std::nullopt);
}

// A lease in an overtaken value must be given back at once: the camera has few slots.
TEST(Mailbox, KeepsNoValueThatWasOvertakenOrTaken) {
  Mailbox<std::shared_ptr<int>> mailbox;
  const auto first = std::make_shared<int>(1);
  const auto second = std::make_shared<int>(2);
  mailbox.put(first);
  mailbox.put(second);
  EXPECT_EQ(first.use_count(), 1);
  EXPECT_EQ(second.use_count(), 2);
  EXPECT_EQ(mailbox.take(), second);
  EXPECT_EQ(second.use_count(), 1);
}

TEST(Mailbox, KeepsNoSeenValueOnceANewerWasSeen) {
  Mailbox<std::shared_ptr<int>> mailbox;
  const auto first = std::make_shared<int>(1);
  mailbox.put(first);
  EXPECT_EQ(*mailbox.latest(), first);
  mailbox.put(std::make_shared<int>(2));
  EXPECT_NE(*mailbox.latest(), first);
  EXPECT_EQ(first.use_count(), 1);
}

// Random steps against the obvious model: one value, and whether the reader has met it.
TEST(MailboxProperty, IsOneReplaceableValue) {
  std::mt19937 random(20261121);
  Mailbox<std::unique_ptr<int>> mailbox;
  std::optional<int> unread;
  std::optional<int> seen;
  std::uint64_t written = 0, overtaken = 0;
  for (int step = 0; step < 10'000; ++step) {
    const auto choice = random() % 4;
    if (choice < 2) {
      mailbox.put(std::make_unique<int>(step));
      overtaken += unread ? 1 : 0;
      unread = step;
      ++written;
    } else if (choice == 2) {
      const auto taken = mailbox.take();
      ASSERT_EQ(taken.has_value(), unread.has_value()) << step;
      if (!taken) continue;
      ASSERT_EQ(**taken, *unread) << step;
      unread.reset();
      seen.reset();
    } else {
      const auto* const latest = mailbox.latest();
      if (unread) seen = std::exchange(unread, std::nullopt);
      ASSERT_EQ(latest != nullptr, seen.has_value()) << step;
      if (latest == nullptr) continue;
      ASSERT_EQ(**latest, *seen) << step;
    }
  }
  EXPECT_EQ(mailbox.written(), written);
  EXPECT_EQ(mailbox.overtaken(), overtaken);
}

}  // namespace
}  // namespace cgsr
