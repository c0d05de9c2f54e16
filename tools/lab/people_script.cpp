#include "tools/lab/people_script.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "tools/lab/person_cast.h"
#include "tools/lab/person_watch.h"

namespace cgsr::lab {
namespace {

using Shirt = std::array<double, 3>;

/// What every case draws: two people with shirts.
struct Pair {
  std::vector<int> identities;
  std::array<Figure, 2> people;
};

Pair draw_pair(Random& random) {
  Pair pair;
  pair.identities = draw_people(2, random);
  for (std::size_t i = 0; i < 2; ++i) {
    Figure& person = pair.people[i];
    person.identity = pair.identities[i];
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

/// Some of the light goes from what it is to a multiple of it in the middle of the run.
std::string light_script(const char* light, const Shirt& factor, double ramp_s) {
  return fmt::format(
      "[[{0}.script]]\nat_s = {1:.2f}\nfactor = [1.0, 1.0, 1.0]\n[[{0}.script]]\nat_s = {2:.2f}\nfactor = [{3:.2f}, "
      "{4:.2f}, {5:.2f}]\n",
      light, at(6.0), at(6.0) + ramp_s, factor[0], factor[1], factor[2]);
}

Case changing_light(Random& random) {
  const Pair pair = draw_pair(random);
  Case one{"light changed by two", pair.identities, {pair.people[0]}, {{0.0, 1, 0.0}}, 12.0, "", false};
  one.figures[0].turns_s = at(3.0);
  Shirt factor{};
  for (double& channel : factor) channel = random.uniform(0.5, 0.8);
  factor[static_cast<std::size_t>(random.below(3))] = 0.5;
  const double ramp_s = random.uniform(0.0, 1.0) < 0.5 ? 0.05 : 2.0;  // switched, or dimmed
  if (random.uniform(0.0, 1.0) < 0.5)
    for (double& channel : factor) channel = 1.0 / channel;
  one.lamp = light_script("lamp", factor, ramp_s);
  one.ambient = light_script("ambient", factor, ramp_s);
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
  const double bearing_0 = 0.7 / (2.9 - kRobotStart_m), bearing_1 = -0.6 / (2.3 - kRobotStart_m);
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
  do {
    pair.identities.front() = draw_dark_person(random);
  } while (pair.identities.front() == pair.identities.back());
  Figure person = pair.people[0];
  person.identity = pair.identities.front();
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

/// The volunteer of 6.4.1.1: too dark a face in too dark a hall, of whom nothing is known until a light shines on him.
Case face_in_the_dark(Random& random, const char* name, double darkest, bool light) {
  Case one = dark_face(random);
  one.name = name;
  const double factor = random.uniform(darkest, 2.0 * darkest);
  one.lamp = fmt::format("[[lamp.script]]\nat_s = 0.0\nfactor = [{0:.2f}, {0:.2f}, {0:.2f}]\n", factor);
  one.ambient = fmt::format("[[ambient.script]]\nat_s = 0.0\nfactor = [{0:.2f}, {0:.2f}, {0:.2f}]\n", factor);
  one.face_light_lm = 3000.0;  // to all sides: on the face as bright as a torch of 40 lm with a beam of 25 degrees
  if (light) one.robot = "switches.fill_light_line = \"face light\"\nperson.fill_light.enabled = true\n";
  return one;
}

Case lit_face(Random& random) {
  return face_in_the_dark(random, "dark face in the dark, fill light", 0.03, true);
}

Case unlit_face(Random& random) {
  return face_in_the_dark(random, "dark face in the dark, no fill light", 0.03, false);
}

// What was the dark before the detector's image was stretched.
Case face_in_a_tenth(Random& random) {
  return face_in_the_dark(random, "dark face in a tenth of the light, no fill light", 0.06, false);
}

constexpr std::array<Case (*)(Random&), kPeopleCases> kCases{
    exchanged_shirts, white_shirt, changing_light, crossing_people, dark_face, lit_face, unlit_face, face_in_a_tenth};

}  // namespace

Case draw_people_case(std::size_t kind, Random& random) {
  return kCases[kind](random);
}

std::string text_of(const Figure& figure, const std::string& name) {
  const double to_robot_deg = 180.0 + std::atan2(figure.y_m, figure.x_m - kRobotStart_m) * 180.0 / std::numbers::pi;
  std::string text = fmt::format(
      "[[person]]\nname = \"{}\"\nidentity = {}\nheight_m = {:.2f}\noutfit = [{{ shirt = \"plain\", color = [{:.2f}, "
      "{:.2f}, {:.2f}] }}]\npresence = [{{ at_s = 0.0, present = {} }}, {{ at_s = {:.2f}, present = true }}, {{ at_s = "
      "{:.2f}, present = false }}]\n[person.walk]\nstop = [\n",
      name, figure.identity, figure.height_m, figure.shirt[0], figure.shirt[1], figure.shirt[2], figure.from_s <= 0.0,
      std::max(0.01, figure.from_s), figure.to_s);
  if (figure.faces_s >= 0.0)
    return text + fmt::format(
                      "{{ at_m = [{0:.2f}, {1:.2f}, 0.0], wait_s = {2:.2f}, heading_deg = 0.0 }},\n{{ at_m = [{3:.2f}, "
                      "{1:.2f}, 0.0], wait_s = 1000.0, heading_deg = {4:.1f} }}]\n",
                      figure.x_m, figure.y_m, figure.faces_s, figure.x_m + 0.02, to_robot_deg);
  text += fmt::format("{{ at_m = [{:.2f}, {:.2f}, 0.0], wait_s = {:.2f}, heading_deg = {:.1f} }},\n", figure.x_m,
                      figure.y_m, std::min(figure.turns_s, 1000.0), to_robot_deg);
  if (figure.walks_s < 0.0)
    return text + fmt::format("{{ at_m = [{:.2f}, {:.2f}, 0.0], wait_s = 1000.0, heading_deg = 0.0 }}]\n",
                              figure.x_m + 0.02, figure.y_m);
  return text + fmt::format(
                    "{{ at_m = [{:.2f}, {:.2f}, 0.0], wait_s = {:.2f}, heading_deg = 0.0 }},\n{{ at_m = [{:.2f}, "
                    "{:.2f}, 0.0], speed_mps = {:.2f}, wait_s = 1000.0, heading_deg = 0.0 }}]\n",
                    figure.x_m + 0.02, figure.y_m, std::max(0.1, figure.walks_s - figure.turns_s),
                    figure.to_x_m > 0.0 ? figure.to_x_m : figure.x_m, figure.to_y_m, figure.speed_mps);
}

}  // namespace cgsr::lab
