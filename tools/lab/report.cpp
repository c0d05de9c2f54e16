#include "tools/lab/report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/lab/report_table.h"

namespace cgsr::lab {

namespace {

bool holds(const Requirement& requirement, double value) {
  return requirement.kind == Requirement::Kind::kAtLeast ? value >= requirement.bound : value <= requirement.bound;
}

}  // namespace

std::optional<bool> Row::met() const {
  if (!requirement || !ours) return std::nullopt;
  if (requirement->kind != Requirement::Kind::kIntervalWithin) return holds(*requirement, *ours);
  if (!interval) return std::nullopt;
  return std::max(std::abs(interval->low), std::abs(interval->high)) <= requirement->bound;
}

bool Row::sure() const {
  if (!requirement || !interval || requirement->kind == Requirement::Kind::kIntervalWithin) return true;
  return holds(*requirement, interval->low) == holds(*requirement, interval->high);
}

Row plain_row(std::string row, std::string quantity, std::string unit, double value, std::size_t trials, Join join) {
  Row out;
  out.row = std::move(row);
  out.quantity = std::move(quantity);
  out.unit = std::move(unit);
  out.ours = value;
  out.trials = static_cast<int>(trials);
  out.join = join;
  return out;
}

Row sampled_row(std::string row, std::string quantity, std::string unit, std::vector<double> samples, Join join,
                std::uint64_t seed) {
  Row out = plain_row(std::move(row), std::move(quantity), std::move(unit), 0.0, samples.size(), join);
  const int trials = out.trials;
  if (join == Join::kMedian || join == Join::kP95) {
    const double share = join == Join::kMedian ? 0.5 : 0.95;
    out.ours = quantile(samples, share);
    out.interval = quantile_interval(samples, share);
  } else if (join == Join::kPaired && samples.size() == 1) {
    out.ours = samples.front();  // which no test can say anything about
  } else if (join == Join::kPaired) {
    const PairedTest test = paired_t_test(samples);
    out.ours = test.mean;
    out.interval = test.interval;
  } else if (join == Join::kPairedP) {
    out.ours = paired_t_test(samples).p;
  } else if (!samples.empty()) {
    out.ours = mean(samples);
    out.interval = bootstrap_mean(samples, 1, seed);
    // Values that are all the same teach a bootstrap nothing; of shares, a count of all or none says how far the mean may be off.
    if (out.unit.empty() && out.interval->low == out.interval->high && (*out.ours == 0.0 || *out.ours == 1.0))
      out.interval = wilson(*out.ours == 0.0 ? 0 : trials, trials);
  }
  if (samples.empty()) {
    out.ours = std::nullopt;
    out.interval = std::nullopt;
  }
  out.samples = std::move(samples);
  return out;
}

Row mean_row(std::string row, std::string quantity, std::string unit, const std::vector<double>& values,
             std::uint64_t seed) {
  return sampled_row(std::move(row), std::move(quantity), std::move(unit), values, Join::kMean, seed);
}

Row share_row(std::string row, std::string quantity, int successes, int trials) {
  const double share = trials > 0 ? static_cast<double>(successes) / trials : 0.0;
  Row out{std::move(row), std::move(quantity), "", std::nullopt, share, wilson(successes, trials), trials};
  out.join = Join::kShare;
  return out;
}

Table pivot(const Report& report) {
  Table table;
  for (const Row& row : report.rows) {
    const std::string heading = row.unit.empty() ? row.quantity : fmt::format("{} [{}]", row.quantity, row.unit);
    auto column = std::ranges::find(table.headings, heading);
    if (column == table.headings.end()) column = table.headings.insert(column, heading);
    const auto at = static_cast<std::size_t>(column - table.headings.begin());
    auto line = std::ranges::find(table.lines, row.row, &Table::Line::name);
    if (line == table.lines.end()) line = table.lines.insert(line, {row.row, {}});
    if (line->cells.size() <= at) line->cells.resize(at + 1);
    line->cells[at] = &row;
  }
  for (auto& line : table.lines) line.cells.resize(table.headings.size());
  return table;
}

std::string in_figures(double value) {
  const double size = std::abs(value);
  return size >= 100.0  ? fmt::format("{:.0f}", value)
         : size >= 10.0 ? fmt::format("{:.1f}", value)
                        : fmt::format("{:.3f}", value);
}

std::string required_words(const Requirement& requirement) {
  switch (requirement.kind) {
    case Requirement::Kind::kAtMost:
      return fmt::format("at most {:g}", requirement.bound);
    case Requirement::Kind::kAtLeast:
      return fmt::format("at least {:g}", requirement.bound);
    case Requirement::Kind::kIntervalWithin:
      return fmt::format("interval within ±{:g}", requirement.bound);
  }
  return "";
}

std::string in_words(const Row* row) {
  if (row == nullptr) return "";
  std::string words = row->ours ? in_figures(*row->ours) : "not there";
  if (row->interval) words += fmt::format(" {}..{}", in_figures(row->interval->low), in_figures(row->interval->high));
  if (row->dissertation) words += fmt::format(" (dissertation {})", in_figures(*row->dissertation));
  if (row->requirement) {
    const auto met = row->met();
    words +=
        fmt::format(" [required {}{}]", required_words(*row->requirement), met ? (*met ? ", met" : ", NOT MET") : "");
  }
  return words;
}

namespace {

std::string seeds_words(const Report& report) {
  std::vector<std::uint64_t> seeds;
  for (const Run& run : report.runs) seeds.push_back(run.seed);
  if (seeds.empty()) seeds.push_back(report.seed);
  return fmt::format("{}", fmt::join(seeds, ", "));
}

/// A line per step, a column per band.
std::string to_text(const Stripe& stripe) {
  std::string text = fmt::format("  {}\n  {:>4}", stripe.title, "");
  for (const auto& band : stripe.bands) text += fmt::format("  {:18}", band.name);
  for (std::size_t step = 0; step < stripe.bands.front().colors.size(); ++step) {
    text += fmt::format("\n  {:4}", step);
    for (const auto& band : stripe.bands) {
      const auto& light = band.colors[step];
      text += light ? fmt::format("  {:.2f} {:.2f} {:.2f}    ", light->r, light->g, light->b)
                    : fmt::format("  {:18}", "none");
    }
  }
  return text + "\n";
}

}  // namespace

std::string to_text(const Report& report) {
  const Table table = pivot(report);
  std::vector<std::vector<std::string>> cells{{""}};
  cells.front().insert(cells.front().end(), table.headings.begin(), table.headings.end());
  for (const auto& line : table.lines) {
    cells.push_back({line.name});
    for (const Row* row : line.cells) cells.back().push_back(in_words(row));
  }
  std::vector<std::size_t> widths(cells.front().size());
  for (const auto& line : cells) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }

  std::string text = fmt::format("{}: {}\nseed {}, configuration {}, sources {}\n", report.name, report.title,
                                 seeds_words(report), report.config_sha256, report.sources_sha256);
  for (const auto& line : cells) {
    std::string words;
    for (std::size_t i = 0; i < line.size(); ++i) words += fmt::format("{:{}}  ", line[i], widths[i]);
    text += "  " + words.substr(0, words.find_last_not_of(' ') + 1) + "\n";
  }
  for (const Stripe& stripe : report.stripes) text += to_text(stripe);
  for (const std::string& note : report.notes) text += fmt::format("  - {}\n", note);
  return text;
}

}  // namespace cgsr::lab
