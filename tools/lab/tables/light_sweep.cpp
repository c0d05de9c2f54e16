// Chapter 3's claim on scenes whose light is known: found inside the range of simulated lights, how it falls outside, and the false
// positives that a wider range costs (3.2.1).

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "tools/lab/experiment.h"
#include "tools/lab/ours.h"
#include "tools/lab/scenes/scene.h"
#include "tools/lab/scoring.h"

namespace cgsr::lab {
namespace {

constexpr double kLow = 0.6, kHigh = 1.0;  // the range of Alg. 3.1
constexpr double kSpread = 0.05;           // around a brightness of the falling curve, per channel

Light random_light(double low, double high, Random& random) {
  return {random.uniform(low, high), random.uniform(low, high), random.uniform(low, high)};
}

struct Contender {
  std::string_view name;
  std::unique_ptr<BoxTracker> (*make)(const config::Color&, Start);
};
constexpr std::array kContenders{Contender{"ours", make_ours}, Contender{"plain", make_plain}};

/// What one trial looks like.
struct Draw {
  double low = kLow;  ///< of the light, per channel
  double high = kHigh;
  double scale = 1.0;  ///< largest factor by which the object is larger or smaller than when it was learned
  int scenes = 1;      ///< that one tracker is shown one after the other; they have nothing in common but the object
};

/// What trials with the object in view gave; the figures of a trial are means over its scenes.
struct Tally {
  std::vector<double> precision, recall, iou, found;
  std::vector<double> light_error, exact_error, constant_error;  // mean over the channels, where found
  std::vector<double> divergence;                                // of hits
  int nearest = 0, constant_nearest = 0;
};

double grid_nearest(double channel) {
  return std::clamp(std::round((channel - kLow) / 0.2) * 0.2 + kLow, kLow, kHigh);
}

/// Whether both lights have the same nearest light on the grid {0.6, 0.8, 1}^3.
bool same_grid_light(const Light& a, const Light& b) {
  const auto same = [](double x, double y) { return std::abs(grid_nearest(x) - grid_nearest(y)) < 1e-9; };
  return same(a.r, b.r) && same(a.g, b.g) && same(a.b, b.b);
}

double mean_error(const Light& a, const Light& b) {
  return (std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b)) / 3.0;
}

/// Learns the world's object; nothing where learning refuses it.
std::unique_ptr<BoxTracker> learned(const Contender& contender, const ObjectWorld& world,
                                    const config::Color& configuration, Start start) {
  auto tracker = contender.make(configuration, start);
  if (!tracker->learn(world.learning_image(), world.learning_box())) return nullptr;
  return tracker;
}

void book_light(const Sighting& seen, const Light& light, Tally& tally) {
  if (!seen.light) return;
  constexpr Light kConstant{0.8, 0.8, 0.8};
  tally.nearest += same_grid_light(*seen.light, light);
  tally.constant_nearest += same_grid_light(kConstant, light);
  tally.light_error.push_back(mean_error(*seen.light, light));
  tally.exact_error.push_back(mean_error(seen.exact_light.value_or(*seen.light), light));
  tally.constant_error.push_back(mean_error(kConstant, light));
}

/// One trial: a new object, and new scenes with it under lights drawn per channel.
void try_present(const Setting& setting, const Contender& contender, std::uint64_t trial, const Draw& draw,
                 Tally& tally) {
  const ObjectWorld world(Random::mix(setting.seed) + trial);
  Random random = Random(setting.seed).fork(trial);
  const Start start = draw.scenes > 1 ? Start::kWhereLearned : Start::kAnywhere;
  const auto tracker = learned(contender, world, setting.configuration, start);
  ImageScore sum;
  double found = 0.0;
  for (int i = 0; i < draw.scenes; ++i) {
    const Light light = random_light(draw.low, draw.high, random);
    const double scale = random.uniform(1.0 / draw.scale, draw.scale);
    std::optional<Box> truth;
    const Image image = world.scene(static_cast<std::uint64_t>(i), light, true, scale, truth);
    const Sighting seen = tracker ? tracker->track(image) : Sighting{};
    const ImageScore score = score_image(*truth, seen.box);
    sum.precision += score.precision / draw.scenes;
    sum.recall += score.recall / draw.scenes;
    sum.iou += score.iou / draw.scenes;
    found += score.found ? 1.0 / draw.scenes : 0.0;
    book_light(seen, light, tally);
    if (score.success) tally.divergence.push_back(seen.divergence);
  }
  tally.precision.push_back(sum.precision);
  tally.recall.push_back(sum.recall);
  tally.iou.push_back(sum.iou);
  tally.found.push_back(found);
}

Tally try_many(const Setting& setting, const Contender& contender, std::uint64_t first, int trials, const Draw& draw) {
  Tally tally;
  for (int i = 0; i < trials; ++i) try_present(setting, contender, first + static_cast<std::uint64_t>(i), draw, tally);
  return tally;
}

void add_rows(const std::string& row, const Tally& tally, std::uint64_t seed, Report& report) {
  report.rows.push_back(mean_row(row, "precision", "", tally.precision, seed));
  report.rows.push_back(mean_row(row, "recall", "", tally.recall, seed));
  report.rows.push_back(mean_row(row, "IoU", "", tally.iou, seed));
  report.rows.push_back(mean_row(row, "found", "", tally.found, seed));
}

void add_light_rows(const Tally& tally, std::uint64_t seed, Report& report) {
  const auto images = static_cast<int>(tally.light_error.size());
  report.rows.push_back(share_row("light estimate", "nearest grid light", tally.nearest, images));
  report.rows.push_back(mean_row("light estimate", "error per channel", "", tally.light_error, seed));
  report.rows.push_back(
      mean_row("light estimate, not bound to the grid", "error per channel", "", tally.exact_error, seed));
  report.rows.push_back(share_row("always answering 0.8", "nearest grid light", tally.constant_nearest, images));
  report.rows.push_back(mean_row("always answering 0.8", "error per channel", "", tally.constant_error, seed));
}

void add_inside_rows(const Setting& setting, int trials, Report& report) {
  for (const Contender& contender : kContenders) {
    setting.progress(fmt::format("{}, light inside the range", contender.name));
    const Tally inside = try_many(setting, contender, 0, trials, Draw{});
    const Tally scaled = try_many(setting, contender, 50000, trials / 2, Draw{.scale = 1.25});
    const Tally in_a_row = try_many(setting, contender, 70000, trials / 8, Draw{.scenes = 8});
    add_rows(fmt::format("{}, light 0.6 to 1", contender.name), inside, setting.seed, report);
    add_rows(fmt::format("{}, light 0.6 to 1, scaled by 0.8 to 1.25", contender.name), scaled, setting.seed, report);
    add_rows(fmt::format("{}, light 0.6 to 1, unrelated scenes in a row", contender.name), in_a_row, setting.seed,
             report);
    if (contender.name == "ours") add_light_rows(inside, setting.seed, report);
  }
}

void sweep_brightness(const Setting& setting, int trials, Report& report) {
  for (const Contender& contender : kContenders) {
    Plot plot{
        fmt::format("{}: found, and how well, as the light leaves the simulated range (0.6 to 1)", contender.name),
        "light, all channels within 0.05",
        "share",
        {{"precision", {}}, {"IoU", {}}, {"found", {}}}};
    for (int tenths = 1; tenths <= 15; ++tenths) {
      const double light = tenths / 10.0;
      setting.progress(fmt::format("{}, light {:.1f}", contender.name, light));
      const Tally tally = try_many(setting, contender, 100000, trials, Draw{light - kSpread, light + kSpread});
      const std::string row =
          fmt::format("{}, light {:.2f} to {:.2f}", contender.name, light - kSpread, light + kSpread);
      add_rows(row, tally, setting.seed, report);
      const std::array figures{tally.precision, tally.iou, tally.found};
      for (std::size_t i = 0; i < figures.size(); ++i) {
        const Row figure = mean_row("", "", "", figures[i], setting.seed);
        plot.curves[i].points.push_back({light, figure.ours.value_or(0.0), figure.interval});
      }
    }
    report.plots.push_back(std::move(plot));
  }
}

/// Scenes without the object, under light inside the range. \return the divergence of every box that was found in one.
std::vector<double> finds_without_object(const Setting& setting, const Contender& contender, int trials) {
  std::vector<double> divergences;
  for (int i = 0; i < trials; ++i) {
    const std::uint64_t trial = 200000 + static_cast<std::uint64_t>(i);
    const ObjectWorld world(Random::mix(setting.seed) + trial);
    Random random = Random(setting.seed).fork(trial);
    std::optional<Box> truth;
    const Image image = world.scene(0, random_light(kLow, kHigh, random), false, 1.0, truth);
    const auto tracker = learned(contender, world, setting.configuration, Start::kAnywhere);
    const Sighting seen = tracker ? tracker->track(image) : Sighting{};
    if (seen.box) divergences.push_back(seen.divergence);
  }
  return divergences;
}

/// The threshold under which a tracker would keep 95 % of what it hits with the light inside the range.
double tight_threshold(const Setting& setting, const Contender& contender, int trials) {
  auto hits = try_many(setting, contender, 0, trials, Draw{}).divergence;
  if (hits.empty()) return 0.0;
  std::ranges::sort(hits);
  return hits[hits.size() * 95 / 100];
}

/// The known weakness of 3.2.1: the darker the lights that are simulated, the more that is not the object looks like it. The shipped
/// threshold is generous, since more than it decides; at a tight one the weakness of the histograms themselves is seen.
void sweep_lower_bound(const Setting& setting, int trials, Report& report) {
  Plot plot{"Scenes without the object in which one is found, as the lower bound of the light rises",
            "lower bound",
            "share",
            {}};
  for (const Contender& contender : kContenders) {
    const std::array thresholds{setting.configuration.track.max_divergence,
                                tight_threshold(setting, contender, trials)};
    std::array<Curve, 2> curves;
    for (int tenths = 2; tenths <= 6; ++tenths) {
      Setting wider = setting;
      wider.configuration.learn.lights.min_level = tenths / 10.0;
      setting.progress(fmt::format("{}, object absent, lower bound {:.1f}", contender.name, tenths / 10.0));
      const auto finds = finds_without_object(wider, contender, trials);
      for (std::size_t i = 0; i < thresholds.size(); ++i) {
        const auto count = std::ranges::count_if(finds, [&](double divergence) { return divergence <= thresholds[i]; });
        report.rows.push_back(share_row(fmt::format("{}, object absent, threshold {:.3f} nat, lower bound {:.1f}",
                                                    contender.name, thresholds[i], tenths / 10.0),
                                        "false positives", static_cast<int>(count), trials));
        curves[i].name = fmt::format("{}, {:.2f} nat", contender.name, thresholds[i]);
        curves[i].points.push_back({tenths / 10.0, *report.rows.back().ours, report.rows.back().interval});
      }
    }
    plot.curves.insert(plot.curves.end(), curves.begin(), curves.end());
  }
  report.plots.push_back(std::move(plot));
}

}  // namespace

Result<Report> light_sweep(const Setting& setting) {
  Report report{"light-sweep",
                "generated scenes, one new object each, in clutter of which a third has the object's hues",
                "",
                setting.seed,
                {},
                {},
                {}};
  const int trials = setting.trials;
  add_inside_rows(setting, trials, report);
  sweep_lower_bound(setting, trials / 2, report);
  sweep_brightness(setting, trials / 4, report);
  report.notes = {
      "The dissertation shows no table for this (3.2.1 says in words that light below 0.4 gives many false positives); "
      "its column is empty.",
      "Light is relative to what Alg. 3.1 assumed at learning. Light estimates are judged where the object was found. "
      "Every trial has its own object, "
      "clutter, place, noise (sigma 1 to 4 of 255) and blur (sigma 0 to 1 px); the tracker has no prior, but for the "
      "scenes in a "
      "row, which it takes for a film.",
      "False positives are counted at the shipped threshold of divergence and at the one that would keep 95 % of the "
      "hits.",
      "Plain is the dissertation's Alg. 3.2 with the same learned histograms and threshold, one window size, strides "
      "as ours."};
  return report;
}

}  // namespace cgsr::lab
