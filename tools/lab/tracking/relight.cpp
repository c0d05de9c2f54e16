#include "tools/lab/tracking/relight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/lab/scenes/random.h"

namespace cgsr::lab {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kMiddle = 0.75;  // of gains from .5 to 1
constexpr double kSwing = 0.25;

using Gains = std::vector<Light>;

Gains sinusoids(int images, Random random) {
  struct Wave {
    double period, phase;
  };
  std::array<Wave, 3> waves{};
  for (Wave& wave : waves) wave = {random.uniform(80.0, 200.0), random.uniform()};
  Gains gains;
  for (int i = 0; i < images; ++i) {
    const auto at = [&](const Wave& wave) {
      return kMiddle + kSwing * std::sin(kTurn * (i / wave.period + wave.phase));
    };
    gains.push_back({at(waves[0]), at(waves[1]), at(waves[2])});
  }
  return gains;
}

Gains steps(int images, Random random) {
  const auto level = [&] { return random.uniform(kMiddle - kSwing, kMiddle + kSwing); };
  Gains gains;
  while (static_cast<int>(gains.size()) < images) {
    const double r = level(), g = level(), b = level();
    const int length = 25 + random.below(26);
    gains.insert(gains.end(), static_cast<std::size_t>(length), Light{r, g, b});
  }
  gains.resize(static_cast<std::size_t>(images));
  return gains;
}

Gains warm_cold(int images, Random random) {
  const double period = random.uniform(80.0, 160.0), phase = random.uniform();
  Gains gains;
  for (int i = 0; i < images; ++i) {
    const double warm = kSwing * std::sin(kTurn * (i / period + phase));
    gains.push_back({kMiddle + warm, kMiddle, kMiddle - warm});
  }
  return gains;
}

Gains dimming(int images) {
  constexpr double kQuarter = 0.25;
  Gains gains;
  for (int i = 0; i < images; ++i) {
    const double dimmed = 0.5 - 0.5 * std::cos(kTurn * i / std::max(images - 1, 1));
    const double gain = 1.0 - (1.0 - kQuarter) * dimmed;
    gains.push_back({gain, gain, gain});
  }
  return gains;
}

std::uint8_t byte_of(double share) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

using Curve = std::array<std::uint8_t, 256>;

/// What a recorded value becomes under a gain.
Curve curve_of(double gain) {
  Curve curve{};
  for (int i = 0; i < 256; ++i)
    curve[static_cast<std::size_t>(i)] = byte_of(srgb_encoded(gain * srgb_linear(i / 255.0)));
  return curve;
}

/// The curves of 1024 gains from 0 to 1, for lights that differ from pixel to pixel.
const std::vector<Curve>& curves() {
  static const std::vector<Curve> all = [] {
    std::vector<Curve> made;
    for (int gain = 0; gain < 1024; ++gain) made.push_back(curve_of(gain / 1023.0));
    return made;
  }();
  return all;
}

const Curve& nearest_curve(double gain) {
  return curves()[static_cast<std::size_t>(std::lround(1023.0 * std::clamp(gain, 0.0, 1.0)))];
}

}  // namespace

std::string_view to_string(LightChange change) {
  switch (change) {
    case LightChange::kSinusoids:
      return "sinusoids";
    case LightChange::kSteps:
      return "steps";
    case LightChange::kWarmCold:
      return "warm-cold swing";
    case LightChange::kDimming:
      return "dimming to a quarter";
    case LightChange::kSpot:
      return "moving spot";
  }
  return "";
}

double srgb_encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double srgb_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

LightCourse LightCourse::constant(const Light& gain, int images) {
  LightCourse course;
  course.base_.assign(static_cast<std::size_t>(images), gain);
  return course;
}

LightCourse LightCourse::changing(LightChange change, int images, const cv::Size& size, std::uint64_t seed) {
  Random random = Random(seed).fork(static_cast<std::uint64_t>(change) + 1);
  LightCourse course;
  switch (change) {
    case LightChange::kSinusoids:
      course.base_ = sinusoids(images, random);
      break;
    case LightChange::kSteps:
      course.base_ = steps(images, random);
      break;
    case LightChange::kWarmCold:
      course.base_ = warm_cold(images, random);
      break;
    case LightChange::kDimming:
      course.base_ = dimming(images);
      break;
    case LightChange::kSpot:
      course.base_.assign(static_cast<std::size_t>(images), {0.5, 0.5, 0.5});
      break;
  }
  if (change != LightChange::kSpot) return course;
  // One channel is full, the others are drawn; the spot wanders on a Lissajous figure over the whole image.
  std::array<double, 3> color{0.5 * random.uniform(), 0.5 * random.uniform(), 0.5 * random.uniform()};
  color[static_cast<std::size_t>(random.below(3))] = 0.5;
  const double period_x = random.uniform(80.0, 200.0), period_y = random.uniform(80.0, 200.0);
  const double phase_x = random.uniform(), phase_y = random.uniform();
  for (int i = 0; i < images; ++i) {
    course.spots_.push_back({size.width * (0.5 + 0.4 * std::sin(kTurn * (i / period_x + phase_x))),
                             size.height * (0.5 + 0.4 * std::sin(kTurn * (i / period_y + phase_y))),
                             0.25 * std::hypot(size.width, size.height),
                             {color[0], color[1], color[2]}});
  }
  return course;
}

Light LightCourse::gain(int image, double x_px, double y_px) const {
  const auto i = static_cast<std::size_t>(image);
  Light gain = base_[i];
  if (is_uniform()) return gain;
  const Spot& spot = spots_[i];
  const double dx = (x_px - spot.x_px) / spot.sigma_px, dy = (y_px - spot.y_px) / spot.sigma_px;
  const double share = std::exp(-0.5 * (dx * dx + dy * dy));
  return {gain.r + share * spot.added.r, gain.g + share * spot.added.g, gain.b + share * spot.added.b};
}

Light LightCourse::mean_gain(int image, const Box& box, const cv::Size& size) const {
  if (is_uniform()) return base_[static_cast<std::size_t>(image)];
  const auto from = [](double edge, int end) { return std::clamp(static_cast<int>(std::lround(edge)), 0, end); };
  cv::Rect pixels(cv::Point(from(box.x, size.width), from(box.y, size.height)),
                  cv::Point(from(box.x + box.width, size.width), from(box.y + box.height, size.height)));
  if (pixels.empty()) pixels = cv::Rect(cv::Point(), size);
  Light sum{0.0, 0.0, 0.0};
  for (int y = pixels.y; y < pixels.br().y; ++y) {
    for (int x = pixels.x; x < pixels.br().x; ++x) {
      const Light here = gain(image, x + 0.5, y + 0.5);
      sum = {sum.r + here.r, sum.g + here.g, sum.b + here.b};
    }
  }
  const double count = pixels.area();
  return {sum.r / count, sum.g / count, sum.b / count};
}

cv::Mat relit_picture(const cv::Mat& bgr, const LightCourse& light, int image) {
  cv::Mat out(bgr.size(), CV_8UC3);
  const Light one = light.gain(image, 0.0, 0.0);
  const Curve blue = curve_of(one.b), green = curve_of(one.g), red = curve_of(one.r);
  for (int y = 0; y < bgr.rows; ++y) {
    const auto* from = bgr.ptr<cv::Vec3b>(y);
    auto* to = out.ptr<cv::Vec3b>(y);
    for (int x = 0; x < bgr.cols; ++x) {
      if (light.is_uniform()) {
        to[x] = {blue[from[x][0]], green[from[x][1]], red[from[x][2]]};
        continue;
      }
      const Light here = light.gain(image, x + 0.5, y + 0.5);
      to[x] = {nearest_curve(here.b)[from[x][0]], nearest_curve(here.g)[from[x][1]], nearest_curve(here.r)[from[x][2]]};
    }
  }
  return out;
}

Film relit(const Film& film, const LightCourse& light) {
  const auto image = [original = film.image, light](int i) -> Result<Image> {
    auto recorded = original(i);
    if (!recorded) return recorded;
    return image_of_bgr(relit_picture(recorded->bgr, light, i));
  };
  return {film.name, image, film.truth};
}

std::vector<std::optional<Light>> true_lights(const Film& film, const LightCourse& light, const cv::Size& size) {
  const auto encoded = [&](int i) {
    const Light gain = light.mean_gain(i, *film.truth[static_cast<std::size_t>(i)], size);
    return Light{srgb_encoded(gain.r), srgb_encoded(gain.g), srgb_encoded(gain.b)};
  };
  const Light first = encoded(0);
  std::vector<std::optional<Light>> lights(film.truth.size());
  for (int i = 0; i < film.size(); ++i) {
    if (!film.truth[static_cast<std::size_t>(i)]) continue;
    const Light here = encoded(i);
    lights[static_cast<std::size_t>(i)] = Light{here.r / first.r, here.g / first.g, here.b / first.b};
  }
  return lights;
}

Light mean_gain_of_object(const Film& film, const LightCourse& light, const cv::Size& size) {
  Light sum{0.0, 0.0, 0.0};
  int images = 0;
  for (int i = 0; i < film.size(); ++i) {
    const auto& box = film.truth[static_cast<std::size_t>(i)];
    if (!box) continue;
    const Light gain = light.mean_gain(i, *box, size);
    sum = {sum.r + gain.r, sum.g + gain.g, sum.b + gain.b};
    ++images;
  }
  const double count = std::max(images, 1);
  return {sum.r / count, sum.g / count, sum.b / count};
}

}  // namespace cgsr::lab
