#include "tools/lab/trackers.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace cgsr::lab {
namespace {

class BoxTrackerContract : public testing::TestWithParam<NamedTracker> {
 protected:
  std::unique_ptr<BoxTracker> tracker_ = GetParam().make(config::Color{});
  Film film_ = generated_film(3, 6);
};

TEST_P(BoxTrackerContract, RefusesABoxOutsideTheImage) {
  EXPECT_FALSE(tracker_->learn(*film_.image(0), {700, 10, 40, 40}));
}

TEST_P(BoxTrackerContract, WhatItFindsIsABoxThatTouchesTheImage) {
  const auto boxes = follow(*tracker_, film_, film_.size(), film_);

  ASSERT_TRUE(boxes) << boxes.error().message;
  ASSERT_EQ(boxes->size(), 6U);
  for (const auto& box : *boxes) {
    if (!box) continue;
    EXPECT_GT(intersection(*box, {0, 0, 640, 480}).area(), 0.0);
  }
}

TEST_P(BoxTrackerContract, SameFilmSameBoxes) {
  const auto first = follow(*tracker_, film_, film_.size(), film_);
  const auto second = follow(*GetParam().make(config::Color{}), film_, film_.size(), film_);

  ASSERT_TRUE(first && second);
  EXPECT_EQ(*first, *second);
}

INSTANTIATE_TEST_SUITE_P(Every, BoxTrackerContract, testing::ValuesIn(trackers().begin(), trackers().end()),
                         [](const auto& tracker) {
                           std::string name;
                           for (char c : tracker.param.name) {
                             if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
                           }
                           return name;
                         });

// The figures of a peer are only fair when it works here as it does elsewhere.
TEST(Peers, TheFilterTrackersFollowAnObjectInGoodLight) {
  const Film film = generated_film(3, 6);
  for (const NamedTracker& named : trackers()) {
    if (named.name != "KCF" && named.name != "CSRT") continue;
    const auto boxes = follow(*named.make(config::Color{}), film, film.size(), film);
    ASSERT_TRUE(boxes);
    EXPECT_GT(score(*boxes, film.truth, 1).iou, 0.7) << named.name;
  }
}

}  // namespace
}  // namespace cgsr::lab
