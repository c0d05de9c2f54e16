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
  add_light_rows(results, report);
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
