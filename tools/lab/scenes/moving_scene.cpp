#include "tools/lab/scenes/moving_scene.h"

#include <algorithm>
#include <cmath>

#include "tools/lab/scenes/clutter.h"
#include "tools/lab/scenes/scene.h"

namespace cgsr::lab {
namespace {

constexpr int kImagesBetweenLights = 30;
constexpr double kMostSpeedPx = 7.0;  // per image
constexpr double kMostPush = 0.8;     // px per image^2
constexpr double kLeastScale = 0.8, kMostScale = 1.25;
constexpr double kHiddenFrom = 0.45, kHiddenTo = 0.6;  // share of the film

/// One coordinate that is pushed at random and bounces off its limits.
struct Wanderer {
  double position;
  double speed;
  void step(double push, double most_speed, double low, double high) {
    speed = std::clamp(speed + push, -most_speed, most_speed);
    position += speed;
    if (position < low || position > high) speed = -speed;
    position = std::clamp(position, low, high);
  }
};

std::vector<std::optional<Box>> random_walk(int images, Random random) {
  const double width = 2 * (28 + random.below(36)), height = 2 * (28 + random.below(36));
  Box start = random_place(width, height, random);
  Wanderer x{start.x + width / 2, random.uniform(-4, 4)}, y{start.y + height / 2, random.uniform(-4, 4)},
      scale{1.0, 0.0};
  std::vector<std::optional<Box>> boxes;
  for (int i = 0; i < images; ++i) {
    const double w = width * scale.position, h = height * scale.position;
    const bool hidden = i >= kHiddenFrom * images && i < kHiddenTo * images;
    boxes.push_back(hidden ? std::nullopt : std::optional(Box{x.position - w / 2, y.position - h / 2, w, h}));
    // While it is hidden it hurries, so that it comes back elsewhere.
    const double haste = hidden ? 3.0 : 1.0;
    scale.step(random.uniform(-0.002, 0.002), 0.01, kLeastScale, kMostScale);
    const double next_w = width * scale.position, next_h = height * scale.position;
    x.step(haste * random.uniform(-kMostPush, kMostPush), haste * kMostSpeedPx, next_w / 2, kSceneWidthPx - next_w / 2);
    y.step(haste * random.uniform(-kMostPush, kMostPush), haste * kMostSpeedPx, next_h / 2,
           kSceneHeightPx - next_h / 2);
  }
  return boxes;
}

/// From the learning light to a new random one every kImagesBetweenLights, in between in a straight line.
std::vector<Light> random_lights(int images, Random random) {
  std::vector<Light> lights;
  Light from{kLearningLight, kLearningLight, kLearningLight}, to = from;
  for (int i = 0; i < images; ++i) {
    const double t = static_cast<double>(i % kImagesBetweenLights) / kImagesBetweenLights;
    if (i % kImagesBetweenLights == 0) {
      from = to;
      to = {random.uniform(0.6, 1.0), random.uniform(0.6, 1.0), random.uniform(0.6, 1.0)};
    }
    lights.push_back({from.r + t * (to.r - from.r), from.g + t * (to.g - from.g), from.b + t * (to.b - from.b)});
  }
  return lights;
}

}  // namespace

MovingScene::MovingScene(std::uint64_t seed, int images, bool absent)
    : random_(Random(seed).fork(100)),
      pattern_(random_.fork(1)),
      clutter_(random_clutter(kSceneWidthPx, kSceneHeightPx, pattern_.palette(), kSharedHues, random_.fork(2))),
      truth_(random_walk(images, random_.fork(3))),
      lights_(random_lights(images, random_.fork(4))) {
  if (absent && !truth_.empty()) std::fill(truth_.begin() + 1, truth_.end(), std::nullopt);
}

Image MovingScene::image(int i) const {
  Random random = random_.fork(1000 + static_cast<std::uint64_t>(i));
  Canvas canvas = clutter_;
  if (const auto& box = truth_[static_cast<std::size_t>(i)]) paint(canvas, pattern_, *box);
  const Exposure exposure = random_exposure(light(i), Wear{1, 1.0, 3.0}, random);
  return image_of_yuyv(expose(canvas, exposure, random), canvas.width_px, canvas.height_px);
}

}  // namespace cgsr::lab
