// Everything at once in the home: a robot without a probe board localizes, computes shadows of a lamp whose place it was given, tracks a ball, identifies
// people and follows one. What an image costs is counted, and the probes' cost on the lamp robot is added.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include "tools/lab/counting.h"
#include "tools/lab/experiment.h"
#include "tools/lab/person_cast.h"
#include "tools/lab/source_path.h"
#include "tools/lab/tables/people_tables.h"

namespace cgsr::lab {
namespace {

constexpr double kProbes_s = 0.9;  // of the lamp robot: its first images, the lamp found and not
constexpr const char* kRow = "everything at once";

/// The probes' Minstr per image of a robot that carries them.
Result<Cost> count_probes(std::uint64_t seed) {
  const auto counted = count_program(
      "cgsr", {"run", "--config", source_path("config/robots/sim-home-lamp.toml"), "--seed", std::to_string(seed),
               "--duration", fmt::format("{}", kProbes_s), "--log-level", "warning"});
  if (!counted) return tl::unexpected(counted.error());
  const auto probes = counted->stages.find("probes");
  if (probes == counted->stages.end()) return fail("the lamp robot's probes were not counted");
  Cost cost = probes->second;
  cost.mean_minstr *= static_cast<double>(cost.images) / std::max(1, counted->images);
  return cost;
}

void add_rows(const Counted& counted, const Cost& probes, const nlohmann::json& stages, Report& report) {
  const auto trials = static_cast<std::size_t>(counted.images);
  const auto add = [&](const std::string& row, const char* quantity, const char* unit, double value, Join join) {
    report.rows.push_back(plain_row(row, quantity, unit, value, trials, join));
  };
  const auto recognition = counted.stages.find("recognition");
  const double beside =
      recognition == counted.stages.end()
          ? 0.0
          : recognition->second.mean_minstr * recognition->second.images / std::max(1, counted.images);
  add(kRow, "image, with probes and recognition", "Minstr", counted.image.mean_minstr + probes.mean_minstr,
      Join::kWeighted);
  add(kRow, "image, with probes and recognition, worst", "Minstr", counted.image.worst_minstr + probes.worst_minstr,
      Join::kMax);
  add(kRow, "frame path, with probes", "Minstr", counted.frame_path.mean_minstr + probes.mean_minstr, Join::kWeighted);
  add(kRow, "frame path, with probes, worst", "Minstr", counted.frame_path.worst_minstr + probes.worst_minstr,
      Join::kMax);
  add(kRow, "of that, recognition beside the frame path", "Minstr", beside, Join::kWeighted);
  int skips = 0, over_budget = 0;
  for (const auto& [name, figures] : stages.items()) {
    skips += figures.at("skips").get<int>();
    const auto cost = counted.stages.find(name);
    if (cost == counted.stages.end()) continue;
    over_budget += 1000.0 * cost->second.worst_minstr > figures.at("budget_us").get<double>() ? 1 : 0;
    add(name, "a run", "Minstr", cost->second.mean_minstr, Join::kWeighted);
    add(name, "a run, worst", "Minstr", cost->second.worst_minstr, Join::kMax);
    add(name, "runs in an image", "", static_cast<double>(cost->second.images) / std::max(1, counted.images),
        Join::kWeighted);
  }
  add("probes, of the lamp robot", "an image", "Minstr", probes.mean_minstr, Join::kWeighted);
  add("probes, of the lamp robot", "a run, worst", "Minstr", probes.worst_minstr, Join::kMax);
  add(kRow, "skipped turns", "", skips, Join::kMax);
  add(kRow, "stages whose worst run exceeds their budget at 1 GHz", "", over_budget, Join::kMax);
}

}  // namespace

Result<Report> everything(const Setting& setting) {
  if (!setting.count) return fail("everything counts instructions and nothing else: not with --no-count");
  const std::string shipped =
      setting.config_file.empty() ? source_path("config/robots/sim-home-everything.toml") : setting.config_file;
  const TableFolder folder("everything");
  Portraits portraits(folder);
  if (const auto enrolled = enroll_all({0, 1, 2, 3}, portraits, folder / "identities"); !enrolled)
    return tl::unexpected(enrolled.error());
  const auto robot = folder / "robot.toml";
  std::ofstream(robot) << fmt::format("extends = \"{}\"\nperson.identities = \"identities\"\n",
                                      std::filesystem::absolute(shipped).string());
  setting.progress("everything at once, counted");
  const auto counted = count_program(
      "cgsr", {"run", "--config", robot.string(), "--seed", std::to_string(setting.seed), "--log-level", "warning"});
  if (!counted) return tl::unexpected(counted.error());
  setting.progress("everything at once, the lamp robot's probes");
  const auto probes = count_probes(setting.seed);
  if (!probes) return tl::unexpected(probes.error());
  const auto run = run_with_people(folder, shipped, setting.seed);  // what it says of its schedule
  if (!run) return tl::unexpected(run.error());
  Report report;
  report.title = fmt::format("instructions per image of everything at once in the home, {} images", counted->images);
  add_rows(*counted, *probes, run->at("stages"), report);
  report.notes = {
      "SSE2 baseline, counted by tools/count; repeats exactly. The robot localizes, computes shadows of a lamp whose "
      "place is in its file, tracks a ball, identifies people and follows one.",
      fmt::format("The robot carries no probe board: the probes' cost is that of the first {} s of the lamp robot. The "
                  "worst of both are added, though they need not meet in one image.",
                  kProbes_s),
      "Recognition is what the thread of that name does on a robot, preempted by the frame path.",
      "In lock-step nothing is late, so that no turn is skipped; at 1 GHz and one instruction in each cycle a stage "
      "would "
      "lose its next turn where its worst run exceeds its budget."};
  return report;
}

}  // namespace cgsr::lab
