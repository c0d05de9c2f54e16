// Where people are hard to tell (6.2.4, 6.3): exchanged shirts, a white shirt before a white wall, light that changes, two people who cross, a dark face in the dark. The robot stands and
// looks on; what it says of each image is compared with the script.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/sim/people/person.h"
#include "tools/lab/experiment.h"
#include "tools/lab/person_cast.h"
#include "tools/lab/person_watch.h"
#include "tools/lab/scenes/random.h"
#include "tools/lab/source_path.h"
#include "tools/lab/tables/people_tables.h"

namespace cgsr::lab {
namespace {

using Shirt = std::array<double, 3>;

constexpr double kTraining_s = 3.0;  // the person alone, from the front
constexpr double kRobot_m = 0.8;     // where the arena's robot stands
constexpr double kPeriod_s = 1.0 / 30.0;
constexpr int kAroundChange = 5;   // images that are left out after a change
constexpr double kToFace_s = 1.0;  // in another's shirt only a face can tell, and it has to be found and compared

/// Somebody at one place for some time, as the world's file has him.
struct Figure {
  int identity = 0;
  double height_m = 1.7;
  Shirt shirt{};
  double x_m = 2.3, y_m = 0.0;
  double from_s = 0.0, to_s = 1000.0;                    // of the whole run
  double turns_s = 1000.0;                               // away, so long after the run's begin
  double to_y_m = 0.0, walks_s = -1.0, speed_mps = 0.4;  // sideways, from then on; negative: he stands
};

std::string text_of(const Figure& figure, const std::string& name) {
  const double to_robot_deg = 180.0 + std::atan2(figure.y_m, figure.x_m - kRobot_m) * 180.0 / 3.14159265358979;
  std::string text = fmt::format(
      "[[person]]\nname = \"{}\"\nidentity = {}\nheight_m = {:.2f}\noutfit = [{{ shirt = \"plain\", color = [{:.2f}, "
      "{:.2f}, {:.2f}] }}]\npresence = [{{ at_s = 0.0, present = {} }}, {{ at_s = {:.2f}, present = true }}, {{ at_s = "
      "{:.2f}, present = false }}]\n[person.walk]\nstop = [\n",
      name, figure.identity, figure.height_m, figure.shirt[0], figure.shirt[1], figure.shirt[2], figure.from_s <= 0.0,
      std::max(0.01, figure.from_s), figure.to_s);
  text += fmt::format("{{ at_m = [{:.2f}, {:.2f}, 0.0], wait_s = {:.2f}, heading_deg = {:.1f} }},\n", figure.x_m,
                      figure.y_m, std::min(figure.turns_s, 1000.0), to_robot_deg);
  if (figure.walks_s < 0.0)
    return text + fmt::format("{{ at_m = [{:.2f}, {:.2f}, 0.0], wait_s = 1000.0, heading_deg = 0.0 }}]\n",
                              figure.x_m + 0.02, figure.y_m);
  return text + fmt::format(
                    "{{ at_m = [{:.2f}, {:.2f}, 0.0], wait_s = {:.2f}, heading_deg = 0.0 }},\n{{ at_m = [{:.2f}, "
                    "{:.2f}, 0.0], speed_mps = {:.2f}, wait_s = 1000.0, heading_deg = 0.0 }}]\n",
                    figure.x_m + 0.02, figure.y_m, std::max(0.1, figure.walks_s - figure.turns_s), figure.x_m,
                    figure.to_y_m, figure.speed_mps);
}

/// From when on the script says that a person, or nobody, is visible. Ends with the next.
struct Phase {
  double from_s = 0.0;
  int number = 1;        // 0: nothing is asked of the robot
  double grace_s = 0.0;  // after which a wrong name is an error
};

struct Case {
  std::string name;
  std::vector<int> identities;  // enrolled, the first is number 1
  std::vector<Figure> figures;
  std::vector<Phase> phases;
  double ends_s = 0.0;
  std::string lamp;  // more keys of the ceiling lamp
  bool white_wall = false;
};

/// What every case draws: two people with shirts.
struct Pair {
  std::vector<int> identities;
  std::array<Figure, 2> people;
};

Pair draw_pair(Random& random) {
  Pair pair;
  std::array<int, sim::kIdentities> all{};
  std::iota(all.begin(), all.end(), 0);
  for (std::size_t i = all.size(); i-- > 1;)
    std::swap(all[i], all[static_cast<std::size_t>(random.below(static_cast<int>(i) + 1))]);
  pair.identities.assign(all.begin(), all.begin() + 4);
  for (std::size_t i = 0; i < 2; ++i) {
    Figure& person = pair.people[i];
    person.identity = all[i];
    person.height_m = random.uniform(1.62, 1.82);
    person.shirt = draw_vivid_shirt(random);
    person.x_m = 2.3 + random.uniform(-0.2, 0.2);
    person.y_m = random.uniform(-0.2, 0.2);
  }
  // Two shirts of one colour cannot be told: one of them is of the complementary kind.
  const Shirt& first = pair.people[0].shirt;
  Shirt& second = pair.people[1].shirt;
  double apart = 0.0;
  for (std::size_t i = 0; i < 3; ++i) apart = std::max(apart, std::abs(first[i] - second[i]));
  if (apart < 0.4) second = {first[2], first[0], first[1]};
  return pair;
}

constexpr double at(double script_s) {
  return kTraining_s + script_s;
}

Case exchanged_shirts(Random& random) {
  const Pair pair = draw_pair(random);
  Case one{"shirts exchanged", pair.identities, {}, {}, 15.0, "", false};
  Figure first = pair.people[0], second = pair.people[1];
  first.to_s = at(1.0);
  second.from_s = at(1.5), second.to_s = at(4.5);
  Figure again = first, other = second;
  again.shirt = second.shirt, again.from_s = at(5.0), again.to_s = at(9.5), again.turns_s = at(7.5);
  other.shirt = first.shirt, other.from_s = at(10.0), other.to_s = 1000.0, other.turns_s = at(12.5);
  one.figures = {first, second, again, other};
  one.phases = {{0.0, 1, 0.0},       {1.0, 0, 0.0}, {1.5, 2, kToFace_s}, {4.5, 0, 0.0},
                {5.0, 1, kToFace_s}, {9.5, 0, 0.0}, {10.0, 2, kToFace_s}};
  return one;
}

Case white_shirt(Random& random) {
  Pair pair = draw_pair(random);
  Case one{"white shirt before a white wall", pair.identities, {}, {{0.0, 1, 0.0}}, 12.0, "", true};
  Figure& person = pair.people[0];
  const double grey = random.uniform(0.85, 0.95);
  person.shirt = {grey, grey, grey - 0.02};
  person.x_m += 0.4;
  person.turns_s = at(3.0), person.to_s = at(8.0);
  Figure again = person;
  again.from_s = at(8.0), again.to_s = 1000.0, again.turns_s = 1000.0;
  one.figures = {person, again};
  return one;
}

Case changing_light(Random& random) {
  const Pair pair = draw_pair(random);
  Case one{"light changed by two", pair.identities, {pair.people[0]}, {{0.0, 1, 0.0}}, 12.0, "", false};
  one.figures[0].turns_s = at(3.0);
  Shirt factor{};
  for (double& channel : factor) channel = random.uniform(0.5, 0.8);
  factor[static_cast<std::size_t>(random.below(3))] = 0.5;
  const double ramp_s = random.uniform(0.0, 1.0) < 0.5 ? 0.05 : 2.0;  // switched, or dimmed
  one.lamp = fmt::format(
      "[[lamp.script]]\nat_s = {:.2f}\nfactor = [1.0, 1.0, 1.0]\n[[lamp.script]]\nat_s = {:.2f}\nfactor = [{:.2f}, "
      "{:.2f}, {:.2f}]\n",
      at(6.0), at(6.0) + ramp_s, factor[0], factor[1], factor[2]);
  return one;
}

Case crossing_people(Random& random) {
  Pair pair = draw_pair(random);
  Figure &first = pair.people[0], &second = pair.people[1];
  first.x_m = 2.9, first.y_m = 0.7, first.to_y_m = -0.7, first.turns_s = at(3.0), first.walks_s = at(5.0);
  second.x_m = 2.3, second.y_m = -0.6, second.to_y_m = 0.6, second.turns_s = at(2.5), second.walks_s = at(5.0);
  second.from_s = at(2.0);
  // Where the nearer covers the other neither can be asked for: their bearings are closer than a shoulder's width.
  const double walks_s = 1.4 / first.speed_mps;
  const double bearing_0 = 0.7 / (2.9 - kRobot_m), bearing_1 = -0.6 / (2.3 - kRobot_m);
  constexpr double kShoulders_rad = 0.32;
  const double apart = bearing_0 - bearing_1;  // goes to its negative while they walk
  const double meets_s = 5.0 + walks_s / 2.0, covered_s = walks_s * kShoulders_rad / (2.0 * apart) + 0.6;
  return {"two people cross",
          pair.identities,
          {first, second},
          {{0.0, 1, 0.0}, {meets_s - covered_s, 0, 0.0}, {meets_s + covered_s, 1, 0.0}},
          12.0,
          "",
          false};
}

Case dark_face(Random& random) {
  Pair pair = draw_pair(random);
  constexpr int kDarkest = sim::kIdentities - 1;
  for (int& identity : pair.identities)
    if (identity == kDarkest) identity = pair.identities.front();
  pair.identities.front() = kDarkest;
  Figure person = pair.people[0];
  person.identity = kDarkest;
  person.turns_s = at(4.0), person.to_s = at(7.0);
  Figure again = person;
  again.from_s = at(7.5), again.to_s = 1000.0, again.turns_s = 1000.0;
  const double factor = random.uniform(0.35, 0.5);
  return {"dark face in dim light",
          pair.identities,
          {person, again},
          {{0.0, 1, 0.0}, {7.0, 0, 0.0}, {7.5, 1, kToFace_s}},
          11.0,
          fmt::format("[[lamp.script]]\nat_s = 0.0\nfactor = [{0:.2f}, {0:.2f}, {0:.2f}]\n", factor),
          false};
}

constexpr std::array kCases{exchanged_shirts, white_shirt, changing_light, crossing_people, dark_face};

/// What was said of the images in which somebody is visible.
struct Counts {
  int images = 0, right = 0, wrong = 0, unsure = 0;
  int late = 0, late_wrong = 0;  // those in which only a face could tell, and had to be looked for
};

Counts count(const std::vector<Seen>& seen, const Case& one) {
  Counts counts;
  for (const Seen& image : seen) {
    if (image.time_s < 0.0) continue;
    const auto after =
        std::ranges::find_if(one.phases, [&](const Phase& phase) { return phase.from_s > image.time_s; });
    const Phase& phase = *std::prev(after);
    const double since_s = image.time_s - phase.from_s;
    if (phase.number == 0 || (phase.from_s > 0.0 && since_s < kAroundChange * kPeriod_s)) continue;
    const bool wrong = image.number >= 0 && image.number != phase.number;
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

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto found = text.find(what);
  if (found != std::string::npos) text.replace(found, what.size(), by);
  return text;
}

void write_scene(const TableFolder& folder, const std::string& arena, const Case& one) {
  std::string world = replaced(arena, "bounce = 0.006\n", "bounce = 0.006\n" + one.lamp);
  if (one.white_wall) world = replaced(world, "albedo = [0.62, 0.66, 0.68]", "albedo = [0.80, 0.80, 0.79]");
  for (std::size_t i = 0; i < one.figures.size(); ++i)
    world += text_of(one.figures[i], fmt::format("figure {}", i + 1));
  std::ofstream(folder / "world.toml") << world;
  std::ofstream(folder / "scenario.toml") << fmt::format(
      "world = \"world.toml\"\nrobot = \"robot\"\nends_at_s = {}\n[[line]]\nname = \"arming\"\ninput = true\n"
      "[[line]]\nname = \"face light\"\n",
      at(one.ends_s));
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
}

}  // namespace

Result<Report> people_cases(const Setting& setting) {
  const std::string shipped =
      setting.config_file.empty() ? source_path("config/robots/sim-people.toml") : setting.config_file;
  const TableFolder folder("people-cases");
  Portraits portraits(folder);
  const auto arena = empty_arena();
  if (!arena) return tl::unexpected(arena.error());
  std::array<std::vector<Counts>, kCases.size()> counts;
  std::array<std::string, kCases.size()> names;
  Report report;
  for (int trial = 0; trial < setting.trials; ++trial) {
    const std::uint64_t seed = setting.seed + static_cast<std::uint64_t>(trial);
    for (std::size_t i = 0; i < kCases.size(); ++i) {
      Random random(Random::mix(seed * kCases.size() + i));
      const Case one = kCases[i](random);
      names[i] = one.name;
      setting.progress(fmt::format("{}, {} of {}", one.name, trial + 1, setting.trials));
      std::filesystem::remove(folder / "identities");
      if (const auto enrolled = enroll_all(one.identities, portraits, folder / "identities"); !enrolled)
        return tl::unexpected(enrolled.error());
      write_scene(folder, *arena, one);
      const auto seen = watch(folder, shipped, seed, "", kTraining_s);
      if (!seen) return tl::unexpected(seen.error());
      counts[i].push_back(count(*seen, one));
    }
  }
  report.title = fmt::format("people who are hard to tell, {} variations of each case", setting.trials);
  for (std::size_t i = 0; i < kCases.size(); ++i) add_rows(names[i], counts[i], setting.seed, report);
  report.notes = {
      "Identities, shirts, heights, places and light are drawn by the seed; intervals are over variations. The robot "
      "has seen the person from the front for 3 s before.",
      fmt::format(
          "Left out: {} images after each change of the script, and those in which one person covers the other. "
          "After a return in another's shirt, or of a second person, only a face can tell: the first second is "
          "a row of its own.",
          kAroundChange)};
  return report;
}

}  // namespace cgsr::lab
