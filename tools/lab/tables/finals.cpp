// The Finals (6.4.3): the robot follows a person by face and shirt; a stranger in the same shirt takes the person's place, with the back to the robot, and
// turns round; the person is back in another shirt; and once more. What the robot says is compared with the script.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
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

constexpr double kToNotice_s = 1.0;   // a face: the figure turns round at once, in a tenth of a second
constexpr double kApart = 0.08;       // chromaticities of two shirts that are not the same
constexpr std::size_t kTimes = 2;     // that a stranger takes the person's place
constexpr std::size_t kEnrolled = 2;  // the person, and somebody who never comes
constexpr double kWalking_s = 4.0, kBack_s = 3.0, kFront_s = 4.0, kSearch_s = 32.0, kAgain_s = 3.0, kGap_s = 0.4;

using Shirt = std::array<double, 3>;

/// A stranger takes the person's place, and the person comes back.
struct Exchange {
  double stranger_from_s = 0.0, face_s = 0.0, stranger_to_s = 0.0;  // face_s: he turns round
  double person_from_s = 0.0, person_turns_s = 0.0;
  bool other_shirt = false;
};

/// What happens in one run.
struct Story {
  std::vector<int> enrolled;
  std::vector<Figure> figures;
  std::array<Exchange, kTimes> exchanges{};
  double ends_s = 0.0;
  std::string lamp;
};

double chroma_distance(const Shirt& a, const Shirt& b) {
  const double sum_a = a[0] + a[1] + a[2], sum_b = b[0] + b[1] + b[2];
  return std::hypot(a[0] / sum_a - b[0] / sum_b, a[1] / sum_a - b[1] / sum_b);
}

Shirt other_shirt(const Shirt& shirt, Random& random) {
  Shirt other = draw_vivid_shirt(random);
  while (chroma_distance(shirt, other) < kApart) other = draw_vivid_shirt(random);
  return other;
}

/// The person from the front, then walking with the back to the robot.
Figure walking(Figure person, double from_s, double turns_s, double to_x_m, double to_y_m) {
  person.from_s = from_s, person.turns_s = turns_s, person.to_s = turns_s + kWalking_s;
  person.walks_s = turns_s + 0.5, person.to_x_m = to_x_m, person.to_y_m = to_y_m;
  return person;
}

Story draw_story(Random& random) {
  const std::vector<int> all = draw_people(kEnrolled + kTimes, random);
  Story story;
  story.enrolled.assign(all.begin(), all.begin() + kEnrolled);
  story.lamp = fmt::format("[[lamp.script]]\nat_s = 0.0\nfactor = [{:.2f}, {:.2f}, {:.2f}]\n", random.uniform(0.8, 1.1),
                           random.uniform(0.8, 1.1), random.uniform(0.8, 1.1));
  Figure person{.identity = all[0], .height_m = random.uniform(1.62, 1.82), .shirt = draw_vivid_shirt(random)};
  person.x_m = 2.5 + random.uniform(-0.2, 0.2);
  double side = random.uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
  person.y_m = -side * random.uniform(0.2, 0.5);
  double turns_s = kTraining_s + 1.0, from_s = 0.0;
  for (std::size_t i = 0; i < kTimes; ++i) {
    Exchange& exchange = story.exchanges[i];
    const double to_x_m = person.x_m + random.uniform(0.3, 0.9), to_y_m = side * random.uniform(0.0, 0.6);
    const Figure walks = walking(person, from_s, turns_s, to_x_m, to_y_m);
    Figure stranger{.identity = all[kEnrolled + i], .height_m = random.uniform(1.62, 1.82), .shirt = person.shirt};
    stranger.x_m = to_x_m, stranger.y_m = to_y_m;
    stranger.from_s = exchange.stranger_from_s = walks.to_s;
    stranger.faces_s = exchange.face_s = stranger.from_s + kBack_s;
    stranger.to_s = exchange.stranger_to_s = exchange.face_s + kFront_s;
    story.figures.insert(story.figures.end(), {walks, stranger});
    exchange.other_shirt = i == 0 || random.uniform(0.0, 1.0) < 0.5;
    if (exchange.other_shirt) person.shirt = other_shirt(person.shirt, random);
    side = -side;
    person.x_m = to_x_m + random.uniform(-0.2, 0.2);
    person.y_m = -side * random.uniform(0.0, 1.0);
    from_s = exchange.person_from_s = stranger.to_s + kGap_s;
    turns_s = exchange.person_turns_s = from_s + kSearch_s + kAgain_s;
  }
  person.from_s = from_s;
  story.figures.push_back(person);
  story.ends_s = story.exchanges.back().person_turns_s;
  return story;
}

/// What was said of one exchange.
struct Said {
  std::optional<double> noticed_after_s, found_after_s;
  std::optional<bool> other_shirt;

  [[nodiscard]] bool right(const Exchange& exchange) const {
    return noticed_after_s && *noticed_after_s <= kToNotice_s && found_after_s && other_shirt == exchange.other_shirt;
  }
};

struct Told {
  std::array<Said, kTimes> exchanges{};
  int out_of_place = 0;  // said too early, too late, twice or of the wrong person
  bool right = false;
  double driven_m = 0.0;
};

constexpr std::string_view kStranger = "you are somebody else", kAgain = "I have found you again",
                           kOther = "you wear another shirt", kSame = "you wear the same shirt", kKnown = "I know you";

/// \return the exchange that goes on at that time; nothing: the person alone was there so far.
std::optional<std::size_t> exchange_at(const Story& story, double at_s) {
  for (std::size_t i = kTimes; i-- > 0;)
    if (at_s >= story.exchanges[i].stranger_from_s) return i;
  return std::nullopt;
}

/// Each thing is said once, in its order: the stranger noticed while he is there and shows his face, the person found and then the shirt spoken of while
/// the person is there. \return whether it was in its place.
bool note(const std::string& words, double at_s, const Story& story, Told& told) {
  const auto number = exchange_at(story, at_s);
  if (!number) return words.starts_with(kKnown);
  const Exchange& exchange = story.exchanges[*number];
  Said& said = told.exchanges[*number];
  const bool person_there = at_s >= exchange.person_from_s;
  if (words.starts_with(kStranger) && !said.noticed_after_s && !person_there && at_s >= exchange.face_s) {
    said.noticed_after_s = at_s - exchange.face_s;
    return true;
  }
  if (words.starts_with(kAgain) && said.noticed_after_s && !said.found_after_s && person_there) {
    said.found_after_s = at_s - exchange.person_from_s;
    return true;
  }
  if ((words == kOther || words == kSame) && said.found_after_s && !said.other_shirt && person_there) {
    said.other_shirt = words == kOther;
    return true;
  }
  return false;
}

Result<Told> watch_story(const TableFolder& folder, const std::string& shipped, std::uint64_t seed, const Story& story,
                         const std::optional<std::filesystem::path>& videos) {
  std::vector<std::string> film;
  if (videos) {
    std::filesystem::create_directories(*videos);
    film = {"--video", (*videos / fmt::format("finals-{}.mkv", seed)).string()};
  }
  const auto run = run_with_people(folder, shipped, seed, film);
  if (!run) return tl::unexpected(run.error());
  Told told;
  for (const auto& event : run->at("events")) {
    if (event.at("source") != "says") continue;
    told.out_of_place += note(event.at("state"), event.at("at_s"), story, told) ? 0 : 1;
  }
  const auto& odometry = run->at("motion").at("odometry");
  told.driven_m = std::hypot(odometry.at(0).get<double>(), odometry.at(1).get<double>());
  told.right = told.out_of_place == 0;
  for (std::size_t i = 0; i < kTimes; ++i) told.right = told.right && told.exchanges[i].right(story.exchanges[i]);
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
  for (std::size_t i = 0; i < kTimes; ++i) {
    const Said& said = told.exchanges[i];
    text +=
        fmt::format(" stranger {} {}, person {}, shirt {};", i + 1,
                    said.noticed_after_s ? fmt::format("noticed after {:.2f} s", *said.noticed_after_s) : "not noticed",
                    said.found_after_s ? fmt::format("found after {:.1f} s", *said.found_after_s) : "not found",
                    !said.other_shirt                                     ? "not spoken of"
                    : *said.other_shirt == story.exchanges[i].other_shirt ? "right"
                                                                          : "wrong");
  }
  return text + fmt::format(" said out of place {} times.", told.out_of_place);
}

void add_rows(const std::vector<Story>& stories, const std::vector<Told>& runs, std::uint64_t seed, Report& report) {
  const int exchanges = static_cast<int>(runs.size() * kTimes);
  int right = 0, noticed = 0, found = 0, shirts = 0, out_of_place = 0;
  std::vector<double> notice_s, find_s, driven_m;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    right += runs[run].right ? 1 : 0;
    out_of_place += runs[run].out_of_place;
    driven_m.push_back(runs[run].driven_m);
    for (std::size_t i = 0; i < kTimes; ++i) {
      const Said& said = runs[run].exchanges[i];
      noticed += said.noticed_after_s && *said.noticed_after_s <= kToNotice_s ? 1 : 0;
      found += said.found_after_s ? 1 : 0;
      shirts += said.other_shirt == stories[run].exchanges[i].other_shirt ? 1 : 0;
      if (said.noticed_after_s) notice_s.push_back(*said.noticed_after_s);
      if (said.found_after_s) find_s.push_back(*said.found_after_s);
    }
  }
  report.rows.push_back(share_row("all of it", "right", right, static_cast<int>(runs.size())));
  report.rows.push_back(share_row("strangers", "noticed within 1 s of their face", noticed, exchanges));
  report.rows.push_back(mean_row("strangers", "noticed after", "s", notice_s, seed));
  report.rows.push_back(share_row("person", "found again", found, exchanges));
  report.rows.push_back(mean_row("person", "found after", "s", find_s, seed));
  report.rows.push_back(share_row("shirt", "rightly said to be the same or another", shirts, exchanges));
  report.rows.push_back(plain_row("all of it", "said out of place", "", out_of_place, runs.size()));
  report.rows.push_back(mean_row("all of it", "driven, from begin to end in a line", "m", driven_m, seed));
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
  report.rows.push_back(photographed_again(portraits));
  report.notes = {
      "Who is who, shirts, heights, ways, places and the lamp's colour are drawn by the seed; the robot drives. Twice "
      "a "
      "stranger in the person's shirt, with the back to the robot, takes the person's place and turns round after 3 s; "
      "then the person is back somewhere else, the first time in another shirt, the second time in another or the "
      "same.",
      fmt::format(
          "Right: both strangers are noticed within {} s of turning round, the person is found again both times, "
          "the shirt is spoken of rightly, and nothing else is said. Shirts are vivid, and those that are not "
          "the same differ by {} in chromaticity at least.",
          kToNotice_s, kApart),
      "With --videos FOLDER every run leaves its film there."};
  report.notes.insert(report.notes.end(), wrong.begin(), wrong.end());
  return report;
}

}  // namespace cgsr::lab
