#include "pipeline/color/track/light_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/color/track/relight.h"
#include "tests/color/surface.h"

namespace cgsr::color {
namespace {

Light slow_light(int image) {
  return {0.85 + 0.15 * std::sin(0.05 * image), 0.9 + 0.1 * std::cos(0.04 * image), 0.8 + 0.2 * std::sin(0.03 * image)};
}

/// What a tracker hands over in each image.
void see(LightFollower& follower, const ObjectView& room, const ObjectView& learned, const ObjectView& shown,
         const Light& light, double agreement) {
  follower.predict(channel_quantiles(relit(room, light)));
  const auto object = channel_quantiles(relit(shown, light));
  follower.update(object, light_gain(channel_quantiles(learned), object), agreement);
}

TEST(LightFollower, FollowsALightThatChangesSlowly) {
  const ObjectView room = surface(1), object = surface(2);
  LightFollower follower{LightFollowerParameters{}};
  follower.begin({1.0, 1.0, 1.0}, channel_quantiles(relit(room, slow_light(0))),
                 channel_quantiles(relit(object, slow_light(0))));
  for (int i = 1; i < 200; ++i) {
    see(follower, room, relit(object, slow_light(0)), object, slow_light(i), 1.0);
    EXPECT_LT(error(follower.gain(), without_light(slow_light(i), slow_light(0))), 0.04) << i;
  }
}

// Another side of the object has other colours: no other light.
TEST(LightFollower, AnotherSideOfTheObjectIsNoOtherLight) {
  const ObjectView room = surface(1), front = surface(2), back = surface(9);
  const Light light{0.9, 0.9, 0.9};
  const auto learned = channel_quantiles(front);
  ASSERT_GT(error(light_gain(learned, channel_quantiles(back)), {1.0, 1.0, 1.0}), 0.08);
  LightFollower follower{LightFollowerParameters{}};
  follower.begin({1.0, 1.0, 1.0}, channel_quantiles(relit(room, light)), channel_quantiles(relit(front, light)));
  constexpr int kImages = 60;
  for (int i = 1; i <= kImages; ++i) {
    ObjectView turning = front;
    const std::size_t turned = turning.y.size() * static_cast<std::size_t>(i) / kImages;
    std::copy_n(back.y.begin(), turned, turning.y.begin());
    std::copy_n(back.u.begin(), turned, turning.u.begin());
    std::copy_n(back.v.begin(), turned, turning.v.begin());
    see(follower, room, relit(front, light), turning, light, 0.5);
  }
  const auto direct = light_gain(learned, channel_quantiles(back));
  EXPECT_LT(error(follower.gain(), {1.0, 1.0, 1.0}), 0.7 * error(direct, {1.0, 1.0, 1.0}));
}

// While the object is not seen the whole image says how the light changes.
TEST(LightFollower, FollowsTheWholeImageWhileTheObjectIsLost) {
  const ObjectView room = surface(1), object = surface(2);
  LightFollower follower{LightFollowerParameters{}};
  follower.begin({1.0, 1.0, 1.0}, channel_quantiles(relit(room, slow_light(0))),
                 channel_quantiles(relit(object, slow_light(0))));
  follower.lose();
  for (int i = 1; i < 60; ++i) follower.predict(channel_quantiles(relit(room, slow_light(i))));
  EXPECT_LT(error(follower.gain(), without_light(slow_light(59), slow_light(0))), 0.06);
}

TEST(LightFollower, ACutInTheFilmIsNoLamp) {
  const ObjectView room = surface(1), object = surface(2);
  LightFollower follower{LightFollowerParameters{}};
  follower.begin({1.0, 1.0, 1.0}, channel_quantiles(room), channel_quantiles(object));
  follower.predict(channel_quantiles(relit(room, {0.2, 0.2, 0.2})));
  EXPECT_EQ(follower.gain().r, 1.0);
}

}  // namespace
}  // namespace cgsr::color
