// Chapter 3 on recorded sequences, as they are, relit, and with the object painted over, beside other people's trackers.

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/lab/experiment.h"
#include "tools/lab/trackers.h"
#include "tools/lab/tracking/benchmark_page.h"
#include "tools/lab/tracking/benchmark_rows.h"
#include "tools/lab/tracking/cost.h"
#include "tools/lab/tracking/robustness.h"
#include "tools/lab/tracking/sequences.h"

namespace cgsr::lab {
namespace {

namespace fs = std::filesystem;

constexpr int kTemporalStarts = 20;
constexpr double kRightIou = 0.5;  // of a claim, for its confidence

Result<std::vector<Sequence>> chosen_sequences(const Setting& setting) {
  std::vector<fs::path> folders(setting.tracking.sequences.begin(), setting.tracking.sequences.end());
  if (folders.empty()) {
    if (!setting.data) {
      return fail(
          "tracking-benchmark needs recorded sequences: give --sequences FOLDER, or set CGSR_DATA or give --data");
    }
    folders = {*setting.data / "tracking", *setting.data / "people/human3"};
  }
  auto sequences = find_sequences(folders);
  if (!sequences || setting.tracking.only.empty()) return sequences;
  std::vector<Sequence> chosen;
  for (const std::string& name : setting.tracking.only) {
    const auto found = std::ranges::find(*sequences, name, &Sequence::name);
    if (found == sequences->end()) return fail(fmt::format("--only {}: there is no such sequence", name));
    chosen.push_back(*found);
  }
  return chosen;
}

/// Every so-many-th of the starts.
std::vector<RunStart> thinned(const std::vector<RunStart>& starts, int every) {
  std::vector<RunStart> kept;
  for (std::size_t i = 0; i < starts.size(); i += static_cast<std::size_t>(every)) kept.push_back(starts[i]);
  return kept;
}

/// A kind of changing light over a film, constant light of the same mean, and the truth of it.
struct RelitFilms {
  LightChange change;
  HashedFilm changing, constant;
  std::vector<std::optional<Light>> truth;
};

/// \return the images of a film made once, so that every tracker has them.
Result<HashedFilm> in_memory(const Film& film) {
  std::vector<Image> images;
  for (int i = 0; i < film.size(); ++i) {
    auto image = film.image(i);
    if (!image) return tl::unexpected(image.error());
    images.push_back(std::move(*image));
  }
  return hashed(film_of_images(film.name, std::move(images), film.truth));
}

Result<RelitFilms> relit_films(const Film& film, LightChange change, std::uint64_t seed) {
  const auto first = film.image(0);
  if (!first) return tl::unexpected(first.error());
  const cv::Size size = first->bgr.size();
  const auto course = LightCourse::changing(change, film.size(), size, seed);
  const auto constant = LightCourse::constant(mean_gain_of_object(film, course, size), film.size());
  auto changing_film = in_memory(relit(film, course));
  if (!changing_film) return tl::unexpected(changing_film.error());
  auto constant_film = in_memory(relit(film, constant));
  if (!constant_film) return tl::unexpected(constant_film.error());
  return RelitFilms{change, std::move(*changing_film), std::move(*constant_film), true_lights(film, course, size)};
}

/// Measures all trackers on one sequence, part after part, so that the images of one variant are in memory at a time.
class SequenceMeasurement {
 public:
  SequenceMeasurement(const Setting& setting, HashedFilm film)
      : setting_(setting),
        film_(std::move(film)),
        cache_(setting.tracking.cache.empty() ? run_cache_folder() : fs::path(setting.tracking.cache)) {
    for (const NamedTracker& named : trackers()) {
      if (!setting.tracking.runs(named.name)) continue;
      named_.push_back(&named);
      results_.push_back({});
      results_.back().sequence = film_.film.name;
      results_.back().tracker = named.name;
    }
  }

  Result<void> measure() {
    auto done = one_pass();
    if (done && wants(BenchmarkPart::kSpatial)) done = spatial();
    if (done && wants(BenchmarkPart::kTemporal)) done = temporal();
    if (done && wants(BenchmarkPart::kHalfPixel)) done = half_pixel();
    if (done && wants(BenchmarkPart::kRelit)) done = relit_part();
    if (done && wants(BenchmarkPart::kAbsent)) done = absent();
    return done;
  }

  BenchmarkResults& results() { return results_; }

  [[nodiscard]] Result<SequencePictures> write_films(const fs::path& folder) const {
    return write_pictures(film_.film, tracks_, results_.front().one_pass->losses, folder);
  }

 private:
  [[nodiscard]] bool wants(BenchmarkPart part) const { return setting_.tracking.has(part); }

  [[nodiscard]] Runner runner(const NamedTracker& named, std::string_view part) const {
    return [this, &named, part](const HashedFilm& film, const RunStart& start) {
      setting_.progress(fmt::format("{} / {}, {}", film_.film.name, named.name, part));
      return run_or_recall(named, setting_.configuration, film, start, cache_);
    };
  }

  /// Does one thing for each tracker and keeps what it gives where `set` says.
  template <class Measure, class Keep>
  Result<void> for_each(std::string_view part, const Measure& measure, const Keep& keep) {
    for (std::size_t i = 0; i < named_.size(); ++i) {
      auto measured = measure(runner(*named_[i], part), results_[i]);
      if (!measured) return tl::unexpected(measured.error());
      keep(results_[i], std::move(*measured));
    }
    return {};
  }

  Result<void> one_pass() {
    return for_each(
        "one pass",
        [&](const Runner& run, const TrackerResult&) {
          return run(film_, {0, *film_.film.truth.front()});
        },
        [&](TrackerResult& result, const TrackedRun& run) {
          result.one_pass = score_run(run.boxes(), film_.film.truth);
          result.learned = run.learned;
          result.refused = run.refused;
          result.claims = claims_of(run, film_.film.truth, kRightIou);
          tracks_.push_back({result.tracker, run.boxes()});
        });
  }

  Result<void> spatial() {
    const auto first = film_.film.image(0);
    if (!first) return tl::unexpected(first.error());
    const auto starts = thinned(spatial_starts(*film_.film.truth.front(), first->bgr.size()), setting_.tracking.every);
    return for_each(
        "spatial robustness",
        [&](const Runner& run, const TrackerResult&) { return score_of_starts(run, film_, starts); },
        [](TrackerResult& result, const RunScore& score) { result.spatial = score; });
  }

  Result<void> temporal() {
    const auto starts = thinned(temporal_starts(film_.film.truth, kTemporalStarts), setting_.tracking.every);
    return for_each(
        "temporal robustness",
        [&](const Runner& run, const TrackerResult&) { return score_of_starts(run, film_, starts); },
        [](TrackerResult& result, const RunScore& score) { result.temporal = score; });
  }

  /// Of ours alone: peers round boxes to whole pixels.
  Result<void> half_pixel() {
    for (std::size_t i = 0; i < named_.size(); ++i) {
      if (named_[i]->name != "ours") continue;
      const auto change = half_pixel_change(runner(*named_[i], "half a pixel"), film_, results_[i].one_pass->boxes.iou);
      if (!change) return tl::unexpected(change.error());
      results_[i].half_pixel_change = *change;
    }
    return {};
  }

  Result<void> relit_part() {
    for (const LightChange change : kLightChanges) {
      const auto films = relit_films(film_.film, change, setting_.tracking.light_seed);
      if (!films) return tl::unexpected(films.error());
      auto done = for_each(
          fmt::format("relit, {}", to_string(change)),
          [&](const Runner& run, const TrackerResult&) {
            return score_relit(run, films->changing, films->constant, films->truth);
          },
          [&](TrackerResult& result, RelitScore score) { result.relit.emplace(change, std::move(score)); });
      if (!done) return done;
    }
    return {};
  }

  Result<void> absent() {
    const AbsentRange range = absent_range(film_.film.truth);
    if (range.count == 0) return {};
    setting_.progress(fmt::format("{}, painting over", film_.film.name));
    const fs::path kept = fs::path(setting_.tracking.output) / "absent" / film_.film.name;
    const auto painted = film_without_object(film_.film, range, kept / film_.sha256.substr(0, 16));
    if (!painted) return tl::unexpected(painted.error());
    const auto film = in_memory(part_of(*painted, 0, range.end() + kAgainWithinImages));
    if (!film) return tl::unexpected(film.error());
    return for_each(
        "object absent",
        [&](const Runner& run, const TrackerResult&) { return score_absent(run, *film, range, film_.film.truth); },
        [](TrackerResult& result, const AbsentScore& score) { result.absent = score; });
  }

  const Setting& setting_;
  HashedFilm film_;
  RunCache cache_;
  std::vector<const NamedTracker*> named_;
  BenchmarkResults results_;
  std::vector<NamedTrack> tracks_;
};

void add_notes(const Setting& setting, std::size_t sequences, Report& report) {
  report.notes.push_back(fmt::format(
      "{} sequences; intervals: bootstrap over sequences; differences: Student's t-test of pairs.", sequences));
  report.notes.push_back(
      fmt::format("AUC: mean of the success curve at IoU 0, .05 .. 1. Lost: IoU below {} or not found; found again: "
                  "IoU {} or more. False "
                  "claims: the share of claims whose IoU is below {}, or where the object is not visible.",
                  kOffIou, kAgainIou, kOffIou));
  report.notes.push_back(
      fmt::format("Relit in linear light with seed {}; constant light has the mean gain of the changing one. Object "
                  "absent: up to {} "
                  "images painted over, after at least ten that are not.",
                  setting.tracking.light_seed, kAbsentImages));
  report.notes.push_back(fmt::format("A claim is right from IoU {} on. Peers have no confidence.", kRightIou));
  if (setting.tracking.every > 1) {
    report.notes.push_back(fmt::format("Robustness: one in {} starts alone.", setting.tracking.every));
  }
}

Result<void> add_choices(const Setting& setting, const BenchmarkResults& results, const Folds& folds, Report& report) {
  const Figures now = figures_of(results);
  if (!setting.tracking.against.empty()) {
    const auto earlier = read_figures(setting.tracking.against);
    if (!earlier) return tl::unexpected(earlier.error());
    add_choice_rows(*earlier, now, folds, setting.seed, report);
  }
  return write_figures(now, fs::path(setting.tracking.output) / "figures.json");
}

}  // namespace

Result<Report> tracking_benchmark(const Setting& setting) {
  const auto sequences = chosen_sequences(setting);
  if (!sequences) return tl::unexpected(sequences.error());
  const auto folds = Folds::shipped();
  if (!folds) return tl::unexpected(folds.error());
  Report report{"tracking-benchmark",
                "one pass, robustness, changing light and an absent object on recorded sequences",
                "",
                setting.seed,
                {},
                {},
                {}};
  const fs::path output = setting.tracking.output;
  std::error_code ignored;
  fs::create_directories(output, ignored);
  BenchmarkResults results;
  std::vector<SequencePictures> pictures;
  for (const Sequence& sequence : *sequences) {
    setting.progress(sequence.name);
    auto film = read_sequence(sequence, setting.tracking.images).and_then(hashed);
    if (!film) return tl::unexpected(film.error());
    SequenceMeasurement measurement(setting, std::move(*film));
    if (auto done = measurement.measure(); !done) return tl::unexpected(done.error());
    if (!setting.tracking.no_films && !measurement.results().empty()) {
      auto written = measurement.write_films(output);
      if (!written) return tl::unexpected(written.error());
      pictures.push_back(std::move(*written));
    }
    std::ranges::move(measurement.results(), std::back_inserter(results));
  }
  add_score_rows(results, *folds, setting.seed, report);
  add_relit_rows(results, setting.seed, report);
  add_absent_rows(results, report);
  add_curves(results, report);
  add_confidence_rows(results, *folds, report);
  if (setting.tracking.has(BenchmarkPart::kCost) && setting.count) {
    if (auto counted = add_cost_rows(setting, report); !counted) return tl::unexpected(counted.error());
  }
  add_notes(setting, sequences->size(), report);
  if (auto chosen = add_choices(setting, results, *folds, report); !chosen) return tl::unexpected(chosen.error());
  if (auto written = write_benchmark_page(report, pictures, output); !written) return tl::unexpected(written.error());
  return report;
}

}  // namespace cgsr::lab
