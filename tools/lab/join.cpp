#include "tools/lab/join.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace cgsr::lab {
namespace {

constexpr std::size_t kMinRunsForInterval = 3;

/// A row's figures of its runs, for kWeighted: a row that no other was joined to is one run.
void spread_out(Row& row) {
  if (!row.samples.empty() || !row.ours) return;
  row.samples = {*row.ours};
  row.weights = {static_cast<double>(row.trials)};
}

Row weighted(Row a, Row b, std::uint64_t seed) {
  spread_out(a);
  spread_out(b);
  a.samples.insert(a.samples.end(), b.samples.begin(), b.samples.end());
  a.weights.insert(a.weights.end(), b.weights.begin(), b.weights.end());
  double sum = 0.0;
  double weight = 0.0;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    sum += a.weights[i] * a.samples[i];
    weight += a.weights[i];
  }
  if (weight > 0.0) a.ours = sum / weight;
  a.interval = std::nullopt;
  if (a.samples.size() >= kMinRunsForInterval) a.interval = bootstrap_mean(a.samples, 1, seed);
  a.trials += b.trials;
  return a;
}

Row of_shares(const Row& a, const Row& b) {
  const auto successes = [](const Row& row) {
    return static_cast<int>(std::lround(row.ours.value_or(0.0) * row.trials));
  };
  return share_row(a.row, a.quantity, successes(a) + successes(b), a.trials + b.trials);
}

Row of_samples(const Row& a, const Row& b, std::uint64_t seed) {
  std::vector<double> samples = a.samples;
  samples.insert(samples.end(), b.samples.begin(), b.samples.end());
  return sampled_row(a.row, a.quantity, a.unit, std::move(samples), a.join, seed);
}

Row extreme(Row a, const Row& b) {
  if (a.ours && b.ours) a.ours = a.join == Join::kMax ? std::max(*a.ours, *b.ours) : std::min(*a.ours, *b.ours);
  if (!a.ours) a.ours = b.ours;
  a.trials += b.trials;
  return a;
}

Row joined(const Row& a, const Row& b, std::uint64_t seed) {
  Row row;
  switch (b.join) {
    case Join::kWeighted:
      row = weighted(a, b, seed);
      break;
    case Join::kShare:
      row = of_shares(a, b);
      break;
    case Join::kMax:
    case Join::kMin:
      row = extreme(a, b);
      break;
    case Join::kMean:
    case Join::kMedian:
    case Join::kP95:
    case Join::kPaired:
    case Join::kPairedP:
      row = of_samples(a, b, seed);
      break;
  }
  row.dissertation = b.dissertation;
  row.requirement = b.requirement;
  return row;
}

}  // namespace

Result<Report> joined(const Report& earlier, const Report& later) {
  if (earlier.name != later.name) return fail(fmt::format("{} and {} are two tables", earlier.name, later.name));
  if (earlier.config_sha256 != later.config_sha256) {
    return fail(fmt::format("{} was measured with another configuration", earlier.name));
  }
  if (earlier.sources_sha256 != later.sources_sha256) {
    return fail(fmt::format("{} was measured with other sources", earlier.name));
  }
  for (const Run& run : later.runs) {
    if (std::ranges::find(earlier.runs, run.seed, &Run::seed) != earlier.runs.end()) {
      return fail(fmt::format("{}: the trials of seed {} are in it already", earlier.name, run.seed));
    }
  }
  Report report = later;
  report.runs = earlier.runs;
  report.repetition = earlier.repetition;
  report.runs.insert(report.runs.end(), later.runs.begin(), later.runs.end());
  report.rows = earlier.rows;
  for (const Row& row : later.rows) {
    const auto same = [&](const Row& other) { return other.row == row.row && other.quantity == row.quantity; };
    const auto at = std::ranges::find_if(report.rows, same);
    if (at == report.rows.end()) {
      report.rows.push_back(row);
    } else {
      *at = joined(*at, row, later.seed);
    }
  }
  return report;
}

}  // namespace cgsr::lab
