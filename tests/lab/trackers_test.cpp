#include "tools/lab/trackers.h"

#include <cmath>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "tools/lab/scenes/clutter.h"
#include "tools/lab/scenes/scene.h"

namespace cgsr::lab {

/// GoogleTest looks for it beside the type.
inline void PrintTo(const NamedTracker& tracker, std::ostream* out) {
  *out << tracker.name;
}

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

/// An object in clutter, twelve pixels further to the right in image 1 and still there in image 2.
Film film_of_a_jump() {
  const Pattern pattern{Random(5)};
  const Canvas clutter = random_clutter(kSceneWidthPx, kSceneHeightPx, pattern.palette(), kSharedHues, Random(6));
  const Box start{300, 200, 80, 60}, end{312, 200, 80, 60};
  const auto image = [=](int i) -> Result<Image> {
    Canvas canvas = clutter;
    paint(canvas, pattern, i == 0 ? start : end);
    return image_of_yuyv(expose(canvas, {{0.8, 0.8, 0.8}, 1, 2.0}, Random(static_cast<std::uint64_t>(i))),
                         kSceneWidthPx, kSceneHeightPx);
  };
  return {"jump", image, {start, end, end}};
}

// The figures of a peer are only fair when it works here as it does elsewhere, from its very first answer.
TEST(Peers, TheFilterTrackersFollowAJumpAtOnce) {
  const Film film = film_of_a_jump();
  for (const NamedTracker& named : trackers()) {
    if (named.name != "KCF" && named.name != "CSRT") continue;
    const auto boxes = follow(*named.make(config::Color{}), film, film.size(), film);
    ASSERT_TRUE(boxes);
    for (std::size_t i = 1; i < 3; ++i)
      EXPECT_GT(score_image(*film.truth[i], (*boxes)[i]).iou, 0.85) << named.name << " " << i;
  }
}

}  // namespace
}  // namespace cgsr::lab
