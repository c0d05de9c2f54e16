#include "tools/lab/repeat.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace cgsr::lab {
namespace {

bool has_a_sample_per_trial(const Row& row) {
  return row.join != Join::kWeighted && !row.samples.empty();
}

std::string words(const Row& row) {
  return fmt::format("'{}: {}'", row.row, row.quantity);
}

/// \return how many samples are the same; or the first that is not.
Result<std::size_t> compare_samples(const Row& before, const Row& now, bool whole) {
  if (now.samples.empty() || (whole && now.samples.size() != before.samples.size())) {
    return fail(fmt::format("{} has {} samples now, {} before", words(now), now.samples.size(), before.samples.size()));
  }
  for (std::size_t i = 0; i < now.samples.size(); ++i) {
    if (i >= before.samples.size()) {
      return fail(
          fmt::format("{} has {} samples now, {} before", words(now), now.samples.size(), before.samples.size()));
    }
    if (stored_digits(now.samples[i]) != stored_digits(before.samples[i])) {
      return fail(
          fmt::format("{}, sample {}: {:g} now, {:g} before", words(now), i, now.samples[i], before.samples[i]));
    }
  }
  return now.samples.size();
}

Result<std::size_t> compare_figures(const Row& before, const Row& now) {
  const bool same = before.ours.has_value() == now.ours.has_value() && before.trials == now.trials &&
                    (!now.ours || stored_digits(*now.ours) == stored_digits(*before.ours));
  if (same) return 1;
  return fail(fmt::format("{}: {:g} of {} trials now, {:g} of {} before", words(now), now.ours.value_or(0.0),
                          now.trials, before.ours.value_or(0.0), before.trials));
}

}  // namespace

Result<Report> repeated(const Report& stored, const Report& again) {
  if (stored.runs.empty()) return fail(fmt::format("{}: no run is stored of it", stored.name));
  const Run& first = stored.runs.front();
  const Run& run = again.runs.front();
  if (stored.name != again.name || run.seed != first.seed || run.trials > first.trials) {
    return fail(fmt::format("{}: {} trials of seed {} are none of the {} of seed {} that are stored", again.name,
                            run.trials, run.seed, first.trials, first.seed));
  }
  const bool whole = stored.runs.size() == 1 && run.trials == first.trials;
  std::size_t figures = 0;
  for (const Row& now : again.rows) {
    const auto same = [&](const Row& row) { return row.row == now.row && row.quantity == now.quantity; };
    const auto before = std::ranges::find_if(stored.rows, same);
    if (before == stored.rows.end()) return fail(fmt::format("{}: {} is new", stored.name, words(now)));
    const bool sampled = has_a_sample_per_trial(*before);
    if (!whole && !sampled) continue;
    const auto compared = sampled ? compare_samples(*before, now, whole) : compare_figures(*before, now);
    if (!compared) return fail(fmt::format("{}: {}", stored.name, compared.error().message));
    figures += *compared;
  }
  if (figures == 0) {
    return fail(
        fmt::format("{}: no row has a sample per trial: all {} trials have to be repeated", stored.name, first.trials));
  }
  Report report = stored;
  report.config_sha256 = again.config_sha256;
  report.sources_sha256 = again.sources_sha256;
  report.repetition = Repetition{run.commit, run.trials, static_cast<int>(figures)};
  return report;
}

}  // namespace cgsr::lab
