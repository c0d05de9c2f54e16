// Where people are hard to tell (6.2.4, 6.3): exchanged shirts, a white shirt before a white wall, light that changes, two people who cross, a dark face in the dark. The robot stands and
// looks on; what it says of each image is compared with the script.

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/lab/experiment.h"
#include "tools/lab/people_script.h"
#include "tools/lab/person_cast.h"
#include "tools/lab/person_watch.h"
#include "tools/lab/scenes/random.h"
#include "tools/lab/source_path.h"
#include "tools/lab/tables/people_tables.h"

namespace cgsr::lab {
namespace {

constexpr double kPeriod_s = 1.0 / 30.0;
constexpr int kAroundChange = 5;  // images that are left out after a change

/// What was said of the images in which somebody is visible.
struct Counts {
  int images = 0, right = 0, wrong = 0, unsure = 0;
  int late = 0, late_wrong = 0;  // those in which only a face could tell, and had to be looked for
  int left_out = 0, left_out_wrong = 0;
};

Counts count(const std::vector<Seen>& seen, const Case& one) {
  Counts counts;
  for (const Seen& image : seen) {
    if (image.time_s < 0.0) continue;
    const auto after =
        std::ranges::find_if(one.phases, [&](const Phase& phase) { return phase.from_s > image.time_s; });
    const Phase& phase = *std::prev(after);
    const double since_s = image.time_s - phase.from_s;
    const bool wrong = image.number >= 0 && image.number != phase.number;
    if (phase.number == 0 || (phase.from_s > 0.0 && since_s < kAroundChange * kPeriod_s)) {
      ++counts.left_out;
      counts.left_out_wrong += phase.number != 0 && wrong ? 1 : 0;
      continue;
    }
    if (since_s < phase.grace_s) {
      ++counts.late;
      counts.late_wrong += wrong ? 1 : 0;
      continue;
    }
    ++counts.images;
    counts.right += image.number == phase.number ? 1 : 0;
    counts.wrong += wrong ? 1 : 0;
    counts.unsure += image.unsure ? 1 : 0;
  }
  return counts;
}

/// The arena in this case: its light, walls and fill light. Errors: the arena's text has no such place any longer.
Result<std::string> world_of(std::string world, const Case& one) {
  const auto replaced = [&world](const std::string& what, const std::string& by) {
    const auto found = world.find(what);
    if (found == std::string::npos) return false;
    world.replace(found, what.size(), by);
    return true;
  };
  const std::string lamp = "bounce = 0.006\n", wall = "albedo = [0.62, 0.66, 0.68]", light = "lumens = 250.0";
  const auto none = [](const std::string& what) {
    return fail(fmt::format("people-cases: no '{}' in the world of Who Is Who, where this case would change it", what));
  };
  if (!replaced(lamp, lamp + one.lamp)) return none("bounce = 0.006");
  if (one.white_wall && !replaced(wall, "albedo = [0.80, 0.80, 0.79]")) return none(wall);
  if (!replaced(light, fmt::format("lumens = {:.1f}", one.face_light_lm))) return none(light);
  for (std::size_t i = 0; i < one.figures.size(); ++i)
    world += text_of(one.figures[i], fmt::format("figure {}", i + 1));
  return world + one.ambient;
}

void write_scene(const TableFolder& folder, const std::string& world, const Case& one) {
  std::ofstream(folder / "world.toml") << world;
  std::ofstream(folder / "scenario.toml") << fmt::format(
      "world = \"world.toml\"\nrobot = \"robot\"\nends_at_s = {}\n[[line]]\nname = \"arming\"\ninput = true\n"
      "[[line]]\nname = \"face light\"\n",
      kTraining_s + one.ends_s);
}

double share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : 0.0;
}

void add_rows(const std::string& name, const std::vector<Counts>& casts, std::uint64_t seed, Report& report) {
  const auto add = [&](const char* quantity, int Counts::*part, int Counts::*whole) {
    std::vector<double> shares;
    for (const Counts& counts : casts) shares.push_back(share(counts.*part, counts.*whole));
    report.rows.push_back(mean_row(name, quantity, "", shares, seed));
  };
  add("identified", &Counts::right, &Counts::images);
  add("taken for somebody else", &Counts::wrong, &Counts::images);
  add("unsure", &Counts::unsure, &Counts::images);
  if (std::ranges::any_of(casts, [](const Counts& counts) { return counts.late > 0; }))
    add("taken for somebody else in the first second after a return", &Counts::late_wrong, &Counts::late);
  std::vector<double> left_out, wrong;
  for (const Counts& counts : casts) {
    left_out.push_back(counts.left_out);
    wrong.push_back(counts.left_out_wrong);
  }
  report.rows.push_back(mean_row(name, "images left out", "", left_out, seed));
  report.rows.push_back(mean_row(name, "of them taken for somebody else", "", wrong, seed));
}

/// Two who look so much alike that the second is refused as the first are drawn again: it is not what these cases are about.
/// \return the case, and how often it was drawn again.
Result<std::pair<Case, int>> draw_enrolled(const TableFolder& folder, Portraits& portraits, std::uint64_t seed,
                                           std::size_t place) {
  constexpr int kAtMost = 10;
  Random random(Random::mix(seed * kPeopleCases + place));
  for (int again = 0; again < kAtMost; ++again) {
    Case one = draw_people_case(place, random);
    std::filesystem::remove(folder / "identities");
    const auto refused = enroll_all({one.identities[0], one.identities[1]}, portraits, folder / "identities");
    if (!refused) return tl::unexpected(refused.error());
    if (*refused == 0) return std::pair(std::move(one), again);
  }
  return fail(
      fmt::format("people-cases: no two of {} draws with seed {} are told apart by their faces", kAtMost, seed));
}

}  // namespace

Result<Report> people_cases(const Setting& setting) {
  const std::string shipped =
      setting.config_file.empty() ? source_path("config/robots/sim-people.toml") : setting.config_file;
  const TableFolder folder("people-cases");
  Portraits portraits(folder);
  const auto arena = empty_arena();
  if (!arena) return tl::unexpected(arena.error());
  std::array<std::vector<Counts>, kPeopleCases> counts;
  std::array<std::string, kPeopleCases> names;
  Report report;
  int redrawn = 0;
  for (int trial = 0; trial < setting.trials; ++trial) {
    const std::uint64_t seed = setting.seed + static_cast<std::uint64_t>(trial);
    for (std::size_t i = 0; i < kPeopleCases; ++i) {
      setting.progress(
          fmt::format("case {} of {}, variation {} of {}", i + 1, kPeopleCases, trial + 1, setting.trials));
      const auto drawn = draw_enrolled(folder, portraits, seed, i);
      if (!drawn) return tl::unexpected(drawn.error());
      const Case& one = drawn->first;
      redrawn += drawn->second;
      names[i] = one.name;
      const auto world = world_of(*arena, one);
      if (!world) return tl::unexpected(world.error());
      write_scene(folder, *world, one);
      const auto seen = watch(folder, shipped, seed, one.robot, kTraining_s);
      if (!seen) return tl::unexpected(seen.error());
      counts[i].push_back(count(*seen, one));
    }
  }
  report.title = fmt::format("people who are hard to tell, {} variations of each case", setting.trials);
  for (std::size_t i = 0; i < kPeopleCases; ++i) add_rows(names[i], counts[i], setting.seed, report);
  report.rows.push_back(plain_row("enrolment", "pairs drawn again because the second is refused as the first", "",
                                  redrawn, counts[0].size()));
  report.notes = {
      "Identities, shirts, heights, places and light are drawn by the seed; intervals are over variations. The robot "
      "has seen the person from the front for 3 s before.",
      fmt::format(
          "Left out, and counted: {} images after each change of the script, and those in which nobody is there or one "
          "person covers the other. "
          "After a return in another's shirt, or of a second person, only a face can tell: the first second is "
          "a row of its own.",
          kAroundChange),
      "The light changes by a factor of up to two, lamp and ambient light alike, in half of the variations to the "
      "brighter. In the "
      "dark the robot has to find the face of somebody of whom it knows nothing yet: with a light of its own, and, as "
      "the counterpart, without."};
  return report;
}

}  // namespace cgsr::lab
