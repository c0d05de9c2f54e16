#include "pipeline/runtime/images_in_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>

namespace cgsr::runtime {
namespace {

using std::chrono::milliseconds;

constexpr Duration kPeriod = milliseconds(33);

/// Feeds images one after the other.
class Feed {
 public:
  explicit Feed(ImagesInTime& images) : images_(images) {}
  void image(Duration took) { images_.dealt_with(sequence_++, MonoTime{}, MonoTime{} + took); }
  void images(int count, Duration took) {
    for (int i = 0; i < count; ++i) image(took);
  }
  void lose(std::uint64_t count) { sequence_ += count; }

 private:
  ImagesInTime& images_;
  std::uint64_t sequence_ = 1000;
};

TEST(ImagesInTime, IsNotEnoughBeforeThirtyWereSeen) {
  ImagesInTime images(kPeriod);
  Feed feed(images);
  feed.images(29, milliseconds(10));
  EXPECT_FALSE(images.enough());
  feed.image(milliseconds(10));
  EXPECT_TRUE(images.enough());
}

TEST(ImagesInTime, ThreeLateOnesOfThirtyAreBorneFourAreNot) {
  ImagesInTime images(kPeriod);
  Feed feed(images);
  feed.images(30, kPeriod);  // to the last nanosecond is in time
  feed.images(3, kPeriod + Duration{1});
  EXPECT_EQ(images.in_time(), 27U);
  EXPECT_TRUE(images.enough());
  feed.image(milliseconds(40));
  EXPECT_FALSE(images.enough());
}

TEST(ImagesInTime, RecoversAsTheLateOnesGrowOld) {
  ImagesInTime images(kPeriod);
  Feed feed(images);
  feed.images(26, milliseconds(10));
  feed.images(4, milliseconds(50));
  EXPECT_FALSE(images.enough());
  feed.images(26, milliseconds(10));
  EXPECT_FALSE(images.enough());
  feed.image(milliseconds(10));
  EXPECT_TRUE(images.enough());
}

TEST(ImagesInTime, LostImagesCountAsLate) {
  ImagesInTime images(kPeriod);
  Feed feed(images);
  feed.images(30, milliseconds(10));
  feed.lose(4);
  feed.image(milliseconds(10));
  EXPECT_EQ(images.in_time(), 26U);
  EXPECT_FALSE(images.enough());
  feed.lose(std::uint64_t{1} << 40);
  feed.image(milliseconds(10));
  EXPECT_EQ(images.in_time(), 1U);
}

TEST(ImagesInTime, FramesWithoutAnImageCountAsLate) {
  ImagesInTime images(kPeriod);
  Feed feed(images);
  feed.images(30, milliseconds(10));
  for (int i = 0; i < 4; ++i) images.missed();
  EXPECT_FALSE(images.enough());
}

// A damaged image is missed, and leaves a gap in the sequence.
TEST(ImagesInTime, AnImageThatWasMissedIsNoGapAsWell) {
  ImagesInTime images(kPeriod);
  Feed feed(images);
  feed.images(30, milliseconds(10));
  for (int i = 0; i < 2; ++i) {
    images.missed();
    feed.lose(1);
    feed.image(milliseconds(10));
  }
  EXPECT_EQ(images.in_time(), 28U);
  EXPECT_TRUE(images.enough());
  images.missed();
  feed.lose(3);
  feed.image(milliseconds(10));
  EXPECT_EQ(images.in_time(), 25U) << "one of these three was missed";
}

// A camera that starts again counts from 0: that is no loss of two thousand million images.
TEST(ImagesInTime, ASequenceThatStartsAgainIsNoGap) {
  ImagesInTime images(kPeriod);
  Feed feed(images);
  feed.images(30, milliseconds(10));
  images.dealt_with(0, MonoTime{}, MonoTime{});
  EXPECT_EQ(images.in_time(), 30U);
}

TEST(ImagesInTimeProperty, IsTheLastThirty) {
  std::mt19937 random(20261121);
  ImagesInTime images(kPeriod);
  std::deque<bool> model;
  std::uint64_t sequence = 0;
  std::uint64_t missed = 0;
  const auto note = [&](bool in_time) {
    model.push_back(in_time);
    if (model.size() > 30) model.pop_front();
  };
  int enough = 0;
  for (int step = 0; step < 10'000; ++step) {
    const bool rough = step / 500 % 2 == 1;
    const auto choice = random() % (rough ? 10 : 40);
    if (choice == 0) {
      images.missed();
      ++missed;
      note(false);
    } else {
      const std::uint64_t lost = choice == 1 ? random() % 3 : 0;
      for (std::uint64_t i = missed; sequence > 0 && i < lost; ++i) note(false);
      missed = 0;
      sequence += lost + 1;
      const bool late = choice == 2;
      images.dealt_with(sequence, MonoTime{}, MonoTime{} + (late ? milliseconds(34) : milliseconds(20)));
      note(!late);
    }
    const auto in_time = static_cast<std::size_t>(std::count(model.begin(), model.end(), true));
    ASSERT_EQ(images.in_time(), in_time) << step;
    ASSERT_EQ(images.enough(), model.size() == 30 && in_time * 10 >= 30 * 9) << step;
    enough += images.enough() ? 1 : 0;
  }
  EXPECT_GT(enough, 1000);
  EXPECT_LT(enough, 9000);
}

}  // namespace
}  // namespace cgsr::runtime
