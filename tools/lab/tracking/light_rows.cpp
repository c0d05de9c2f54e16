// The light estimate of the relit variants beside the truth.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/lab/tracking/benchmark_rows.h"

namespace cgsr::lab {
namespace {

using Pairs = std::vector<LightPair> RelitScore::*;
using Results = std::vector<const TrackerResult*>;

/// The distinctiveness from which an object's light estimate counts: the median over the objects.
double median_distinctiveness(const Results& ours) {
  std::vector<double> values;
  for (const TrackerResult* result : ours) values.push_back(result->learned.distinctiveness.value_or(0.0));
  return quantile(values, 0.5);
}

/// Those that count.
Results distinctive(const Results& ours) {
  const double least = median_distinctiveness(ours);
  Results counted;
  for (const TrackerResult* result : ours) {
    if (!result->relit.empty() && result->learned.distinctiveness.value_or(0.0) >= least) counted.push_back(result);
  }
  return counted;
}

/// \param change  one kind of light; nothing: all of them.
void add_light_row(const std::string& row, const Results& counted, Pairs which, std::optional<LightChange> change,
                   Report& report) {
  std::vector<LightPair> pairs;
  for (const TrackerResult* result : counted) {
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

/// A gain relative to image 0 as a colour: grey where nothing changed.
color::Light shown(const Light& gain) {
  constexpr double kGrey = 0.7;
  const auto channel = [](double value) { return std::clamp(kGrey * value, 0.0, 1.0); };
  return {channel(gain.r), channel(gain.g), channel(gain.b)};
}

/// True and printed light over the sequence whose error is the median of all that count: neither the best nor the worst.
void add_stripe(const Results& counted, LightChange change, Report& report) {
  std::vector<std::pair<double, const TrackerResult*>> by_error;
  for (const TrackerResult* result : counted) {
    const auto found = result->relit.find(change);
    if (found == result->relit.end() || found->second.printed.empty()) continue;
    by_error.emplace_back(score_lights(found->second.printed).error, result);
  }
  if (by_error.empty()) return;
  const auto middle = by_error.begin() + static_cast<std::ptrdiff_t>(by_error.size() / 2);
  std::nth_element(by_error.begin(), middle, by_error.end());
  const RelitScore& score = middle->second->relit.at(change);
  Stripe stripe{fmt::format("Light of the object: {}, {} (error {:.3f} per channel, the median sequence)",
                            to_string(change), middle->second->sequence, middle->first),
                {{"true", {}}, {"printed", {}}, {"of the grid", {}}}};
  for (const LightPair& pair : score.printed) {
    stripe.bands[0].colors.emplace_back(shown(pair.truth));
    stripe.bands[1].colors.emplace_back(shown(pair.estimate));
  }
  for (const LightPair& pair : score.of_grid) stripe.bands[2].colors.emplace_back(shown(pair.estimate));
  report.stripes.push_back(std::move(stripe));
}

}  // namespace

void add_light_rows(const BenchmarkResults& results, Report& report) {
  const Results ours = results_of(results, "ours");
  const Results counted = distinctive(ours);
  if (counted.empty()) return;
  add_light_row("light estimate, printed", counted, &RelitScore::printed, {}, report);
  add_light_row("light estimate, of the grid", counted, &RelitScore::of_grid, {}, report);
  add_light_row("always answering .8", counted, &RelitScore::always_0_8, {}, report);
  add_light_row("always answering the true light of the image before", counted, &RelitScore::always_last, {}, report);
  for (const LightChange change : kLightChanges) {
    add_light_row(fmt::format("light estimate, {}", to_string(change)), counted, &RelitScore::printed, change, report);
    add_stripe(counted, change, report);
  }
  report.rows.push_back(share_row("light estimate, objects counted", "share", static_cast<int>(counted.size()),
                                  static_cast<int>(ours.size())));
  report.notes.push_back(
      fmt::format("Light estimates: objects whose distinctiveness is at least the median, {:.3f} nat; relative to "
                  "image 0, as the truth is; only images with an answer.",
                  median_distinctiveness(ours)));
}

}  // namespace cgsr::lab
