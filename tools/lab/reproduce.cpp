#include "tools/lab/reproduce.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "src/commands/option_checks.h"
#include "src/config/load.h"
#include "src/output/output_claims.h"
#include "src/output/text_file.h"
#include "tools/lab/experiment.h"
#include "tools/lab/join.h"
#include "tools/lab/page.h"
#include "tools/lab/repeat.h"
#include "tools/lab/source_path.h"
#include "tools/lab/store.h"

namespace cgsr::lab {
namespace {

constexpr std::string_view kPage = "docs/results.md";
constexpr int kRepeatedShare = 10;  // a tenth of the trials

Result<std::vector<const Experiment*>> chosen(const ReproduceOptions& options) {
  std::vector<const Experiment*> all;
  for (const Experiment& experiment : experiments()) {
    if (options.all || (options.names.empty() && !experiment.by_name_only)) all.push_back(&experiment);
  }
  for (const std::string& name : options.names) {
    const Experiment* const found = experiment_of(name);
    if (found == nullptr) return fail(fmt::format("there is no table '{}'; --list names what there is", name));
    if (!options.all) all.push_back(found);
  }
  return all;
}

void list_experiments() {
  for (const Experiment& experiment : experiments()) {
    fmt::print("{:17} {} ({} trials a run{})\n", experiment.name, experiment.title, experiment.trials,
               experiment.by_name_only ? ", by name only" : "");
  }
}

Result<Setting> setting_of(const ReproduceOptions& options) {
  const auto configuration = config::load_color(options.config);
  if (!configuration) return tl::unexpected(configuration.error());
  Setting setting;
  setting.configuration = *configuration;
  setting.config_file = options.config;
  setting.seed = options.seed ? *options.seed : draw_seed();
  setting.count = !options.no_count;
  setting.trials = options.trials;
  setting.tracking = options.tracking;
  if (!options.data.empty()) setting.data = options.data;
  if (!options.videos.empty()) setting.videos = options.videos;
  if (isatty(STDERR_FILENO) != 0) {
    setting.progress = [](const std::string& words) { fmt::print(stderr, "\r\033[K{}", words); };
  }
  return setting;
}

Store store_of(const ReproduceOptions& options) {
  return Store(options.results.empty() ? source_path("docs/results") : options.results);
}

/// Joins a report to what is stored of its table, where that was measured alike, and says what it did.
Result<Report> resumed(const Store& store, const Experiment& experiment, Report report) {
  const auto stored = store.read(report.name);
  if (!stored) return tl::unexpected(stored.error());
  if (!*stored) return report;
  if (!experiment.drawn) {
    fmt::print(stderr, "{}: does not depend on the seed, so it replaces what is stored\n", report.name);
    return report;
  }
  auto both = joined(**stored, report);
  if (both) return both;
  fmt::print(stderr, "{}; this run replaces it\n", both.error().message);
  return report;
}

Result<Report> run_one(const Experiment& experiment, const Setting& setting, const ReproduceOptions& options) {
  auto report = measure(experiment, setting);
  setting.progress("");
  if (!report || (!options.store && !options.resume)) return report;
  const Store store = store_of(options);
  if (options.resume) {
    report = resumed(store, experiment, std::move(*report));
    if (!report) return report;
  }
  if (const auto written = store.write(*report); !written) return tl::unexpected(written.error());
  return report;
}

/// Measures trials of a stored table again, and says in the store that they gave the same figures.
Result<Report> repeat_one(const Experiment& experiment, Setting setting, const Store& store) {
  const auto stored = store.read(experiment.name);
  if (!stored) return tl::unexpected(stored.error());
  if (!*stored) return fail(fmt::format("{}: nothing is stored that could be repeated", experiment.name));
  const Run& first = (*stored)->runs.front();
  setting.seed = first.seed;
  const int least = (first.trials + kRepeatedShare - 1) / kRepeatedShare;
  if (setting.trials > 0 && setting.trials < least) {
    return fail(fmt::format("--trials {}: {} were published of {}, so {} at least have to be repeated", setting.trials,
                            first.trials, experiment.name, least));
  }
  setting.trials = std::min(first.trials, std::max(least, setting.trials));
  setting.count = false;
  auto again = measure(experiment, setting);
  setting.progress("");
  if (!again) return again;
  auto report = repeated(**stored, *again);
  if (!report) return report;
  if (const auto written = store.write(*report); !written) return tl::unexpected(written.error());
  fmt::print(stderr, "{}: {} trials gave the same {} figures\n", report->name, report->repetition->trials,
             report->repetition->figures);
  return report;
}

Result<void> measure_all(const ReproduceOptions& options) {
  app::OutputClaims files(options.force);
  files.reads(options.config, "--config");
  files.writes(options.json, "--json", app::json_list());
  files.writes(options.html, "--html", app::html_page());
  if (auto claimed = files.claim(); !claimed) return claimed;
  const auto wanted = chosen(options);
  if (!wanted) return tl::unexpected(wanted.error());
  const auto setting = setting_of(options);
  if (!setting) return tl::unexpected(setting.error());
  if ((options.store || options.resume) && setting->seed < kMinDrawnSeed) {
    return fail(
        fmt::format("--seed {}: stored results need a seed of at least {}, or none, so that it is drawn; "
                    "smaller ones are for tuning and tests",
                    setting->seed, kMinDrawnSeed));
  }
  std::vector<Report> reports;
  for (const Experiment* experiment : *wanted) {
    auto report =
        options.repeat ? repeat_one(*experiment, *setting, store_of(options)) : run_one(*experiment, *setting, options);
    if (!report) return tl::unexpected(report.error());
    fmt::print("{}\n", to_text(*report));
    std::fflush(stdout);
    reports.push_back(std::move(*report));
  }
  if (!options.json.empty()) {
    if (auto written = app::write_file(options.json, to_json_text(reports)); !written) return written;
  }
  return options.html.empty() ? Result<void>{} : app::write_file(options.html, to_html(reports));
}

Result<int> check_page(const std::string& page, const std::vector<PageEntry>& entries) {
  for (const PageEntry& entry : entries) {
    if (entry.staleness == Staleness::kFresh) continue;
    fmt::print("docs/results/{}.json: stale: {}; cgsr reproduce {} --resume measures it anew\n", entry.experiment->name,
               to_string(entry.staleness), entry.experiment->name);
  }
  std::ifstream in(source_path(kPage));
  const std::string written(std::istreambuf_iterator<char>(in), {});
  if (written == page) return 0;
  if (without_stale_marks(written) == without_stale_marks(page)) {
    fmt::print("{}: its marks of what is stale are old; cgsr reproduce --page writes them\n", kPage);
    return 0;
  }
  fmt::print(stderr, "{}: differs from what docs/results/*.json say; cgsr reproduce --page writes it\n", kPage);
  return 1;
}

}  // namespace

void add_reproduce(CLI::App& app, ReproduceOptions& options) {
  app.add_option("name", options.names, "tables to reproduce; none: all that are not by name only");
  app.add_flag("--list", options.list, "name what there is");
  app.add_flag("--all", options.all, "every table: an hour");
  app.add_option("--seed", options.seed, "of everything that is drawn at random; none: drawn at the run, and printed")
      ->check(cgsr::app::whole_number());
  app.add_option("--trials", options.trials, "instead of each table's own number")
      ->check(cgsr::app::in_range(1, 1000000));
  app.add_option("--config", options.config, "a robot's file, for the sections that a table uses; none: what ships");
  app.add_option("--data", options.data, "folder of recorded sequences")->envname("CGSR_DATA");
  app.add_option("--videos", options.videos,
                 "folder for the films of tables that film; none: cgsr-videos in the temporary folder");
  app.add_flag("--no-count", options.no_count, "leave out the instructions, which are slow to count");
  app.add_option("--json", options.json, "write the rows for machines");
  app.add_option("--html", options.html, "write a page with tables and plots");
  cgsr::app::add_force_option(app, options.force);
  app.add_flag("--store", options.store, "replace the published results of these tables (docs/results)");
  app.add_flag("--resume", options.resume,
               "the same, joining these trials to published ones of equal configuration and sources");
  app.add_flag(
         "--repeat", options.repeat,
         "measure the first trials of the published results again (a tenth, or more by --trials), without cost; where "
         "all give the same figures, what is "
         "published counts as measured with this configuration and these sources")
      ->excludes("--store")
      ->excludes("--resume")
      ->excludes("--seed");
  app.add_flag("--page", options.page, "write docs/results.md out of the published results; measures nothing");
  app.add_flag(
      "--check-page", options.check_page,
      "list published tables that are stale; fail when docs/results.md is not what they say; measures nothing");
  app.add_option("--results", options.results, "the folder of published results; none: docs/results of the sources");
  add_tracking_options(app, options.tracking);
}

Result<int> reproduce(const ReproduceOptions& options) {
  if (options.list) {
    list_experiments();
    return 0;
  }
  if (options.page || options.check_page) {
    const auto entries = entries_of(store_of(options));
    if (!entries) return tl::unexpected(entries.error());
    const std::string page = page_of(*entries);
    if (options.check_page) return check_page(page, *entries);
    const auto written = app::write_file(source_path(kPage), page);
    if (!written) return tl::unexpected(written.error());
    return 0;
  }
  if (auto done = measure_all(options); !done) return tl::unexpected(done.error());
  return 0;
}

}  // namespace cgsr::lab
