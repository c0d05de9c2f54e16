// The Finals (6.4.3): the robot follows a person by face and shirt; a stranger in the same shirt takes the person's place, with the back to the robot, and
// turns round; the person is back in another shirt; and once more. What the robot says is compared with the script.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/sim/people/person.h"
#include "tools/lab/child.h"
#include "tools/lab/experiment.h"
#include "tools/lab/people_script.h"
#include "tools/lab/person_cast.h"
#include "tools/lab/person_watch.h"
#include "tools/lab/scenes/random.h"
#include "tools/lab/source_path.h"
#include "tools/lab/tables/people_tables.h"

namespace cgsr::lab {
namespace {

constexpr double kTurning_s = 1.3;    // from the back to the front, until the face is within 20 degrees
constexpr double kToNotice_s = 1.0;   // of a stranger's face
constexpr double kApart = 0.12;       // chromaticities of two shirts that are not the same
constexpr std::size_t kPassings = 2;  // a stranger takes the person's place
constexpr std::size_t kEnrolled = 2;  // the person, and somebody who never comes
constexpr double kWalking_s = 4.0, kBack_s = 3.0, kFront_s = 3.0, kSearch_s = 14.0, kAgain_s = 3.0, kGap_s = 0.4;

using Shirt = std::array<double, 3>;

/// A stranger takes the person's place, and the person comes back.
struct Passing {
  double stranger_from_s = 0.0, face_s = 0.0, stranger_to_s = 0.0;  // face_s: it can be seen from then on
  double person_from_s = 0.0, person_turns_s = 0.0;
  bool other_shirt = false;
};

/// What happens in one run.
struct Story {
  std::vector<int> enrolled;
  std::vector<Figure> figures;
  std::array<Passing, kPassings> passings{};
  double ends_s = 0.0;
  std::string lamp;
};

double chroma_distance(const Shirt& a, const Shirt& b) {
  const double sum_a = a[0] + a[1] + a[2], sum_b = b[0] + b[1] + b[2];
  return std::hypot(a[0] / sum_a - b[0] / sum_b, a[1] / sum_a - b[1] / sum_b);
}

Shirt other_shirt(const Shirt& shirt, Random& random) {
  Shirt other = draw_vivid_shirt(random);
  for (int i = 0; i < 100 && chroma_distance(shirt, other) < kApart; ++i) other = draw_vivid_shirt(random);
  return other;
}

/// The person from the front, then walking with the back to the robot.
Figure walking(Figure person, double from_s, double turns_s, double to_y_m) {
  person.from_s = from_s, person.turns_s = turns_s, person.to_s = turns_s + kWalking_s;
  person.walks_s = turns_s + 0.5, person.to_y_m = to_y_m;
  return person;
}

Story draw_story(Random& random) {
  std::array<int, sim::kIdentities> all{};
  std::iota(all.begin(), all.end(), 0);
  for (std::size_t i = all.size(); i-- > 1;)
    std::swap(all[i], all[static_cast<std::size_t>(random.below(static_cast<int>(i) + 1))]);
  Story story;
  story.enrolled.assign(all.begin(), all.begin() + kEnrolled);
  story.lamp = fmt::format("[[lamp.script]]\nat_s = 0.0\nfactor = [{:.2f}, {:.2f}, {:.2f}]\n", random.uniform(0.8, 1.1),
                           random.uniform(0.8, 1.1), random.uniform(0.8, 1.1));
  Figure person{.identity = all[0], .height_m = random.uniform(1.62, 1.82), .shirt = draw_vivid_shirt(random)};
  person.x_m = 2.5 + random.uniform(-0.2, 0.2);
  double side = random.uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
  person.y_m = -side * random.uniform(0.2, 0.5);
  double turns_s = kTraining_s + 1.0, from_s = 0.0;
  for (std::size_t i = 0; i < kPassings; ++i) {
    Passing& passing = story.passings[i];
    const double to_y_m = side * random.uniform(0.1, 0.5);
    const Figure walks = walking(person, from_s, turns_s, to_y_m);
    Figure stranger{.identity = all[kEnrolled + i], .height_m = random.uniform(1.62, 1.82), .shirt = person.shirt};
    stranger.x_m = person.x_m, stranger.y_m = to_y_m;
    stranger.from_s = passing.stranger_from_s = walks.to_s;
    stranger.faces_s = stranger.from_s + kBack_s;
    passing.face_s = stranger.faces_s + kTurning_s;
    stranger.to_s = passing.stranger_to_s = passing.face_s + kFront_s;
    story.figures.insert(story.figures.end(), {walks, stranger});
    passing.other_shirt = i == 0 || random.uniform(0.0, 1.0) < 0.5;
    if (passing.other_shirt) person.shirt = other_shirt(person.shirt, random);
    side = -side;
    person.y_m = -side * random.uniform(0.2, 0.6);
    from_s = passing.person_from_s = stranger.to_s + kGap_s;
    turns_s = passing.person_turns_s = from_s + kSearch_s + kAgain_s;
  }
  person.from_s = from_s;
  story.figures.push_back(person);
  story.ends_s = story.passings.back().person_turns_s;
  return story;
}

/// What was said of one passing.
struct Said {
  std::optional<double> noticed_after_s, found_after_s;
  bool noticed_early = false;  // of a stranger's face that cannot be seen yet
  std::optional<bool> other_shirt;

  [[nodiscard]] bool right(const Passing& passing) const {
    return noticed_after_s && *noticed_after_s <= kToNotice_s && !noticed_early && found_after_s &&
           other_shirt == passing.other_shirt;
  }
};

struct Told {
  std::array<Said, kPassings> passings{};
  int wrong = 0;  // the person called somebody else, a stranger taken for the person found again
  bool right = false;
};

constexpr std::string_view kStranger = "you are somebody else", kAgain = "I have found you again",
                           kOther = "you wear another shirt", kSame = "you wear the same shirt";

void hear(const std::string& words, double at_s, const Story& story, Told& told) {
  for (std::size_t i = kPassings; i-- > 0;) {
    const Passing& passing = story.passings[i];
    Said& said = told.passings[i];
    if (at_s < passing.stranger_from_s) continue;
    const bool of_stranger = at_s < passing.stranger_to_s + kGap_s;
    if (words.starts_with(kStranger)) {
      if (!of_stranger || said.noticed_after_s)
        ++told.wrong;
      else
        said.noticed_after_s = std::max(0.0, at_s - passing.face_s),
        said.noticed_early = at_s < passing.face_s - kTurning_s;
    } else if (words.starts_with(kAgain)) {
      if (of_stranger)
        ++told.wrong;
      else if (!said.found_after_s)
        said.found_after_s = at_s - passing.person_from_s;
    } else if (words == kOther || words == kSame) {
      if (!said.other_shirt) said.other_shirt = words == kOther;
    }
    return;
  }
  if (words.starts_with(kStranger) || words.starts_with(kAgain)) ++told.wrong;
}

Result<Told> watch_story(const TableFolder& folder, const std::string& shipped, std::uint64_t seed, const Story& story,
                         const std::optional<std::filesystem::path>& videos) {
  const auto robot = folder / "robot.toml";
  std::ofstream(robot) << fmt::format(
      "extends = \"{}\"\nsim.scenario = \"scenario.toml\"\nperson.identities = \"identities\"\n",
      std::filesystem::absolute(shipped).string());
  const auto json = scratch_json();
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "cgsr";
  std::vector<std::string> words{
      program.string(), "run",     "--config", robot.string(), "--seed", std::to_string(seed),
      "--log-level",    "warning", "--json",   json.string(),  "--force"};
  if (videos) {
    std::filesystem::create_directories(*videos);
    words.insert(words.end(), {"--video", (*videos / fmt::format("finals-{}.mkv", seed)).string()});
  }
  const auto run = run_for_json(words, json);
  if (!run) return tl::unexpected(run.error());
  Told told;
  for (const auto& event : run->at("events"))
    if (event.at("source") == "says") hear(event.at("state"), event.at("at_s"), story, told);
  told.right = told.wrong == 0;
  for (std::size_t i = 0; i < kPassings; ++i) told.right = told.right && told.passings[i].right(story.passings[i]);
  return told;
}

void write_story(const TableFolder& folder, std::string world, const Story& story) {
  constexpr std::string_view kLamp = "bounce = 0.006\n";
  if (const auto lamp = world.find(kLamp); lamp != std::string::npos) world.insert(lamp + kLamp.size(), story.lamp);
  for (std::size_t i = 0; i < story.figures.size(); ++i)
    world += text_of(story.figures[i], fmt::format("figure {}", i + 1));
  std::ofstream(folder / "world.toml") << world;
  std::ofstream(folder / "scenario.toml") << fmt::format(
      "world = \"world.toml\"\nrobot = \"robot\"\nends_at_s = {}\n[[line]]\nname = \"arming\"\ninput = true\n"
      "[[line]]\nname = \"face light\"\n[[line_event]]\nwhat = \"pressed\"\nline = \"arming\"\nfrom_s = 1.5\n",
      story.ends_s);
}

/// Two of the cast who look so much alike that the second is refused are drawn again, as in people-cases.
Result<std::pair<Story, int>> draw_enrolled(const TableFolder& folder, Portraits& portraits, std::uint64_t seed) {
  constexpr int kAtMost = 10;
  Random random(Random::mix(seed));
  for (int again = 0; again < kAtMost; ++again) {
    Story story = draw_story(random);
    std::filesystem::remove(folder / "identities");
    const auto refused = enroll_all(story.enrolled, portraits, folder / "identities");
    if (!refused) return tl::unexpected(refused.error());
    if (*refused == 0) return std::pair(std::move(story), again);
  }
  return fail(fmt::format("finals: no two of {} draws with seed {} are told apart by their faces", kAtMost, seed));
}

/// A run in which something went wrong, for whoever wants to look at it.
std::string describe(std::uint64_t seed, const Story& story, const Told& told) {
  std::string text = fmt::format("Seed {}:", seed);
  for (std::size_t i = 0; i < kPassings; ++i) {
    const Said& said = told.passings[i];
    text +=
        fmt::format(" stranger {} {}, person {}, shirt {};", i + 1,
                    said.noticed_after_s ? fmt::format("noticed after {:.2f} s", *said.noticed_after_s) : "not noticed",
                    said.found_after_s ? fmt::format("found after {:.1f} s", *said.found_after_s) : "not found",
                    !said.other_shirt                                    ? "not spoken of"
                    : *said.other_shirt == story.passings[i].other_shirt ? "right"
                                                                         : "wrong");
  }
  return text + fmt::format(" said wrongly {} times.", told.wrong);
}

void add_rows(const std::vector<Story>& stories, const std::vector<Told>& runs, std::uint64_t seed, Report& report) {
  const int passings = static_cast<int>(runs.size() * kPassings);
  int right = 0, noticed = 0, found = 0, shirts = 0, wrong = 0;
  std::vector<double> notice_s, find_s;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    right += runs[run].right ? 1 : 0;
    wrong += runs[run].wrong;
    for (std::size_t i = 0; i < kPassings; ++i) {
      const Said& said = runs[run].passings[i];
      noticed += said.noticed_after_s && *said.noticed_after_s <= kToNotice_s ? 1 : 0;
      found += said.found_after_s ? 1 : 0;
      shirts += said.other_shirt == stories[run].passings[i].other_shirt ? 1 : 0;
      if (said.noticed_after_s) notice_s.push_back(*said.noticed_after_s);
      if (said.found_after_s) find_s.push_back(*said.found_after_s);
    }
  }
  report.rows.push_back(share_row("all of it", "right", right, static_cast<int>(runs.size())));
  report.rows.push_back(share_row("strangers", "noticed within 1 s of their face", noticed, passings));
  report.rows.push_back(mean_row("strangers", "noticed after", "s", notice_s, seed));
  report.rows.push_back(share_row("person", "found again", found, passings));
  report.rows.push_back(mean_row("person", "found after", "s", find_s, seed));
  report.rows.push_back(share_row("shirt", "rightly said to be the same or another", shirts, passings));
  report.rows.push_back(plain_row("person or stranger", "taken for the other aloud", "", wrong, runs.size()));
}

}  // namespace

Result<Report> finals(const Setting& setting) {
  const std::string shipped =
      setting.config_file.empty() ? source_path("config/robots/sim-people-finals.toml") : setting.config_file;
  const TableFolder folder("finals");
  Portraits portraits(folder);
  const auto arena = empty_arena();
  if (!arena) return tl::unexpected(arena.error());
  Report report;
  std::vector<Story> stories;
  std::vector<Told> runs;
  std::vector<std::string> wrong;
  int redrawn = 0;
  for (int i = 0; i < setting.trials; ++i) {
    setting.progress(fmt::format("finals, run {} of {}", i + 1, setting.trials));
    const std::uint64_t seed = setting.seed + static_cast<std::uint64_t>(i);
    auto drawn = draw_enrolled(folder, portraits, seed);
    if (!drawn) return tl::unexpected(drawn.error());
    redrawn += drawn->second;
    write_story(folder, *arena, drawn->first);
    auto told = watch_story(folder, shipped, seed, drawn->first, setting.videos);
    if (!told) return tl::unexpected(told.error());
    if (!told->right) wrong.push_back(describe(seed, drawn->first, *told));
    stories.push_back(std::move(drawn->first));
    runs.push_back(*told);
  }
  report.title = fmt::format("the Finals, {} runs", setting.trials);
  add_rows(stories, runs, setting.seed, report);
  report.rows.push_back(
      plain_row("enrolment", "pairs drawn again because the second is refused as the first", "", redrawn, runs.size()));
  report.notes = {
      "Who is who, shirts, heights, places and the lamp's colour are drawn by the seed; the robot drives. Twice a "
      "stranger in the person's shirt, with the back to the robot, takes the person's place and turns round after 3 s; "
      "then the person is back, the first time in another shirt, the second time in another or the same.",
      fmt::format(
          "Right: both strangers are noticed within {} s of their face (from 20 degrees on), the person is found "
          "again both times and the shirt is spoken of rightly. Shirts that are not the same differ by {} in "
          "chromaticity.",
          kToNotice_s, kApart),
      "With --videos FOLDER every run leaves its film there."};
  report.notes.insert(report.notes.end(), wrong.begin(), wrong.end());
  return report;
}

}  // namespace cgsr::lab
