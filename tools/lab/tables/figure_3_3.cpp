// Figure 3.3: a shirt followed out of lamp light into daylight, ours beside the dissertation's plain mode and CAM-Shift. Its own film is not
// public; the simulator draws one with the light, the shirt and the surroundings that the experiment states.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/sim/scene/portable_math.h"
#include "pipeline/color/learn.h"
#include "pipeline/color/light_history.h"
#include "tools/lab/corridor_film.h"
#include "tools/lab/experiment.h"
#include "tools/lab/scoring.h"
#include "tools/lab/trackers.h"

namespace cgsr::lab {
namespace {

constexpr int kTakes = 10;
constexpr int kPerSecond = CorridorFilm::kImages / CorridorFilm::kSeconds;
constexpr double kLeastPrecision = 0.9;
constexpr double kLeastRecall = 0.5;
constexpr std::array<std::string_view, 3> kContenders{"ours", "plain", "CAM-Shift"};

/// Means over the images of one second.
struct Second {
  double precision = 0.0, recall = 0.0, iou = 0.0, found = 0.0;

  [[nodiscard]] bool holds() const { return precision >= kLeastPrecision && recall >= kLeastRecall; }
};
using Seconds = std::array<Second, CorridorFilm::kSeconds>;
using Lights = std::array<std::optional<Light>, CorridorFilm::kSeconds>;

/// What one take gave.
struct Take {
  std::array<Seconds, kContenders.size()> seconds{};  ///< [contender]
  Lights estimated;                                   ///< ours, the plurality of each second
  Lights real;                                        ///< in the last image of each second
  double light_error = 0.0, exact_error = 0.0;        ///< mean over images and channels
  int lights = 0;
  std::vector<double> of_its_hues;  ///< share of the background, once a second
  double near_white = 0.0;          ///< in the image learned from
  Light first_light, last_light;    ///< of the script, linear
};

double mean_error(const Light& a, const Light& b) {
  return (std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b)) / 3.0;
}

/// The light on the shirt in the tracker's terms: what Alg. 3.1 assumed at learning, times how the encoded value of a near-white surface
/// has changed since.
Light in_terms_of_learning(const Light& assumed, const Light& change) {
  constexpr double kNearWhite = 0.9;  // linear; the answer hardly depends on it
  const auto encoded = [](double factor) {
    return sim::srgb_encode(kNearWhite * factor) / sim::srgb_encode(kNearWhite);
  };
  return {assumed.r * encoded(change.r), assumed.g * encoded(change.g), assumed.b * encoded(change.b)};
}

/// Everything that is booked image by image.
class Booking {
 public:
  Booking(Take& take, const Light& assumed) : take_(take), assumed_(assumed) {}

  void box(std::size_t contender, int number, const CorridorFilm::Truth& truth, const std::optional<Box>& found) {
    const ImageScore score = truth.shirt ? score_image(*truth.shirt, found) : ImageScore{};
    Second& second = take_.seconds[contender][static_cast<std::size_t>(number / kPerSecond)];
    second.precision += score.precision / kPerSecond;
    second.recall += score.recall / kPerSecond;
    second.iou += score.iou / kPerSecond;
    second.found += score.found ? 1.0 / kPerSecond : 0.0;
  }

  void light(int number, const CorridorFilm::Truth& truth, const Sighting& seen) {
    const auto second = static_cast<std::size_t>(number / kPerSecond);
    const Light real = in_terms_of_learning(assumed_, truth.light);
    take_.real[second] = real;
    take_.estimated[second] = stripe_.add(MonoTime{} + seconds(number / CorridorFilm::kRate_hz), seen.light);
    if (!seen.light) return;
    take_.light_error += mean_error(*seen.light, real);
    take_.exact_error += mean_error(seen.exact_light.value_or(*seen.light), real);
    ++take_.lights;
  }

 private:
  Take& take_;
  Light assumed_;
  color::LightHistory stripe_;
};

/// What a tracker that has just learned says of the image that it learned from.
Sighting as_learned(const Box& box) {
  Sighting seen;
  seen.box = box;
  return seen;
}

/// The first image: every contender learns from it, and its box is its answer there.
Result<std::vector<std::unique_ptr<BoxTracker>>> learned(const config::Color& configuration, const Image& image,
                                                         const Box& shirt) {
  std::vector<std::unique_ptr<BoxTracker>> all;
  for (const std::string_view name : kContenders) {
    const auto named = std::ranges::find(trackers(), name, &NamedTracker::name);
    all.push_back(named->make(configuration));
    if (auto done = all.back()->learn(image, shirt); !done) return tl::unexpected(done.error());
  }
  return all;
}

Result<Take> run_take(const Setting& setting, std::uint64_t seed) {
  auto film = CorridorFilm::make(seed);
  if (!film) return tl::unexpected(film.error());
  Take take;
  CorridorFilm::Shot shot = (*film)->shoot(0);
  if (!shot.truth.shirt) return fail("the shirt is not in the first image");
  const Box shirt = *shot.truth.shirt;
  const std::array samples{color::Sample{shot.image.view(), shirt}};
  const auto model = color::learn(samples, setting.configuration.learn);
  if (!model) return tl::unexpected(model.error());
  const auto contenders = learned(setting.configuration, shot.image, shirt);
  if (!contenders) return tl::unexpected(contenders.error());

  Booking booking(take, model->model.samples.front().light);
  take.near_white = (*film)->scene_of(shot).near_white;
  take.first_light = (*film)->scripted_light(0.0);
  take.last_light = (*film)->scripted_light(CorridorFilm::kSeconds);
  for (int number = 0; number < CorridorFilm::kImages; ++number) {
    if (number > 0) shot = (*film)->shoot(number);
    for (std::size_t i = 0; i < kContenders.size(); ++i) {
      const Sighting seen = number > 0 ? (*contenders)[i]->track(shot.image) : as_learned(shirt);
      booking.box(i, number, shot.truth, seen.box);
      if (i == 0) booking.light(number, shot.truth, seen);
    }
    if (number % kPerSecond != 0) continue;
    take.of_its_hues.push_back((*film)->scene_of(shot).background_of_its_hues);
    setting.progress(fmt::format("take {}, second {}", seed, number / kPerSecond));
  }
  return take;
}

/// One value of each take.
template <class Value>
std::vector<double> over(const std::vector<Take>& takes, Value value) {
  std::vector<double> values;
  for (const Take& take : takes) values.push_back(value(take));
  return values;
}

double mean_of(const Seconds& film, double Second::*figure) {
  double sum = 0.0;
  for (const Second& second : film) sum += second.*figure;
  return sum / static_cast<double>(film.size());
}

double least_of(const Seconds& film, double Second::*figure) {
  return std::ranges::min(film, {}, figure).*figure;
}

void add_contender_rows(const std::vector<Take>& takes, std::size_t contender, std::uint64_t seed, Report& report) {
  const auto row = std::string(kContenders[contender]);
  const auto add = [&](const char* quantity, auto value) {
    report.rows.push_back(
        mean_row(row, quantity, "", over(takes, [&](const Take& t) { return value(t.seconds[contender]); }), seed));
  };
  add("precision", [](const Seconds& film) { return mean_of(film, &Second::precision); });
  add("recall", [](const Seconds& film) { return mean_of(film, &Second::recall); });
  add("IoU", [](const Seconds& film) { return mean_of(film, &Second::iou); });
  add("found", [](const Seconds& film) { return mean_of(film, &Second::found); });
  add("a take's worst second: precision", [](const Seconds& film) { return least_of(film, &Second::precision); });
  add("a take's worst second: recall", [](const Seconds& film) { return least_of(film, &Second::recall); });
  int held = 0;
  for (const Take& take : takes) {
    held += static_cast<int>(std::ranges::count_if(take.seconds[contender], &Second::holds));
  }
  report.rows.push_back(
      share_row(row, "seconds that hold", held, static_cast<int>(takes.size()) * CorridorFilm::kSeconds));
}

void add_light_rows(const std::vector<Take>& takes, std::uint64_t seed, Report& report) {
  const auto per_image = [](double Take::*sum) {
    return [sum](const Take& take) { return take.*sum / std::max(1, take.lights); };
  };
  report.rows.push_back(mean_row("light on the shirt, estimated on the grid", "error per channel", "",
                                 over(takes, per_image(&Take::light_error)), seed));
  report.rows.push_back(mean_row("light on the shirt, not bound to the grid", "error per channel", "",
                                 over(takes, per_image(&Take::exact_error)), seed));
}

void add_scene_rows(const std::vector<Take>& takes, std::uint64_t seed, Report& report) {
  report.rows.push_back(mean_row("scene", "background of its hues", "",
                                 over(takes, [](const Take& t) { return mean(t.of_its_hues); }), seed));
  report.rows.push_back(
      mean_row("scene", "near-white at learning", "", over(takes, [](const Take& t) { return t.near_white; }), seed));
  for (const auto& [name, light] :
       {std::pair("light at first", takes.front().first_light), std::pair("light at last", takes.front().last_light)}) {
    for (const auto& [channel, value] : {std::pair("R", light.r), std::pair("G", light.g), std::pair("B", light.b)}) {
      report.rows.push_back({fmt::format("scene, {} (linear)", name), channel, "", {}, value, {}, 1});
    }
  }
}

/// Precision per second, as the figure's first row shows it, with the recall that keeps it honest.
void add_seconds(const std::vector<Take>& takes, std::uint64_t seed, Report& report) {
  Plot plot{"Precision in each second, mean of the takes", "s", "precision", {}};
  for (const std::string_view name : kContenders) plot.curves.push_back({std::string(name), {}});
  for (std::size_t s = 0; s < CorridorFilm::kSeconds; ++s) {
    const std::string row = fmt::format("second {:2}", s);
    for (std::size_t i = 0; i < kContenders.size(); ++i) {
      const auto add = [&](const char* quantity, double Second::*figure) {
        report.rows.push_back(mean_row(row, fmt::format("{}: {}", kContenders[i], quantity), "",
                                       over(takes, [&](const Take& t) { return t.seconds[i][s].*figure; }), seed));
      };
      add("precision", &Second::precision);
      plot.curves[i].points.push_back({static_cast<double>(s), *report.rows.back().ours, report.rows.back().interval});
      if (i == 0) add("recall", &Second::recall);
    }
  }
  report.plots.push_back(std::move(plot));
}

Stripe stripe_of(const Take& take) {
  Stripe stripe{"Light on the shirt in each second of the first take, relative to what Alg. 3.1 assumed at learning",
                {{"estimated", {}}, {"true", {}}}};
  for (std::size_t s = 0; s < take.real.size(); ++s) {
    stripe.bands[0].colors.push_back(take.estimated[s]);
    stripe.bands[1].colors.push_back(take.real[s]);
  }
  return stripe;
}

}  // namespace

Result<Report> figure_3_3(const Setting& setting) {
  std::vector<Take> takes;
  for (int i = 0; i < setting.trials.value_or(kTakes); ++i) {
    auto take = run_take(setting, setting.seed + static_cast<std::uint64_t>(i));
    if (!take) return tl::unexpected(take.error());
    takes.push_back(std::move(*take));
  }
  Report report;
  report.name = "figure-3.3";
  report.title = fmt::format("a shirt followed from a corridor's lamps into daylight, {} s at {:.0f} Hz, {} takes",
                             CorridorFilm::kSeconds, CorridorFilm::kRate_hz, takes.size());
  report.config_sha256 = setting.config_sha256();
  report.seed = setting.seed;
  for (std::size_t i = 0; i < kContenders.size(); ++i) add_contender_rows(takes, i, setting.seed, report);
  add_light_rows(takes, setting.seed, report);
  add_scene_rows(takes, setting.seed, report);
  add_seconds(takes, setting.seed, report);
  report.stripes.push_back(stripe_of(takes.front()));
  report.notes = {
      "The dissertation shows its figure and states no numbers; its column is empty.",
      fmt::format(
          "A second holds when precision is at least {} and recall at least {}, each the mean of its {} images.",
          kLeastPrecision, kLeastRecall, kPerSecond),
      "The truth is the box around the visible part of the shirt without its sleeves. A take has its own walker, ways, "
      "camera tilt and noise.",
      "A background pixel shares the shirt's hues when its hue, to 10 degrees, is that of at least a twentieth of the "
      "shirt's coloured "
      "pixels in the same image; near-white is what a tenth of the shirt's pixels reach in their brightest channel."};
  return report;
}

}  // namespace cgsr::lab
