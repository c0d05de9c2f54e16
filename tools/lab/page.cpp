#include "tools/lab/page.h"

#include <regex>

#include <fmt/format.h>

#include "tools/lab/report_table.h"
#include "tools/lab/tables/requirements.h"

namespace cgsr::lab {
namespace {

constexpr int kHashDigits = 12;

constexpr std::string_view kHead = R"(# Results

This page is generated from `docs/results/*.json` by `cgsr reproduce --page`; edit neither. `cgsr reproduce NAME --resume` measures a table with a
seed that is drawn (at least 1000; smaller ones are for tuning and tests), and joins its trials to those that were measured with the same
configuration and sources. Every figure stands with its 95 % interval where trials give one. 'Met' is said of the figure; 'not sure' is added where
the interval reaches beyond the requirement. Repeated: sources or configuration have changed since in what the table does not measure, which trials that
were measured again showed (`cgsr reproduce NAME --repeat`: each sample of theirs is the same; shares and cost are not compared). Stale: the configuration or the sources of the rooms that the table measures have changed since
(`tools/check` lists such tables). What was measured before is in CHANGELOG.md.
)";

std::string escaped(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

std::string ours_words(const Row& row) {
  if (!row.ours) return "not measured";
  std::string words = in_figures(*row.ours);
  if (row.interval) words += fmt::format(" ({} to {})", in_figures(row.interval->low), in_figures(row.interval->high));
  return words;
}

std::string met_words(const Row& row, Staleness staleness) {
  const auto met = row.met();
  std::string words = met ? (*met ? "yes" : "**no**") : "";
  if (met && !row.sure()) words += ", not sure";
  if (staleness != Staleness::kFresh) words += " (stale)";
  return words;
}

std::string line_of(const PageEntry& entry, const Row& row) {
  const std::string unit = row.unit.empty() ? "" : fmt::format(" [{}]", row.unit);
  return fmt::format("| {}: {}{} | {} | {} | {} | {} | `cgsr reproduce {}` |\n", escaped(row.row),
                     escaped(row.quantity), unit, row.dissertation ? in_figures(*row.dissertation) : "",
                     ours_words(row), row.requirement ? required_words(*row.requirement) : "",
                     met_words(row, entry.staleness), entry.experiment->name);
}

std::string lines_of(const PageEntry& entry) {
  if (!entry.stored) {
    return fmt::format("| {} | | not measured on this tree | | | `cgsr reproduce {}` |\n",
                       escaped(std::string(entry.experiment->title)), entry.experiment->name);
  }
  std::string text;
  for (const Row& row : entry.stored->rows) {
    if (row.requirement || row.dissertation) text += line_of(entry, row);
  }
  return text;
}

/// How a table came about, in a line of a list.
std::string provenance_of(const PageEntry& entry) {
  const Report& report = *entry.stored;
  std::vector<std::string> runs;
  for (const Run& run : report.runs) {
    runs.push_back(fmt::format("seed {}, {} trials, commit {}", run.seed, run.trials, run.commit));
  }
  std::string text =
      fmt::format("- `{0}`: {1}; {2}; configuration {3}, sources {4}; all {5} rows: [{0}.json](results/{0}.json)",
                  report.name, report.title, fmt::join(runs, "; "), report.config_sha256.substr(0, kHashDigits),
                  report.sources_sha256.substr(0, kHashDigits), report.rows.size());
  if (const auto& repetition = report.repetition) {
    text += fmt::format("; its first {} trials, repeated at commit {}, gave the same {} figures", repetition->trials,
                        repetition->commit, repetition->figures);
  }
  if (entry.staleness != Staleness::kFresh) text += fmt::format(" (stale: {})", to_string(entry.staleness));
  text += '\n';
  for (const Row& row : report.rows) {
    const auto met = row.met();
    if (!met || *met) continue;
    const auto why = unmet_because(report.name, row.row, row.quantity);
    text +=
        fmt::format("  - not met: {}, {}: {}\n", row.row, row.quantity, why.empty() ? "the cause is not known" : why);
  }
  return text;
}

}  // namespace

Result<std::vector<PageEntry>> entries_of(const Store& store) {
  std::vector<PageEntry> entries;
  for (const Experiment& experiment : experiments()) {
    auto stored = store.read(experiment.name);
    if (!stored) return tl::unexpected(stored.error());
    PageEntry entry{&experiment, std::move(*stored)};
    if (entry.stored) {
      const auto staleness = staleness_of(*entry.stored, experiment);
      if (!staleness) return tl::unexpected(staleness.error());
      entry.staleness = *staleness;
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::string page_of(const std::vector<PageEntry>& entries) {
  std::string page(kHead);
  int chapter = 0;
  std::string lists;
  for (const PageEntry& entry : entries) {
    if (entry.experiment->chapter != chapter) {
      page += lists;
      lists = "\n";
      chapter = entry.experiment->chapter;
      page += fmt::format("\n## Chapter {}\n\n", chapter);
      page += "| quantity | dissertation | ours (95 %) | requirement | met | command |\n|---|---|---|---|---|---|\n";
    }
    page += lines_of(entry);
    if (entry.stored) lists += provenance_of(entry);
  }
  return page + lists;
}

std::string without_stale_marks(const std::string& page) {
  static const std::regex kMarks(R"( \(stale(: [a-z ]+)?\))");
  return std::regex_replace(page, kMarks, "");
}

}  // namespace cgsr::lab
