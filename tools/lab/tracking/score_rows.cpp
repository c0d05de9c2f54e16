// One pass and robustness.

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string>

#include <fmt/format.h>

#include "tools/lab/trackers.h"
#include "tools/lab/tracking/benchmark_rows.h"

namespace cgsr::lab {
namespace {

using PartScore = std::optional<RunScore> TrackerResult::*;
struct NamedPart {
  std::string_view name;
  PartScore score;
};
constexpr std::array kParts{NamedPart{"one pass", &TrackerResult::one_pass},
                            NamedPart{"spatial robustness", &TrackerResult::spatial},
                            NamedPart{"temporal robustness", &TrackerResult::temporal}};

struct Quantity {
  std::string_view name;
  double (*of)(const RunScore&);
};
constexpr std::array kQuantities{
    Quantity{"AUC", [](const RunScore& s) { return s.auc; }},
    Quantity{"precision at 20 px", [](const RunScore& s) { return s.precision_20px; }},
    Quantity{"precision", [](const RunScore& s) { return s.boxes.precision; }},
    Quantity{"recall", [](const RunScore& s) { return s.boxes.recall; }},
    Quantity{"IoU", [](const RunScore& s) { return s.boxes.iou; }},
    Quantity{"found", [](const RunScore& s) { return s.boxes.found; }},
};

std::vector<double> values_of(const std::vector<const TrackerResult*>& results, PartScore part,
                              const Quantity& quantity) {
  std::vector<double> values;
  for (const TrackerResult* result : results) {
    if (result->*part) values.push_back(quantity.of(*(result->*part)));
  }
  return values;
}

/// Losses, wrong claims and how long it takes to find the object again, over all sequences.
void add_loss_rows(const std::string& row, const std::vector<const TrackerResult*>& results, PartScore part,
                   std::uint64_t seed, Report& report) {
  int losses = 0, never = 0, claims = 0, false_claims = 0;
  std::vector<double> recoveries;
  for (const TrackerResult* result : results) {
    if (!(result->*part)) continue;
    const RunScore& score = *(result->*part);
    losses += static_cast<int>(score.losses.size());
    never += static_cast<int>(score.losses.size() - score.recoveries.size());
    claims += score.claims;
    false_claims += score.false_claims;
    recoveries.insert(recoveries.end(), score.recoveries.begin(), score.recoveries.end());
  }
  report.rows.push_back(plain_row(row, "losses", "", losses, results.size()));
  report.rows.push_back(plain_row(row, "not found again", "", never, results.size()));
  report.rows.push_back(share_row(row, "false claims", false_claims, claims));
  report.rows.push_back(sampled_row(row, "found again after", "images", recoveries, Join::kMedian, seed));
}

void add_difference_rows(const BenchmarkResults& results, const NamedPart& part, std::uint64_t seed, Report& report) {
  const auto ours = results_of(results, "ours"), csrt = results_of(results, "CSRT");
  if (ours.empty() || ours.size() != csrt.size()) return;
  for (const Quantity& quantity : kQuantities) {
    auto differences = values_of(ours, part.score, quantity);
    const auto theirs = values_of(csrt, part.score, quantity);
    if (differences.empty() || differences.size() != theirs.size()) continue;
    for (std::size_t i = 0; i < theirs.size(); ++i) differences[i] -= theirs[i];
    report.rows.push_back(sampled_row(fmt::format("{} / ours minus CSRT", part.name), std::string(quantity.name), "",
                                      differences, Join::kPaired, seed));
  }
}

/// How ours stands beside the better of KCF and CSRT, sequence by sequence, in one-pass AUC.
void add_worst_rows(const BenchmarkResults& results, Report& report) {
  const auto ours = results_of(results, "ours"), csrt = results_of(results, "CSRT"), kcf = results_of(results, "KCF");
  if (ours.empty() || csrt.size() != ours.size() || kcf.size() != ours.size()) return;
  int below_three_quarters = 0, below_half = 0;
  double worst = 1e9;
  std::string names;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (!ours[i]->one_pass || !csrt[i]->one_pass || !kcf[i]->one_pass) return;
    const double better = std::max(csrt[i]->one_pass->auc, kcf[i]->one_pass->auc);
    const double share = better > 0.0 ? ours[i]->one_pass->auc / better : 1.0;
    worst = std::min(worst, share);
    below_half += share < 0.5;
    if (share >= 0.75) continue;
    ++below_three_quarters;
    names += fmt::format("{}{} {:.2f}", names.empty() ? "" : ", ", ours[i]->sequence, share);
  }
  const std::string row = "one pass, ours over the better of KCF and CSRT";
  report.rows.push_back(plain_row(row, "sequences below .75", "", below_three_quarters, ours.size()));
  report.rows.push_back(plain_row(row, "sequences below .5", "", below_half, ours.size()));
  report.rows.push_back(plain_row(row, "worst", "", worst, ours.size(), Join::kMin));
  if (!names.empty()) report.notes.push_back("Below .75 of the better of KCF and CSRT: " + names + ".");
}

void add_fold_rows(const BenchmarkResults& results, const Folds& folds, Report& report) {
  for (const NamedTracker& named : trackers()) {
    std::map<int, std::vector<double>> of_fold;
    for (const TrackerResult* result : results_of(results, named.name)) {
      if (result->one_pass) of_fold[folds.of(result->sequence)].push_back(result->one_pass->auc);
    }
    for (const auto& [fold, values] : of_fold) {
      report.rows.push_back(
          plain_row(fmt::format("fold {} / {}", fold, named.name), "AUC", "", mean(values), values.size()));
    }
  }
}

void add_sequence_rows(const BenchmarkResults& results, Report& report) {
  for (const TrackerResult& result : results) {
    const std::string row = fmt::format("{} / {}", result.sequence, result.tracker);
    if (!result.refused.empty()) report.notes.push_back(fmt::format("{}: {}", row, result.refused));
    if (!result.one_pass) continue;
    const RunScore& score = *result.one_pass;
    for (const Quantity& quantity : kQuantities) {
      report.rows.push_back(plain_row(row, std::string(quantity.name), "", quantity.of(score),
                                      static_cast<std::size_t>(score.boxes.images)));
    }
    report.rows.push_back(plain_row(row, "losses", "", static_cast<double>(score.losses.size()), 1));
    if (score.claims > 0) report.rows.push_back(share_row(row, "false claims", score.false_claims, score.claims));
    if (result.half_pixel_change) {
      report.rows.push_back(plain_row(row, "change by half a pixel", "", *result.half_pixel_change, 4, Join::kMax));
    }
  }
}

void add_half_pixel_rows(const BenchmarkResults& results, std::uint64_t seed, Report& report) {
  std::vector<double> changes;
  for (const TrackerResult* result : results_of(results, "ours")) {
    if (result->half_pixel_change) changes.push_back(*result->half_pixel_change);
  }
  if (changes.empty()) return;
  const std::string row = "first box moved by half a pixel / ours";
  report.rows.push_back(
      plain_row(row, "largest change of IoU", "", std::ranges::max(changes), changes.size(), Join::kMax));
  report.rows.push_back(mean_row(row, "mean change of IoU", "", changes, seed));
  const auto above = std::ranges::count_if(changes, [](double change) { return change > 0.05; });
  report.rows.push_back(plain_row(row, "sequences above .05", "", static_cast<double>(above), changes.size()));
}

}  // namespace

std::vector<const TrackerResult*> results_of(const BenchmarkResults& results, std::string_view tracker) {
  std::vector<const TrackerResult*> of_it;
  for (const TrackerResult& result : results) {
    if (result.tracker == tracker) of_it.push_back(&result);
  }
  return of_it;
}

void add_score_rows(const BenchmarkResults& results, const Folds& folds, std::uint64_t seed, Report& report) {
  for (const NamedPart& part : kParts) {
    for (const NamedTracker& named : trackers()) {
      const auto of_it = results_of(results, named.name);
      const std::string row = fmt::format("{} / {}", part.name, named.name);
      if (values_of(of_it, part.score, kQuantities.front()).empty()) continue;
      for (const Quantity& quantity : kQuantities) {
        report.rows.push_back(
            mean_row(row, std::string(quantity.name), "", values_of(of_it, part.score, quantity), seed));
      }
      add_loss_rows(row, of_it, part.score, seed, report);
    }
    add_difference_rows(results, part, seed, report);
  }
  add_worst_rows(results, report);
  add_half_pixel_rows(results, seed, report);
  add_fold_rows(results, folds, report);
  add_sequence_rows(results, report);
}

void add_curves(const BenchmarkResults& results, Report& report) {
  for (const NamedPart& part : kParts) {
    Plot success{fmt::format("{}: success", part.name), "IoU", "share of images", {}};
    Plot precision{fmt::format("{}: precision", part.name), "distance of centres [px]", "share of images", {}};
    for (const NamedTracker& named : trackers()) {
      std::vector<RunScore> scores;
      for (const TrackerResult* result : results_of(results, named.name)) {
        if (result->*part.score) scores.push_back(*(result->*part.score));
      }
      if (scores.empty()) continue;
      const RunScore all = mean_score(scores);
      Curve by_iou{fmt::format("{} {:.3f}", named.name, all.auc), {}};
      Curve by_distance{fmt::format("{} {:.3f}", named.name, all.precision_20px), {}};
      for (std::size_t t = 0; t < all.success.size(); ++t) {
        by_iou.points.push_back({static_cast<double>(t) / (kSuccessThresholds - 1), all.success[t], {}});
      }
      for (std::size_t t = 0; t < all.precision.size(); ++t) {
        by_distance.points.push_back({static_cast<double>(t), all.precision[t], {}});
      }
      success.curves.push_back(std::move(by_iou));
      precision.curves.push_back(std::move(by_distance));
    }
    if (success.curves.empty()) continue;
    report.plots.push_back(std::move(success));
    report.plots.push_back(std::move(precision));
  }
}

Figures figures_of(const BenchmarkResults& results) {
  Figures figures;
  for (const TrackerResult* result : results_of(results, "ours")) {
    for (const NamedPart& part : kParts) {
      if (!(result->*part.score)) continue;
      figures[fmt::format("{}, AUC", part.name)][result->sequence] = (result->*part.score)->auc;
      figures[fmt::format("{}, precision", part.name)][result->sequence] = (result->*part.score)->boxes.precision;
    }
    for (const auto& [change, score] : result->relit) {
      figures[fmt::format("relit, {}, IoU", to_string(change))][result->sequence] = score.iou;
    }
    if (result->half_pixel_change) {
      figures["half pixel, IoU kept"][result->sequence] = 1.0 - *result->half_pixel_change;
    }
    if (result->absent && result->absent->images > 0) {
      figures["absent, no false claims"][result->sequence] =
          1.0 - static_cast<double>(result->absent->false_claims) / result->absent->images;
      figures["absent, found again"][result->sequence] = result->absent->again_after ? 1.0 : 0.0;
    }
  }
  return figures;
}

}  // namespace cgsr::lab
