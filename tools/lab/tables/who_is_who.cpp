// Who Is Who in a line (6.4.1.2): four people who are enrolled and one who is not stand side by side; the robot turns along the line and tells who is who.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/lab/experiment.h"
#include "tools/lab/person_cast.h"
#include "tools/lab/scenes/random.h"
#include "tools/lab/source_path.h"
#include "tools/lab/tables/people_tables.h"

namespace cgsr::lab {
namespace {

constexpr std::size_t kKnown = 4, kPeople = 5;
constexpr double kRobot_m = 0.8;  // where the arena's robot stands
constexpr double kSpacing_m = 0.7;
constexpr int kNothing = -1;

/// Five people in a line, from left to right; who is enrolled has his number, the stranger 0.
struct Line {
  std::vector<int> enrolled;           // identities, the first is number 1
  std::array<int, kPeople> numbers{};  // from the left
  std::string people;                  // as the world's file has them
};

Line draw_line(std::uint64_t seed) {
  Random random(Random::mix(seed));
  const std::vector<int> all = draw_people(kPeople, random);
  const auto shuffle = [&random](auto& values) {
    for (std::size_t i = values.size(); i-- > 1;)
      std::swap(values[i], values[static_cast<std::size_t>(random.below(static_cast<int>(i) + 1))]);
  };
  Line line;
  line.enrolled.assign(all.begin(), all.begin() + kKnown);
  std::iota(line.numbers.begin(), line.numbers.end(), 0);
  shuffle(line.numbers);
  for (std::size_t i = 0; i < kPeople; ++i) {
    const int number = line.numbers[i];
    const int identity = all[number == 0 ? kKnown : static_cast<std::size_t>(number - 1)];
    const double x_m = 2.5 + random.uniform(-0.1, 0.1);
    const double y_m = kSpacing_m * (2.0 - static_cast<double>(i)) + random.uniform(-0.05, 0.05);
    const double to_robot_deg = 180.0 + std::atan2(y_m, x_m - kRobot_m) * 180.0 / std::numbers::pi;
    const double yaw_deg = random.uniform(3.0, 10.0);
    line.people += fmt::format(
        "[[person]]\nname = \"place {}\"\nidentity = {}\nheight_m = {:.2f}\n"
        "walk = {{ stop = [{{ at_m = [{:.2f}, {:.2f}, 0.0], heading_deg = {:.1f} }}] }}\n"
        "head = [{{ at_s = 0.0, yaw_deg = {:.1f} }}, {{ at_s = 8.0, yaw_deg = {:.1f} }}, {{ at_s = 16.0, yaw_deg = "
        "{:.1f} "
        "}}, {{ at_s = 24.0, yaw_deg = {:.1f} }}]\n",
        i + 1, identity, random.uniform(1.62, 1.82), x_m, y_m, to_robot_deg + random.uniform(-5.0, 5.0), yaw_deg,
        -yaw_deg, yaw_deg, -yaw_deg);
  }
  return line;
}

/// What the robot said of one line.
struct Told {
  int right = 0, known_as_stranger = 0, known_as_other = 0, known_unseen = 0;
  bool stranger_as_known = false, stranger_unseen = false;
  bool taken_for_another = false;   // somebody, at enrolment
  int too_many = 0;                 // told of where nobody stands
  std::array<int, kPeople> said{};  // from the left; kNothing: nothing was told of the place
};

/// \return the place of the line whose bearing is nearest, from the left.
std::size_t place_at(double bearing_deg) {
  std::size_t nearest = 0;
  double least = 1e9;
  for (std::size_t i = 0; i < kPeople; ++i) {
    const double y_m = kSpacing_m * (2.0 - static_cast<double>(i));
    const double off = std::abs(std::atan2(y_m, 2.5 - kRobot_m) * 180.0 / std::numbers::pi - bearing_deg);
    if (off < least) nearest = i, least = off;
  }
  return nearest;
}

Told compare(const Line& line, const nlohmann::json& run) {
  Told told;
  auto& said = told.said;
  said.fill(kNothing);
  for (const auto& event : run.at("events")) {
    if (event.at("source") != "says") continue;
    const auto& numbers = event.at("numbers");
    int& place = said[place_at(numbers.at("bearing").get<double>())];
    told.too_many += place != kNothing ? 1 : 0;
    if (place == kNothing) place = numbers.value("number", 0);
  }
  for (std::size_t i = 0; i < kPeople; ++i) {
    const int is = line.numbers[i];
    told.right += said[i] == is ? 1 : 0;
    if (is == 0) {
      told.stranger_as_known = said[i] > 0;
      told.stranger_unseen = said[i] == kNothing;
    } else {
      told.known_as_stranger += said[i] == 0 ? 1 : 0;
      told.known_as_other += said[i] > 0 && said[i] != is ? 1 : 0;
      told.known_unseen += said[i] == kNothing ? 1 : 0;
    }
  }
  return told;
}

Result<Told> look_along(const TableFolder& folder, const std::string& shipped, std::uint64_t seed, const Line& line) {
  const auto run = run_with_people(folder, shipped, seed);
  if (!run) return tl::unexpected(run.error());
  return compare(line, *run);
}

/// A line of which something wrong was told, for whoever wants to look at it.
std::string describe(std::uint64_t seed, const Line& line, const Told& told) {
  const auto words = [](const std::array<int, kPeople>& numbers) {
    std::string all;
    for (const int number : numbers)
      all += number == kNothing ? " -" : number == 0 ? " stranger" : fmt::format(" {}", number);
    return all;
  };
  return fmt::format("Seed {}: there stand{}; told was{}.", seed, words(line.numbers), words(told.said));
}

void add_rows(const std::vector<Told>& lines, std::uint64_t seed, Report& report) {
  const int count = static_cast<int>(lines.size());
  std::vector<double> right, strict;
  int too_many = 0, strangers = 0, strangers_unseen = 0;
  for (const Told& told : lines) {
    right.push_back(told.right);
    strict.push_back(told.taken_for_another ? 0 : told.right);
    too_many += told.too_many;
    strangers += told.stranger_as_known ? 1 : 0;
    strangers_unseen += told.stranger_unseen ? 1 : 0;
  }
  const auto add_known = [&](const char* quantity, int Told::*of_cast) {
    std::vector<double> shares;
    shares.reserve(lines.size());
    for (const Told& told : lines) shares.push_back(told.*of_cast / static_cast<double>(kKnown));
    report.rows.push_back(mean_row("in a line", quantity, "", shares, seed));
  };
  report.rows.push_back(mean_row("in a line", "right of five", "", right, seed));
  // Without the operator who enrols people who look alike the numbers of that line are others'.
  report.rows.push_back(
      mean_row("in a line", "right of five, none where somebody is taken for another at enrolment", "", strict, seed));
  report.rows.push_back(share_row("in a line", "stranger named as a known person", strangers, count));
  add_known("known person called a stranger", &Told::known_as_stranger);
  add_known("known person named as another", &Told::known_as_other);
  add_known("known person not noticed", &Told::known_unseen);
  report.rows.push_back(share_row("in a line", "stranger not noticed", strangers_unseen, count));
  report.rows.push_back(plain_row("in a line", "told of twice", "", too_many, lines.size()));
}

}  // namespace

Result<Report> who_is_who(const Setting& setting) {
  const std::string shipped =
      setting.config_file.empty() ? source_path("config/robots/sim-people-line.toml") : setting.config_file;
  const TableFolder folder("who-is-who");
  Portraits portraits(folder);
  const auto arena = empty_arena();
  if (!arena) return tl::unexpected(arena.error());
  Report report;
  std::vector<Told> lines;
  std::vector<std::string> wrong;
  int refused = 0;
  for (int i = 0; i < setting.trials; ++i) {
    setting.progress(fmt::format("who is who, line {} of {}", i + 1, setting.trials));
    const std::uint64_t seed = setting.seed + static_cast<std::uint64_t>(i);
    const Line line = draw_line(seed);
    std::ofstream(folder / "world.toml") << *arena << line.people;
    std::ofstream(folder / "scenario.toml")
        << "world = \"world.toml\"\nrobot = \"robot\"\nends_at_s = 28.0\n[[line]]\nname = \"arming\"\ninput = true\n"
           "[[line]]\nname = \"face light\"\n[[line_event]]\nwhat = \"pressed\"\nline = \"arming\"\nfrom_s = 1.5\n";
    std::filesystem::remove(folder / "identities");
    const auto turned_away = enroll_all(line.enrolled, portraits, folder / "identities");
    if (!turned_away) return tl::unexpected(turned_away.error());
    refused += *turned_away;
    auto told = look_along(folder, shipped, seed, line);
    if (!told) return tl::unexpected(told.error());
    told->taken_for_another = *turned_away > 0;
    if (told->right < static_cast<int>(kPeople)) wrong.push_back(describe(seed, line, *told));
    lines.push_back(*told);
  }
  report.title = fmt::format("who is who in a line of four known people and a stranger, {} lines", setting.trials);
  add_rows(lines, setting.seed, report);
  report.rows.push_back(
      share_row("enrolment", "taken for somebody who is enrolled", refused, setting.trials * static_cast<int>(kKnown)));
  report.rows.push_back(photographed_again(portraits));
  report.notes = {
      "A line is drawn by the seed: who stands in it and where, who is not enrolled, heights, how heads turn. People "
      "stand .7 m apart, 1.6 m before the robot, and look at it.",
      "The dissertation's robot named four of five right (6.4.1.2).",
      "Who stands in a line is drawn among 100,000 people of the simulator. Intervals are over lines."};
  report.notes.insert(report.notes.end(), wrong.begin(), wrong.end());
  return report;
}

}  // namespace cgsr::lab
