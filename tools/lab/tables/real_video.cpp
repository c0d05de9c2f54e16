// Figure 3.3 on video that can be measured by anyone: ours, the dissertation's plain mode, and other people's trackers.

#include <array>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/lab/counting.h"
#include "tools/lab/experiment.h"
#include "tools/lab/trackers.h"

namespace cgsr::lab {
namespace {

constexpr std::array<std::string_view, 5> kFolders{"tracking/coke", "tracking/dragonbaby", "tracking/deer",
                                                   "tracking/crossing", "people/human3"};
constexpr int kBlock = 10;          // images that are drawn together for the intervals: a third of a second
constexpr int kCountedImages = 21;  // the first is learned from; a peer costs a minute of counting per film

struct Figure {
  std::string_view name;
  double (*of)(const ImageScore&);
};
constexpr std::array kFigures{
    Figure{"precision", [](const ImageScore& s) { return s.precision; }},
    Figure{"recall", [](const ImageScore& s) { return s.recall; }},
    Figure{"IoU", [](const ImageScore& s) { return s.iou; }},
    Figure{"found", [](const ImageScore& s) { return s.found ? 1.0 : 0.0; }},
};

/// The scores of one tracker, film by film.
using Scores = std::vector<std::vector<ImageScore>>;

std::vector<double> values_of(const std::vector<ImageScore>& scores, const Figure& figure) {
  std::vector<double> values;
  values.reserve(scores.size());
  for (const ImageScore& score : scores) values.push_back(figure.of(score));
  return values;
}

/// Figures that are all the same teach a bootstrap nothing: no interval then.
std::optional<Interval> unless_degenerate(const Interval& interval) {
  return interval.low < interval.high ? std::optional(interval) : std::nullopt;
}

void add_film_rows(const std::string& row, const std::vector<ImageScore>& scores, std::uint64_t seed, Report& report) {
  for (const Figure& figure : kFigures) {
    const auto values = values_of(scores, figure);
    report.rows.push_back({row, std::string(figure.name), "", std::nullopt, mean(values),
                           unless_degenerate(bootstrap_mean(values, kBlock, seed)), static_cast<int>(values.size())});
  }
}

/// The mean over films, every film counting the same.
void add_mean_rows(const std::string& row, const Scores& films, std::uint64_t seed, Report& report) {
  for (const Figure& figure : kFigures) {
    std::vector<std::vector<double>> values;
    std::vector<double> means;
    int images = 0;
    for (const auto& film : films) {
      values.push_back(values_of(film, figure));
      means.push_back(mean(values.back()));
      images += static_cast<int>(film.size());
    }
    const std::vector<std::span<const double>> groups(values.begin(), values.end());
    report.rows.push_back({row, std::string(figure.name), "", std::nullopt, mean(means),
                           unless_degenerate(bootstrap_mean_of_means(groups, kBlock, seed)), images});
  }
}

Row cost_row(const std::string& row, const std::string& quantity, double minstr, int images) {
  return {row, quantity, "Minstr", std::nullopt, minstr, std::nullopt, images};
}

Result<Cost> count_tracker(const Setting& setting, std::string_view tracker, const std::filesystem::path& folder) {
  return count_follow(tracker, setting.config_file,
                      {"--input", folder.string(), "--images", std::to_string(kCountedImages)})
      .map([](const Counted& counted) { return counted.image; });
}

Plot precision_over_time(const Film& film, const std::vector<std::pair<std::string_view, Boxes>>& tracks) {
  Plot plot{fmt::format("{}: precision, mean over ten images", film.name), "image", "precision", {}};
  for (const auto& [name, boxes] : tracks) {
    Curve curve{std::string(name), {}};
    for (int start = 0; start + kBlock <= film.size(); start += kBlock) {
      std::vector<double> values;
      for (auto i = static_cast<std::size_t>(start); i < static_cast<std::size_t>(start + kBlock); ++i) {
        if (film.truth[i]) values.push_back(score_image(*film.truth[i], boxes[i]).precision);
      }
      if (!values.empty()) curve.points.push_back({start + 0.5 * kBlock, mean(values), std::nullopt});
    }
    plot.curves.push_back(std::move(curve));
  }
  return plot;
}

/// The mean over the films of one tracker's scores and cost.
void add_mean_of_films(std::string_view name, const Scores& scores, const std::vector<Cost>& costs,
                       const Setting& setting, Report& report) {
  const std::string row = fmt::format("mean / {}", name);
  add_mean_rows(row, scores, setting.seed, report);
  if (!setting.count) return;
  Cost all;
  for (const Cost& cost : costs) {
    all.mean_minstr += cost.mean_minstr / static_cast<double>(costs.size());
    all.worst_minstr = std::max(all.worst_minstr, cost.worst_minstr);
  }
  const int images = (kCountedImages - 1) * static_cast<int>(kFolders.size());
  report.rows.push_back(cost_row(row, "cost", all.mean_minstr, images));
  report.rows.push_back(cost_row(row, "worst cost", all.worst_minstr, images));
}

}  // namespace

Result<Report> real_video(const Setting& setting) {
  if (!setting.data) return fail("real-video needs the folder of recorded sequences: set CGSR_DATA or give --data");
  Report report{"real-video",
                "precision (Eq. 3.2), recall, IoU and cost on recorded sequences, learned from the first image alone",
                "",
                setting.seed,
                {},
                {},
                {}};
  std::map<std::string_view, Scores> scores;
  std::map<std::string_view, std::vector<Cost>> costs;
  for (std::string_view folder : kFolders) {
    const auto film = open_film(*setting.data / folder);
    if (!film) return tl::unexpected(film.error());
    std::vector<std::pair<std::string_view, Boxes>> tracks;
    for (const NamedTracker& named : trackers()) {
      const std::string row = fmt::format("{} / {}", film->name, named.name);
      setting.progress(row);
      const auto tracker = named.make(setting.configuration);
      auto boxes = follow(*tracker, *film, film->size(), *film);
      if (!boxes) return tl::unexpected(boxes.error());
      scores[named.name].push_back(score_images(*boxes, film->truth));
      add_film_rows(row, scores[named.name].back(), setting.seed, report);
      tracks.emplace_back(named.name, std::move(*boxes));
      if (!setting.count) continue;
      setting.progress(row + ", counting");
      const auto cost = count_tracker(setting, named.name, *setting.data / folder);
      if (!cost) return tl::unexpected(cost.error());
      costs[named.name].push_back(*cost);
      report.rows.push_back(cost_row(row, "cost", cost->mean_minstr, kCountedImages - 1));
      report.rows.push_back(cost_row(row, "worst cost", cost->worst_minstr, kCountedImages - 1));
    }
    report.plots.push_back(precision_over_time(*film, tracks));
  }
  for (const NamedTracker& named : trackers())
    add_mean_of_films(named.name, scores[named.name], costs[named.name], setting, report);
  report.notes = {
      "The dissertation's Figure 3.3 is a curve over a film that is not public; it gives no table, so its column is "
      "empty.",
      fmt::format(
          "Intervals: bootstrap over blocks of {} images; image 0, which is learned from, is scored like any other.",
          kBlock),
      "Peers see the decoded colour picture, ours the same picture as YUYV. KCF has been trained on image 0 by its "
      "first update; neither KCF "
      "nor CSRT has a threshold that lets it give up.",
      fmt::format("Minstr: instructions per tracked image, the first {} of each film, SSE2 baseline (tools/count); "
                  "decoding is not in it.",
                  kCountedImages - 1)};
  return report;
}

}  // namespace cgsr::lab
