#include "tools/lab/scenes/scene.h"

#include <algorithm>
#include <cmath>

#include "tools/lab/scenes/clutter.h"

namespace cgsr::lab {
namespace {

// Streams of one world: what they feed stays the same when another draws more.
enum Stream : std::uint64_t { kPattern = 1, kLearning = 2, kScenes = 1000 };

Image photograph(const Canvas& canvas, const Exposure& exposure, const Random& random) {
  return image_of_yuyv(expose(canvas, exposure, random), canvas.width_px, canvas.height_px);
}

}  // namespace

Light absolute_light(const Light& light, const Light& assumed) {
  return {kLearningLight * light.r / assumed.r, kLearningLight * light.g / assumed.g,
          kLearningLight * light.b / assumed.b};
}

Box random_place(double width_px, double height_px, Random& random) {
  const double x = std::floor(random.uniform(0.0, kSceneWidthPx - width_px));
  const double y = std::floor(random.uniform(0.0, kSceneHeightPx - height_px));
  return {x, y, width_px, height_px};
}

Exposure random_exposure(const Light& light, const Wear& wear, Random& random) {
  return {light, random.below(wear.most_blur_passes + 1), random.uniform(wear.min_noise, wear.most_noise)};
}

Light assumed_light(const ImageView& yuyv, const Box& box) {
  Light most{kLearningLight, kLearningLight, kLearningLight};
  for (int y = static_cast<int>(box.y); y < static_cast<int>(box.y + box.height); ++y) {
    for (int x = static_cast<int>(box.x); x < static_cast<int>(box.x + box.width); ++x) {
      const std::uint8_t* pair = yuyv.row(y) + static_cast<std::ptrdiff_t>(x / 2) * 4;
      const double luma = (pair[x % 2 * 2] - 16) / 219.0;
      const double u = (pair[1] - 128) / 224.0, v = (pair[3] - 128) / 224.0;
      // The inverse of BT.601.
      most.r = std::max(most.r, std::min(1.0, luma + 1.402 * v));
      most.g = std::max(most.g, std::min(1.0, luma - 0.344136 * u - 0.714136 * v));
      most.b = std::max(most.b, std::min(1.0, luma + 1.772 * u));
    }
  }
  return most;
}

ObjectWorld::ObjectWorld(std::uint64_t seed) : random_(Random(seed).fork(0)), pattern_(random_.fork(kPattern)) {
  Random random = random_.fork(kLearning);
  const double width_px = 2 * (28 + random.below(44)), height_px = 2 * (28 + random.below(44));
  learning_box_ = random_place(width_px, height_px, random);
  Canvas canvas = random_clutter(kSceneWidthPx, kSceneHeightPx, pattern_.palette(), kSharedHues, random.fork(1));
  paint(canvas, pattern_, learning_box_);
  const Exposure exposure = random_exposure({kLearningLight, kLearningLight, kLearningLight}, Wear{}, random);
  learning_image_ = photograph(canvas, exposure, random.fork(2));
  assumed_light_ = lab::assumed_light(learning_image_.view(), learning_box_);
}

Image ObjectWorld::scene(std::uint64_t number, const Light& light, bool present, double scale,
                         std::optional<Box>& truth) const {
  Random random = random_.fork(kScenes + number);
  Canvas canvas = random_clutter(kSceneWidthPx, kSceneHeightPx, pattern_.palette(), kSharedHues, random.fork(1));
  const Box place =
      random_place(std::round(scale * learning_box_.width), std::round(scale * learning_box_.height), random);
  if (present) paint(canvas, pattern_, place);
  truth = present ? std::optional(place) : std::nullopt;
  const Exposure exposure = random_exposure(absolute_light(light, assumed_light_), Wear{}, random);
  return photograph(canvas, exposure, random.fork(2));
}

}  // namespace cgsr::lab
