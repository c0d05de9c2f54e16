#include <algorithm>

#include <gtest/gtest.h>

#include "tools/lab/corridor_film.h"

namespace cgsr::lab {
namespace {

std::unique_ptr<CorridorFilm> film_of(std::uint64_t seed) {
  auto film = CorridorFilm::make(seed);
  EXPECT_TRUE(film) << film.error().message;
  return film ? std::move(*film) : nullptr;
}

TEST(CorridorFilm, SameSeedSameBytesAndEverySeedATakeOfItsOwn) {
  constexpr int kAnywhere = 333;
  const auto once = film_of(3)->shoot(kAnywhere);
  const auto again = film_of(3)->shoot(kAnywhere);
  const auto other = film_of(4)->shoot(kAnywhere);

  EXPECT_EQ(once.image.yuyv, again.image.yuyv);
  ASSERT_TRUE(once.truth.shirt && again.truth.shirt && other.truth.shirt);
  EXPECT_EQ(once.truth.shirt->x, again.truth.shirt->x);
  EXPECT_NE(once.truth.shirt->x, other.truth.shirt->x);
}

// What Figure 3.3 demands of its scene, whoever walks: the light, the near-white parts, and a third of the background in the shirt's hues.
TEST(CorridorFilm, IsTheExperimentInEveryTake) {
  for (const std::uint64_t seed : {1, 2}) {
    const auto film = film_of(seed);
    double shares = 0.0;
    int images = 0;
    for (int number = 0; number < CorridorFilm::kImages; number += 125) {
      const auto shot = film->shoot(number);
      ASSERT_TRUE(shot.truth.shirt) << number;
      const auto scene = film->scene_of(shot);
      EXPECT_GT(shot.truth.shirt->area(), 8000.0) << number;
      if (number == 0) {
        EXPECT_GE(scene.near_white, 0.95);
      }
      shares += scene.background_of_its_hues;
      ++images;
    }
    EXPECT_NEAR(shares / images, 1.0 / 3.0, 0.05) << seed;
  }
}

TEST(CorridorFilm, LightOnTheShirtFollowsTheScript) {
  const auto film = film_of(1);
  const Light first = film->scripted_light(0.0);
  const Light last = film->scripted_light(CorridorFilm::kSeconds);
  EXPECT_NEAR(first.g, 0.85, 1e-6);
  EXPECT_NEAR(first.b, 0.65, 1e-6);
  EXPECT_NEAR(last.r / last.b, 0.65, 1e-6);
  EXPECT_NEAR(last.g / last.b, 0.85, 1e-6);
  EXPECT_NEAR(std::max({last.r, last.g, last.b}), 0.5, 1e-6);

  const Light before = film->shoot(0).truth.light;
  const Light after = film->shoot(600).truth.light;

  EXPECT_NEAR(before.r, 1.0, 1e-6);
  EXPECT_NEAR(after.r, last.r / first.r, 0.1 * last.r / first.r);
  EXPECT_NEAR(after.b, last.b / first.b, 0.1 * last.b / first.b);
}

}  // namespace
}  // namespace cgsr::lab
