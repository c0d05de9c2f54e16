// Relit variants, the object absent, and confidence.

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "tools/lab/trackers.h"
#include "tools/lab/tracking/benchmark_rows.h"

namespace cgsr::lab {
namespace {

void add_relit_row(const std::vector<const TrackerResult*>& results, LightChange change, std::string_view tracker,
                   std::uint64_t seed, Report& report) {
  std::vector<double> changing, constant, losses;
  for (const TrackerResult* result : results) {
    const auto score = result->relit.find(change);
    if (score == result->relit.end()) continue;
    changing.push_back(score->second.iou);
    constant.push_back(score->second.constant_iou);
    losses.push_back(score->second.constant_iou - score->second.iou);
  }
  if (changing.empty()) return;
  const std::string row = fmt::format("relit, {} / {}", to_string(change), tracker);
  report.rows.push_back(mean_row(row, "IoU", "", changing, seed));
  report.rows.push_back(mean_row(row, "IoU, constant light", "", constant, seed));
  report.rows.push_back(sampled_row(row, "lost IoU", "", losses, Join::kPaired, seed));
}

using Pairs = std::vector<LightPair> RelitScore::*;

/// The distinctiveness from which an object's light estimate counts: the median over the objects.
double median_distinctiveness(const std::vector<const TrackerResult*>& ours) {
  std::vector<double> values;
  for (const TrackerResult* result : ours) values.push_back(result->learned.distinctiveness.value_or(0.0));
  return quantile(values, 0.5);
}

/// \param change  one kind of light; nothing: all of them.
void add_light_row(const std::string& row, const std::vector<const TrackerResult*>& ours, Pairs which,
                   std::optional<LightChange> change, Report& report) {
  const double least = median_distinctiveness(ours);
  std::vector<LightPair> pairs;
  for (const TrackerResult* result : ours) {
    if (result->learned.distinctiveness.value_or(0.0) < least) continue;
    for (const auto& [kind, score] : result->relit) {
      if (change && kind != *change) continue;
      pairs.insert(pairs.end(), (score.*which).begin(), (score.*which).end());
    }
  }
  const LightScore score = score_lights(pairs);
  if (score.images == 0) return;
  const auto images = static_cast<std::size_t>(score.images);
  report.rows.push_back(plain_row(row, "error per channel", "", score.error, images));
  if (change != LightChange::kDimming) {  // which keeps its chroma
    report.rows.push_back(plain_row(row, "chroma correlation", "", score.chroma_correlation, images));
  }
}

void add_light_rows(const std::vector<const TrackerResult*>& ours, Report& report) {
  const double least = median_distinctiveness(ours);
  const auto counted = std::ranges::count_if(ours, [&](const TrackerResult* result) {
    return !result->relit.empty() && result->learned.distinctiveness.value_or(0.0) >= least;
  });
  if (counted == 0) return;
  add_light_row("light estimate, not bound to the grid", ours, &RelitScore::exact, {}, report);
  add_light_row("light estimate, of the grid", ours, &RelitScore::printed, {}, report);
  add_light_row("always answering .8", ours, &RelitScore::always_0_8, {}, report);
  add_light_row("always answering the true light of the image before", ours, &RelitScore::always_last, {}, report);
  for (const LightChange change : kLightChanges) {
    add_light_row(fmt::format("light estimate, {}", to_string(change)), ours, &RelitScore::exact, change, report);
  }
  report.rows.push_back(
      share_row("light estimate, objects counted", "share", static_cast<int>(counted), static_cast<int>(ours.size())));
  report.notes.push_back(
      fmt::format("Light estimates: objects whose distinctiveness is at least the median, {:.3f} nat; relative to "
                  "image 0, as the truth "
                  "is; only images with an answer.",
                  least));
}

void add_absent_row(const std::string& row, const std::vector<const TrackerResult*>& results, bool was_on_it_only,
                    Report& report) {
  int images = 0, false_claims = 0, before = 0, claims_before = 0, again = 0, sequences = 0;
  for (const TrackerResult* result : results) {
    if (!result->absent || (was_on_it_only && !result->absent->was_on_it)) continue;
    const AbsentScore& score = *result->absent;
    images += score.images;
    false_claims += score.false_claims;
    before += score.images_before;
    claims_before += score.claims_before;
    again += score.again_after.has_value();
    ++sequences;
  }
  if (sequences == 0) return;
  report.rows.push_back(share_row(row, "false claims", false_claims, images));
  report.rows.push_back(
      share_row(row, fmt::format("found again within {} images", kAgainWithinImages), again, sequences));
  report.rows.push_back(share_row(row, "claims while present", claims_before, before));
}

Plot reliability_diagram(const Calibration& all) {
  Plot plot{"Reliability of 'found' (one pass)", "confidence", "share of right claims", {}};
  Curve ours{"ours", {}};
  for (const ReliabilityBin& bin : all.bins) {
    if (bin.claims == 0) continue;
    const int right = static_cast<int>(bin.right * bin.claims + 0.5);
    ours.points.push_back({bin.mean_confidence, bin.right, wilson(right, bin.claims)});
  }
  plot.curves.push_back(std::move(ours));
  plot.curves.push_back({"ideal", {{0.0, 0.0, {}}, {1.0, 1.0, {}}}});
  return plot;
}

}  // namespace

void add_relit_rows(const BenchmarkResults& results, std::uint64_t seed, Report& report) {
  for (const LightChange change : kLightChanges) {
    for (const NamedTracker& named : trackers()) {
      add_relit_row(results_of(results, named.name), change, named.name, seed, report);
    }
  }
  add_light_rows(results_of(results, "ours"), report);
}

void add_absent_rows(const BenchmarkResults& results, Report& report) {
  for (const NamedTracker& named : trackers()) {
    const auto of_it = results_of(results, named.name);
    add_absent_row(fmt::format("object absent / {}", named.name), of_it, false, report);
    add_absent_row(fmt::format("object absent, on it before / {}", named.name), of_it, true, report);
  }
}

void add_confidence_rows(const BenchmarkResults& results, const Folds& folds, Report& report) {
  std::vector<Claim> all;
  std::array<std::vector<Claim>, kFolds> of_fold;
  for (const TrackerResult* result : results_of(results, "ours")) {
    auto& fold = of_fold[static_cast<std::size_t>(folds.of(result->sequence) - 1)];
    fold.insert(fold.end(), result->claims.begin(), result->claims.end());
    all.insert(all.end(), result->claims.begin(), result->claims.end());
  }
  if (all.empty()) return;
  const Calibration calibration = calibration_of(all);
  const auto add = [&](const std::string& row, const Calibration& one) {
    report.rows.push_back(plain_row(row, "calibration error", "", one.error, static_cast<std::size_t>(one.claims)));
  };
  add("confidence, all folds", calibration);
  for (std::size_t i = 0; i < kFolds; ++i) {
    if (!of_fold[i].empty()) add(fmt::format("confidence, fold {}", i + 1), calibration_of(of_fold[i]));
  }
  report.plots.push_back(reliability_diagram(calibration));
}

}  // namespace cgsr::lab
