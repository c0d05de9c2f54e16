#include "tests/hil/image_order.h"

#include <gtest/gtest.h>

namespace cgsr::hil {
namespace {

using Wanted = ImageOrder::Wanted;

TEST(ImageOrder, TheFirstStandsThenEachComesOnceThenTheLastStands) {
  ImageOrder order(3);
  const auto write = [&order](Wanted wanted) {
    const auto image = order.next(wanted);
    if (image) order.written(wanted);
    return image;
  };
  EXPECT_EQ(write({}), 0U);
  EXPECT_EQ(write({}), 0U);
  EXPECT_EQ(write({.plays = true}), 0U);
  EXPECT_EQ(write({.plays = true}), 1U);
  EXPECT_EQ(write({.plays = true}), 2U);
  EXPECT_EQ(write({.plays = true}), 2U);
  EXPECT_EQ(order.played(), 3U);
}

TEST(ImageOrder, OneThatWasRefusedComesAgain) {
  const ImageOrder order(2);
  EXPECT_EQ(order.next({.plays = true}), 0U);
  EXPECT_EQ(order.next({.plays = true}), 0U);
}

// vivid's other end would use up the flags that its camera's images are to get.
TEST(ImageOrder, NothingIsWrittenWhileItIsToBeStillAndNoneIsLeftOut) {
  ImageOrder order(2);
  order.written({.plays = true});
  EXPECT_EQ(order.next({.plays = true, .still = true}), std::nullopt);
  order.written({.plays = true, .still = true});
  EXPECT_EQ(order.next({.plays = true}), 1U);
  EXPECT_EQ(ImageOrder(1).next({.still = true}), std::nullopt);
}

}  // namespace
}  // namespace cgsr::hil
