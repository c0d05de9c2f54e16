#include "tools/lab/report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/lab/report_table.h"

namespace cgsr::lab {

Row plain_row(std::string row, std::string quantity, std::string unit, double value, std::size_t trials) {
  Row out;
  out.row = std::move(row);
  out.quantity = std::move(quantity);
  out.unit = std::move(unit);
  out.ours = value;
  out.trials = static_cast<int>(trials);
  return out;
}

Row mean_row(std::string row, std::string quantity, std::string unit, const std::vector<double>& values,
             std::uint64_t seed) {
  const auto trials = static_cast<int>(values.size());
  const double centre = mean(values);
  Interval interval = bootstrap_mean(values, 1, seed);
  // Values that are all the same teach a bootstrap nothing; of shares, a count of all or none says how far the mean may be off.
  if (unit.empty() && interval.low == interval.high && (centre == 0.0 || centre == 1.0))
    interval = wilson(centre == 0.0 ? 0 : trials, trials);
  return {std::move(row), std::move(quantity), std::move(unit), std::nullopt, centre, interval, trials};
}

Row share_row(std::string row, std::string quantity, int successes, int trials) {
  const double share = trials > 0 ? static_cast<double>(successes) / trials : 0.0;
  return {std::move(row), std::move(quantity), "", std::nullopt, share, wilson(successes, trials), trials};
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

std::string in_words(const Row* row) {
  if (row == nullptr) return "";
  std::string words = row->ours ? in_figures(*row->ours) : "not there";
  if (row->interval) words += fmt::format(" {}..{}", in_figures(row->interval->low), in_figures(row->interval->high));
  if (row->dissertation) words += fmt::format(" (dissertation {})", in_figures(*row->dissertation));
  return words;
}

namespace {

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

  std::string text =
      fmt::format("{}: {}\nseed {}, configuration {}\n", report.name, report.title, report.seed, report.config_sha256);
  for (const auto& line : cells) {
    std::string words;
    for (std::size_t i = 0; i < line.size(); ++i) words += fmt::format("{:{}}  ", line[i], widths[i]);
    text += "  " + words.substr(0, words.find_last_not_of(' ') + 1) + "\n";
  }
  for (const Stripe& stripe : report.stripes) text += to_text(stripe);
  for (const std::string& note : report.notes) text += fmt::format("  - {}\n", note);
  return text;
}

nlohmann::json to_json(const std::vector<Report>& reports) {
  auto all = nlohmann::json::array();
  const auto or_null = [](const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
  };
  for (const Report& report : reports) {
    auto rows = nlohmann::json::array();
    for (const Row& row : report.rows) {
      rows.push_back(
          {{"row", row.row},
           {"quantity", row.quantity},
           {"unit", row.unit},
           {"dissertation", or_null(row.dissertation)},
           {"ours", or_null(row.ours)},
           {"interval", row.interval ? nlohmann::json{row.interval->low, row.interval->high} : nlohmann::json()},
           {"trials", row.trials}});
    }
    all.push_back(
        {{"name", report.name}, {"config_sha256", report.config_sha256}, {"seed", report.seed}, {"rows", rows}});
  }
  return all;
}

}  // namespace cgsr::lab
