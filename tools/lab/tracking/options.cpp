#include "tools/lab/tracking/options.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "src/commands/option_checks.h"
#include "tools/lab/trackers.h"

namespace cgsr::lab {

bool TrackingOptions::has(BenchmarkPart part) const {
  return parts.empty() || std::ranges::count(parts, to_string(part)) > 0;
}

bool TrackingOptions::runs(std::string_view tracker) const {
  if (ours_only) return tracker == "ours";
  return trackers.empty() || std::ranges::count(trackers, tracker) > 0;
}

void add_tracking_options(CLI::App& app, TrackingOptions& options) {
  constexpr const char* kGroup = "tracking-benchmark";
  std::vector<std::string> names;
  for (const NamedTracker& tracker : trackers()) names.emplace_back(tracker.name);
  const std::vector<std::string> parts(kBenchmarkParts.begin(), kBenchmarkParts.end());
  const auto add_list = [&](const char* name, std::vector<std::string>& list, const char* meaning) {
    return app.add_option(name, list, meaning)->delimiter(',')->group(kGroup);
  };
  add_list("--sequences", options.sequences,
           "folders of sequences (each img/ and groundtruth.txt); none: tracking and people/human3 of --data");
  add_list("--only", options.only, "names of the sequences to run");
  add_list("--trackers", options.trackers, "the trackers to run; none: all")->check(CLI::IsMember(names));
  add_list("--parts", options.parts, "what to measure; none: everything")->check(CLI::IsMember(parts));
  app.add_flag("--ours-only", options.ours_only, "run no peer")->group(kGroup);
  app.add_option("--images", options.images, "of each sequence, its first ones; 0: all")
      ->check(cgsr::app::in_range(0, 1000000))
      ->group(kGroup);
  app.add_option("--every", options.every, "only each so-many-th start of the robustness parts")
      ->check(cgsr::app::in_range(1, 20))
      ->group(kGroup);
  app.add_option("--light-seed", options.light_seed, "of the relit variants")
      ->check(cgsr::app::whole_number())
      ->group(kGroup);
  app.add_option("--output", options.output, "folder of the page, its films and figures")
      ->capture_default_str()
      ->group(kGroup);
  app.add_flag("--no-films", options.no_films, "write no films and no pictures")->group(kGroup);
  app.add_option("--against", options.against,
                 "figures.json of an earlier run, of other code or another configuration: prints what changed per fold")
      ->group(kGroup);
  app.add_option("--cache", options.cache, "folder of the peers' boxes; none: cgsr/tracking in the user's cache")
      ->group(kGroup);
}

}  // namespace cgsr::lab
