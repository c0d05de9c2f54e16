// Figure 3.3: a shirt followed out of lamp light into daylight, ours beside the dissertation's plain mode and CAM-Shift. Its own film is not
// public; the simulator draws one with the light, the shirt and the surroundings that the experiment states.

#include <utility>

#include <fmt/format.h>

#include "tools/lab/tables/corridor_take.h"

namespace cgsr::lab {
namespace {

constexpr double kLeastPrecision = 0.9;
constexpr double kLeastRecall = 0.5;

using Takes = std::vector<CorridorTake>;
using Figure = double CorridorSecond::*;

bool holds(const CorridorSecond& second) {
  return second.precision >= kLeastPrecision && second.recall >= kLeastRecall;
}

/// One value of each take.
template <class Value>
std::vector<double> over(const Takes& takes, Value value) {
  std::vector<double> values;
  for (const CorridorTake& take : takes) values.push_back(value(take));
  return values;
}

double mean_of(const CorridorSeconds& film, Figure figure) {
  double sum = 0.0;
  for (const CorridorSecond& second : film) sum += second.*figure;
  return sum / static_cast<double>(film.size());
}

double least_of(const CorridorSeconds& film, Figure figure) {
  return std::ranges::min(film, {}, figure).*figure;
}

void add_tracker_rows(const Takes& takes, std::size_t tracker, std::uint64_t seed, Report& report) {
  const auto row = std::string(kCorridorTrackers[tracker]);
  const auto add = [&](const char* quantity, double (*of)(const CorridorSeconds&, Figure), Figure figure) {
    const auto values = over(takes, [&](const CorridorTake& take) { return of(take.seconds[tracker], figure); });
    report.rows.push_back(mean_row(row, quantity, "", values, seed));
  };
  add("precision", mean_of, &CorridorSecond::precision);
  add("recall", mean_of, &CorridorSecond::recall);
  add("IoU", mean_of, &CorridorSecond::iou);
  add("found", mean_of, &CorridorSecond::found);
  add("worst second: precision", least_of, &CorridorSecond::precision);
  add("worst second: recall", least_of, &CorridorSecond::recall);
  int held = 0;
  for (const CorridorTake& take : takes) held += static_cast<int>(std::ranges::count_if(take.seconds[tracker], holds));
  report.rows.push_back(
      share_row(row, "seconds that hold", held, static_cast<int>(takes.size()) * CorridorFilm::kSeconds));
}

void add_light_rows(const Takes& takes, std::uint64_t seed, Report& report) {
  const auto per_image = [](double CorridorTake::*sum) {
    return [sum](const CorridorTake& take) { return take.*sum / std::max(1, take.lights); };
  };
  report.rows.push_back(mean_row("light on the shirt, estimated on the grid", "error per channel", "",
                                 over(takes, per_image(&CorridorTake::light_error)), seed));
  report.rows.push_back(mean_row("light on the shirt, not bound to the grid", "error per channel", "",
                                 over(takes, per_image(&CorridorTake::exact_error)), seed));
}

void add_scene_rows(const Takes& takes, std::uint64_t seed, Report& report) {
  report.rows.push_back(mean_row("scene, background in the shirt's hues", "value", "",
                                 over(takes, [](const CorridorTake& t) { return mean(t.of_its_hues); }), seed));
  report.rows.push_back(mean_row("scene, near-white at learning", "value", "",
                                 over(takes, [](const CorridorTake& t) { return t.near_white; }), seed));
  for (const auto& [name, light] :
       {std::pair("light at first", takes.front().first_light), std::pair("light at last", takes.front().last_light)}) {
    for (const auto& [channel, value] : {std::pair("R", light.r), std::pair("G", light.g), std::pair("B", light.b)}) {
      report.rows.push_back({fmt::format("scene, {} (linear)", name), channel, "", {}, value, {}, 1});
    }
  }
}

/// Precision per second, as the figure's first row shows it, with the recall that keeps it honest.
void add_seconds(const Takes& takes, std::uint64_t seed, Report& report) {
  Plot plot{"Precision in each second, mean of the takes", "s", "precision", {}};
  for (std::size_t i = 0; i < kCorridorTrackers.size(); ++i) {
    Curve curve{std::string(kCorridorTrackers[i]), {}};
    for (std::size_t s = 0; s < CorridorFilm::kSeconds; ++s) {
      const auto row_of = [&](const char* quantity, Figure figure) {
        const auto values = over(takes, [&](const CorridorTake& take) { return take.seconds[i][s].*figure; });
        return mean_row(fmt::format("{}, second {}", kCorridorTrackers[i], s), quantity, "", values, seed);
      };
      const Row& precision = report.rows.emplace_back(row_of("precision", &CorridorSecond::precision));
      curve.points.push_back({static_cast<double>(s), *precision.ours, precision.interval});
      report.rows.push_back(row_of("recall", &CorridorSecond::recall));
    }
    plot.curves.push_back(std::move(curve));
  }
  report.plots.push_back(std::move(plot));
}

Stripe stripe_of(const CorridorTake& take) {
  Stripe stripe{"Light on the shirt in each second of the first take, relative to what Alg. 3.1 assumed at learning",
                {{"plurality, grid", {}}, {"between its lights", {}}, {"true", {}}}};
  for (std::size_t s = 0; s < take.real.size(); ++s) {
    stripe.bands[0].colors.push_back(take.estimated[s]);
    stripe.bands[1].colors.push_back(take.exact[s]);
    stripe.bands[2].colors.push_back(take.real[s]);
  }
  return stripe;
}

}  // namespace

Result<Report> figure_3_3(const Setting& setting) {
  Takes takes;
  for (int i = 0; i < setting.trials; ++i) {
    auto take = run_corridor_take(setting, setting.seed + static_cast<std::uint64_t>(i));
    if (!take) return tl::unexpected(take.error());
    takes.push_back(std::move(*take));
  }
  Report report;
  report.title = fmt::format("a shirt followed from a corridor's lamps into daylight, {} s at {:.0f} Hz, {} takes",
                             CorridorFilm::kSeconds, CorridorFilm::kRate_hz, takes.size());
  for (std::size_t i = 0; i < kCorridorTrackers.size(); ++i) add_tracker_rows(takes, i, setting.seed, report);
  add_light_rows(takes, setting.seed, report);
  add_scene_rows(takes, setting.seed, report);
  add_seconds(takes, setting.seed, report);
  report.stripes.push_back(stripe_of(takes.front()));
  report.pictures = std::move(takes.front().pictures);
  report.notes = {
      "The dissertation shows its figure and states no numbers; its column is empty.",
      fmt::format("A second holds when precision is at least {} and recall at least {}, means over its images.",
                  kLeastPrecision, kLeastRecall),
      "The truth is the box around the visible part of the shirt without its sleeves. A take has its own walker, ways, "
      "camera tilt and noise.",
      "A background pixel shares the shirt's hues when its hue, to 10 degrees, is that of at least a twentieth of the "
      "shirt's coloured pixels in the same image; near-white is what a tenth of the shirt's pixels reach in their "
      "brightest channel."};
  return report;
}

}  // namespace cgsr::lab
