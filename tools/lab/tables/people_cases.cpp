// Where people are hard to tell (6.2.4, 6.3): exchanged shirts, a white shirt before a white wall, light that changes, two people who cross, a dark face in the dark. The robot stands and
// looks on; what it says of each image is compared with who is visible by truth.

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
#include "tools/lab/people_truth.h"
#include "tools/lab/person_cast.h"
#include "tools/lab/person_watch.h"
#include "tools/lab/scenes/random.h"
#include "tools/lab/source_path.h"
#include "tools/lab/tables/people_tables.h"

namespace cgsr::lab {
namespace {

constexpr double kPeriod_s = 1.0 / 30.0;
constexpr int kAroundChange = 5;  // images that are left out before and after a change

/// Who is visible in an image by truth: numbers of those enrolled.
struct Visible {
  bool first = false, second = false;
  friend bool operator==(const Visible&, const Visible&) = default;

  /// Who is to be named: the person asked for, or else the other one. 0: nobody.
  [[nodiscard]] int expected_number() const { return first ? 1 : second ? 2 : 0; }
};

/// What was said of the images in which somebody is visible, and of those in which nobody is.
struct Counts {
  int images = 0, right = 0, wrong = 0, unsure = 0;
  int late = 0, late_wrong = 0;  // those in which only a face could tell, and had to be looked for
  int left_out = 0, left_out_wrong = 0;
  int nobody = 0, nobody_named = 0;
  int scripted = 0, scripted_right = 0, scripted_wrong = 0;  // where the script alone says who is there
};

const Phase& phase_at(double time_s, const Case& one) {
  return *std::prev(std::ranges::find_if(one.phases, [&](const Phase& phase) { return phase.from_s > time_s; }));
}

void count_by_script(const Seen& image, const Phase& phase, Counts& counts) {
  const double since_s = image.time_s - phase.from_s;
  if (phase.number == 0 || (phase.from_s > 0.0 && since_s < kAroundChange * kPeriod_s) || since_s < phase.grace_s)
    return;
  ++counts.scripted;
  counts.scripted_right += image.number == phase.number ? 1 : 0;
  counts.scripted_wrong += image.number >= 0 && image.number != phase.number ? 1 : 0;
}

// Whether who is visible changes within a few images.
bool near_a_change(const std::vector<Visible>& visible, std::size_t image) {
  const std::size_t from = image > kAroundChange ? image - kAroundChange : 0;
  const std::size_t to = std::min(visible.size() - 1, image + kAroundChange);
  for (std::size_t i = from; i < to; ++i)
    if (visible[i] != visible[i + 1]) return true;
  return false;
}

Counts count(const std::vector<Seen>& seen, const std::vector<Visible>& visible, const Case& one) {
  Counts counts;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Seen& image = seen[i];
    if (image.time_s < 0.0) continue;
    const Phase& phase = phase_at(image.time_s, one);
    count_by_script(image, phase, counts);
    const int expected = visible[i].expected_number();
    const bool wrong = image.number >= 0 && image.number != expected;
    if (near_a_change(visible, i)) {
      ++counts.left_out;
      counts.left_out_wrong += expected != 0 && wrong ? 1 : 0;
    } else if (expected == 0) {
      ++counts.nobody;
      counts.nobody_named += wrong ? 1 : 0;
    } else if (image.time_s - phase.from_s < phase.grace_s) {
      ++counts.late;
      counts.late_wrong += wrong ? 1 : 0;
    } else {
      ++counts.images;
      counts.right += image.number == expected ? 1 : 0;
      counts.wrong += wrong ? 1 : 0;
      counts.unsure += image.unsure ? 1 : 0;
    }
  }
  return counts;
}

/// \return of each image who is visible, by truth.
Result<std::vector<Visible>> visible_in(const TableFolder& folder, const std::vector<Seen>& images, const Case& one) {
  auto truth = PeopleTruth::of(folder / "world.toml");
  if (!truth) return tl::unexpected(truth.error());
  std::vector<Visible> visible;
  for (const Seen& image : images) {
    const auto views = truth->at(image.time_s + kTraining_s);
    Visible& now = visible.emplace_back();
    for (std::size_t i = 0; i < views.size(); ++i)
      if (views[i].is_identifiable()) (one.figures[i].identity == one.identities[0] ? now.first : now.second) = true;
  }
  return visible;
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

void add_rows(const std::string& name, const std::vector<Counts>& casts, std::uint64_t seed, Report& report) {
  const auto add = [&](const char* quantity, int Counts::*part, int Counts::*whole) {
    std::vector<double> shares;
    for (const Counts& counts : casts)
      if (counts.*whole > 0) shares.push_back(static_cast<double>(counts.*part) / counts.*whole);
    if (!shares.empty()) report.rows.push_back(mean_row(name, quantity, "", shares, seed));
  };
  add("identified", &Counts::right, &Counts::images);
  add("taken for somebody else", &Counts::wrong, &Counts::images);
  add("unsure", &Counts::unsure, &Counts::images);
  add("somebody named where nobody is visible", &Counts::nobody_named, &Counts::nobody);
  add("identified, visible by the script", &Counts::scripted_right, &Counts::scripted);
  add("taken for somebody else, visible by the script", &Counts::scripted_wrong, &Counts::scripted);
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
      const auto visible = visible_in(folder, *seen, one);
      if (!visible) return tl::unexpected(visible.error());
      counts[i].push_back(count(*seen, *visible, one));
    }
  }
  report.title = fmt::format("people who are hard to tell, {} variations of each case", setting.trials);
  for (std::size_t i = 0; i < kPeopleCases; ++i) add_rows(names[i], counts[i], setting.seed, report);
  report.rows.push_back(plain_row("enrolment", "pairs drawn again because the second is refused as the first", "",
                                  redrawn, counts[0].size()));
  report.rows.push_back(photographed_again(portraits));
  report.notes = {
      "Identities, shirts, heights, places and light are drawn by the seed; intervals are over variations. The robot "
      "has seen the person from the front for 3 s before.",
      fmt::format("Visible: a quarter of the shirt, or of the head where it faces the camera within 30 degrees, as the "
                  "simulator knows it; "
                  "asked for is the person of interest, where he is not visible the other one. "
                  "Left out, and counted: {} images before and after each change of who is visible. "
                  "After a return in another's shirt, or of a second person, only a face can tell: the first second is "
                  "a row of its own. 'By the script': as this table counted before, without the images in which one "
                  "covers the other.",
                  kAroundChange),
      "The light changes by a factor of up to two, lamp and ambient light alike, in half of the variations to the "
      "brighter. In the "
      "dark the robot has to find the face of somebody of whom it knows nothing yet: with a light of its own, and, as "
      "the counterpart, without; 'a tenth' is what was called the dark before the detector's image was stretched."};
  return report;
}

}  // namespace cgsr::lab
