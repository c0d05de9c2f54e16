#include "tools/lab/ball_film.h"

#include <gtest/gtest.h>

#include "tests/support/scratch_cache.h"

namespace cgsr::lab {
namespace {

// The film of section 5.4.3 begins 0.95 m above the floor, in the light, and has the ball under the table after 20 s.
TEST(BallFilm, SaysHowHighTheBallIsAndHowMuchOfItIsLit) {
  const test::ScratchCache cache;
  auto film = BallFilm::make(7);
  ASSERT_TRUE(film) << film.error().message;
  const BallFilm::Shot above = (*film)->shoot(0);
  ASSERT_TRUE(above.orange);
  EXPECT_EQ(above.scene, BallScene::kAboveTable);
  EXPECT_NEAR(above.orange_height_m, 0.95, 0.001);
  EXPECT_GT(above.lit, 0.5);
  int on_floor = 0;
  for (int number = 100; number < 140; number += 4) {
    const BallFilm::Shot shot = (*film)->shoot(number);
    if (shot.scene != BallScene::kInShadow) continue;
    ++on_floor;
    EXPECT_NEAR(shot.orange_height_m, 0.0, 0.001);
  }
  EXPECT_GT(on_floor, 0);
}

}  // namespace
}  // namespace cgsr::lab
