// The robot's own program in the simulated home, once for each seed, judged by what was really there.

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/lab/child.h"
#include "tools/lab/experiment.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

/// A figure of a run's truth and what it has to keep to.
struct Demand {
  const char* key;
  const char* words;
  const char* unit;
  double bound;
  bool at_least;

  [[nodiscard]] bool holds(double value) const { return at_least ? value >= bound : value <= bound; }
};

constexpr std::array kDemands{
    Demand{"in_view_share", "in view from the first sight on", "", 0.95, true},
    Demand{"nearest_by_own_motion", "nearest by its own motion, of the set distance", "", 0.8, true},
    Demand{"longest_command_when_nearer_s", "commanded zero after the object came nearer", "s", 0.5, false},
    Demand{"longest_command_after_loss_s", "commanded zero after a loss", "s", 0.5, false},
    Demand{"longest_roll_after_loss_s", "standing after a loss", "s", 0.5, false},
    Demand{"fastest_object_mps", "fastest object", "m/s", 0.5, false},
};

/// What did not happen in a run (a loss, say) has no value in it.
std::vector<double> values_of(const std::vector<nlohmann::json>& runs, const char* key) {
  std::vector<double> values;
  for (const auto& run : runs) {
    const auto& value = run.at("truth").at(key);
    if (!value.is_null()) values.push_back(value.get<double>());
  }
  return values;
}

void add_demand(const std::vector<nlohmann::json>& runs, const Demand& demand, std::uint64_t seed, Report& report) {
  const auto values = values_of(runs, demand.key);
  if (values.empty()) return;
  const int trials = static_cast<int>(values.size());
  const auto [least, most] = std::ranges::minmax_element(values);
  report.rows.push_back(mean_row(demand.words, "mean", demand.unit, values, seed));
  report.rows.push_back(plain_row(demand.words, "worst", demand.unit, demand.at_least ? *least : *most, values.size(),
                                  demand.at_least ? Join::kMin : Join::kMax));
  const auto held = std::ranges::count_if(values, [&](double value) { return demand.holds(value); });
  report.rows.push_back(share_row(demand.words, "runs that hold", static_cast<int>(held), trials));
}

}  // namespace

Result<Report> closed_loop(const Setting& setting) {
  const std::string robot =
      setting.config_file.empty() ? source_path("config/robots/sim-home.toml") : setting.config_file;
  const int count = setting.trials;
  std::vector<nlohmann::json> runs;
  for (int i = 0; i < count; ++i) {
    setting.progress(fmt::format("closed loop, run {} of {}", i + 1, count));
    auto run = run_robot(robot, setting.seed + static_cast<std::uint64_t>(i));
    if (!run) return tl::unexpected(run.error());
    if (!run->contains("truth")) return fail(fmt::format("{}: is not a robot of the simulated home", robot));
    runs.push_back(std::move(*run));
  }
  Report report;
  report.title =
      fmt::format("the robot follows a cart through the simulated home while the light changes, {} runs", count);
  for (const Demand& demand : kDemands) add_demand(runs, demand, setting.seed, report);
  for (const auto& [key, words] : {std::pair("found_share", "found where it was in view"),
                                   std::pair("found_right_share", "found there with the right box")}) {
    report.rows.push_back(mean_row(words, "mean", "", values_of(runs, key), setting.seed));
  }
  report.notes = {
      "Not in the dissertation. Every figure comes from the simulator's truth, none from what the robot believes.",
      "A seed draws noise, wheel slip and how far the cart goes astray; lamps and switches keep to the scenario.",
      "Commands are seen once per image, so times are whole images; standing is below 0.05 m/s over the ground. "
      "A base that balances leans back before it brakes; how long that takes is the simulated base's own "
      "(hal/sim/base)."};
  return report;
}

}  // namespace cgsr::lab
