#include "tools/lab/tables/corridor_take.h"

#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/sim/scene/portable_math.h"
#include "pipeline/color/learn/learn.h"
#include "pipeline/color/track/light_history.h"
#include "tools/lab/scoring.h"
#include "tools/lab/trackers.h"

namespace cgsr::lab {
namespace {

constexpr int kPerSecond = CorridorFilm::kImages / CorridorFilm::kSeconds;
constexpr std::array kShown_s{1, 15, 25, 35};  // as in the dissertation

using Contenders = std::vector<std::unique_ptr<BoxTracker>>;
using Sightings = std::array<Sighting, kCorridorTrackers.size()>;

double mean_error(const Light& a, const Light& b) {
  return (std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b)) / 3.0;
}

/// What Alg. 3.1 assumed at learning, times how the encoded value of a near-white surface has changed since.
Light in_terms_of_learning(const Light& assumed, const Light& change) {
  constexpr double kNearWhite = 0.9;  // linear; the answer hardly depends on it
  const auto encoded = [](double factor) {
    return sim::srgb_encode(kNearWhite * factor) / sim::srgb_encode(kNearWhite);
  };
  return {assumed.r * encoded(change.r), assumed.g * encoded(change.g), assumed.b * encoded(change.b)};
}

void draw_box(const std::optional<Box>& box, const cv::Scalar& color, cv::Mat& picture) {
  if (box) cv::rectangle(picture, cv::Rect2d(box->x, box->y, box->width, box->height), color, 2);
}

/// The truth in blue, ours in red, CAM-Shift in green, as in the dissertation; the plain mode in yellow.
Picture picture_of(const CorridorFilm::Shot& shot, const Sightings& seen, int second) {
  const std::array<cv::Scalar, kCorridorTrackers.size()> colors{cv::Scalar(0, 0, 255), cv::Scalar(0, 220, 255),
                                                                cv::Scalar(0, 200, 0)};
  cv::Mat drawn = shot.image.bgr.clone();
  for (std::size_t i = seen.size(); i-- > 0;) draw_box(seen[i].box, colors[i], drawn);
  draw_box(shot.truth.shirt, cv::Scalar(255, 60, 0), drawn);
  Picture picture{fmt::format("t = {} s: true blue, ours red, plain yellow, CAM-Shift green", second), {}};
  cv::imencode(".jpg", drawn, picture.jpeg, {cv::IMWRITE_JPEG_QUALITY, 85});
  return picture;
}

/// Everything that is booked image by image.
class Booking {
 public:
  Booking(CorridorTake& take, const Light& assumed) : take_(take), assumed_(assumed) {}

  void add(int number, const CorridorFilm::Truth& truth, const Sightings& seen) {
    for (std::size_t i = 0; i < seen.size(); ++i) add_box(i, number, truth, seen[i].box);
    add_light(number, truth, seen.front());
  }

 private:
  void add_box(std::size_t tracker, int number, const CorridorFilm::Truth& truth, const std::optional<Box>& found) {
    const ImageScore score = truth.shirt ? score_image(*truth.shirt, found) : ImageScore{};
    CorridorSecond& second = take_.seconds[tracker][static_cast<std::size_t>(number / kPerSecond)];
    second.precision += score.precision / kPerSecond;
    second.recall += score.recall / kPerSecond;
    second.iou += score.iou / kPerSecond;
    second.found += score.found ? 1.0 / kPerSecond : 0.0;
  }

  void add_light(int number, const CorridorFilm::Truth& truth, const Sighting& seen) {
    const auto second = static_cast<std::size_t>(number / kPerSecond);
    const Light real = in_terms_of_learning(assumed_, truth.light);
    take_.real[second] = real;
    take_.estimated[second] = stripe_.add(MonoTime{} + seconds(number / CorridorFilm::kRate_hz), seen.light);
    if (!seen.light) return;
    take_.exact[second] = seen.exact_light;
    take_.light_error += mean_error(*seen.light, real);
    take_.exact_error += mean_error(seen.exact_light.value_or(*seen.light), real);
    ++take_.lights;
  }

  CorridorTake& take_;
  Light assumed_;
  color::LightHistory stripe_;
};

Result<Contenders> learned(const config::Color& configuration, const Image& image, const Box& shirt) {
  Contenders all;
  for (const std::string_view name : kCorridorTrackers) {
    const auto named = std::ranges::find(trackers(), name, &NamedTracker::name);
    all.push_back(named->make(configuration));
    if (auto done = all.back()->learn(image, shirt); !done) return tl::unexpected(done.error());
  }
  return all;
}

Sightings look(const Contenders& contenders, const Image& image) {
  Sightings seen;
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = contenders[i]->track(image);
  return seen;
}

/// What they say of the image that they learned from.
Sightings as_learned(const Box& box) {
  Sightings seen;
  for (Sighting& one : seen) one.box = box;
  return seen;
}

}  // namespace

Result<CorridorTake> run_corridor_take(const Setting& setting, std::uint64_t seed) {
  auto film = CorridorFilm::make(seed);
  if (!film) return tl::unexpected(film.error());
  CorridorFilm::Shot shot = (*film)->shoot(0);
  if (!shot.truth.shirt) return fail("the shirt is not in the first image");
  const Box shirt = *shot.truth.shirt;
  const std::array samples{color::Sample{shot.image.view(), shirt}};
  const auto model = color::learn(samples, setting.configuration.learn);
  if (!model) return tl::unexpected(model.error());
  const auto contenders = learned(setting.configuration, shot.image, shirt);
  if (!contenders) return tl::unexpected(contenders.error());

  CorridorTake take;
  take.near_white = (*film)->scene_of(shot).near_white;
  take.first_light = (*film)->scripted_light(0.0);
  take.last_light = (*film)->scripted_light(CorridorFilm::kSeconds);
  Booking booking(take, model->model.samples.front().light);
  for (int number = 0; number < CorridorFilm::kImages; ++number) {
    if (number > 0) shot = (*film)->shoot(number);
    const Sightings seen = number > 0 ? look(*contenders, shot.image) : as_learned(shirt);
    booking.add(number, shot.truth, seen);
    if (number % kPerSecond != 0) continue;
    const int second = number / kPerSecond;
    take.of_its_hues.push_back((*film)->scene_of(shot).background_of_its_hues);
    if (std::ranges::count(kShown_s, second) > 0) take.pictures.push_back(picture_of(shot, seen, second));
    setting.progress(fmt::format("take {}, second {}", seed, second));
  }
  return take;
}

}  // namespace cgsr::lab
