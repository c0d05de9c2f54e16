// Figure 6.8: after the robot was trained somebody is seen from the front for 10 s, turns and walks, is out of sight from 16 to 18 s, is back and seen from the front, and turns again at
// 20 s. The robot's own program looks on and stands; the same images go through it with face, face colour and shirt, with face and shirt, and with the face alone.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/lab/experiment.h"
#include "tools/lab/people_truth.h"
#include "tools/lab/person_cast.h"
#include "tools/lab/person_watch.h"
#include "tools/lab/scenes/random.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

constexpr double kTraining_s = 3.0;  // before the script begins: "after having trained the robot"
constexpr double kTurns_s = 10.0, kGone_s = 16.0, kBack_s = 18.0, kTurnsAgain_s = 20.0, kEnds_s = 24.0;  // the script
constexpr double kTurned_s = 1.6;  // after which the face is turned away
constexpr int kAroundChange = 5;   // images that are left out before and after a change
constexpr double kPeriod_s = 1.0 / 30.0;

/// Somebody with clothes and a way of his own, and who is enrolled beside him.
struct Cast {
  std::vector<int> identities;  // all who are enrolled: the person first
  std::string person;           // as the world's file has it
};

Cast draw_cast(std::uint64_t seed) {
  Random random(Random::mix(seed));
  Cast cast;
  const std::vector<int> all = draw_people(4, random);
  cast.identities.assign(all.begin(), all.end());
  const auto near = [&random](double value, double reach) { return value + random.uniform(-reach, reach); };
  // A grey shirt is told from walls by nothing that this figure is about.
  const std::array<double, 3> shirt = draw_vivid_shirt(random);
  const std::string looks = fmt::format(
      "[[person]]\nidentity = {}\nheight_m = {:.2f}\noutfit = [{{ shirt = \"plain\", color = [{:.2f}, {:.2f}, {:.2f}] "
      "}}]\n",
      cast.identities.front(), random.uniform(1.62, 1.82), shirt[0], shirt[1], shirt[2]);
  const double x_m = near(2.3, 0.2);
  const double back_x_m = near(2.5, 0.2), back_y_m = near(0.0, 0.2);
  cast.person = looks;
  cast.person += fmt::format(
      "name = \"somebody\"\npresence = [{{ at_s = 0.0 }}, {{ at_s = {}, present = false }}]\n[person.walk]\nstop = [\n"
      "{{ at_m = [{:.2f}, {:.2f}, 0.0], wait_s = {}, heading_deg = 180.0 }},\n"
      "{{ at_m = [{:.2f}, {:.2f}, 0.0], speed_mps = 0.4, wait_s = 1.0, heading_deg = 0.0 }},\n"
      "{{ at_m = [{:.2f}, {:.2f}, 0.0], speed_mps = 0.4, wait_s = 60.0, heading_deg = 20.0 }}]\n",
      kTraining_s + kGone_s, x_m, near(0.0, 0.2), kTraining_s + kTurns_s, near(3.1, 0.2), near(0.3, 0.2),
      near(3.1, 0.2), near(-0.5, 0.2));
  // A walk has no times of its own: who comes back is a second figure that looks the same.
  cast.person += looks;
  cast.person += fmt::format(
      "name = \"somebody again\"\npresence = [{{ at_s = 0.0, present = false }}, {{ at_s = {}, present = true }}]\n"
      "[person.walk]\nstop = [\n{{ at_m = [{:.2f}, {:.2f}, 0.0], wait_s = {}, heading_deg = 180.0 }},\n"
      "{{ at_m = [{:.2f}, {:.2f}, 0.0], wait_s = 60.0, heading_deg = 0.0 }}]\n",
      kTraining_s + kBack_s, back_x_m, back_y_m, kTraining_s + kTurnsAgain_s, back_x_m + 0.02, back_y_m);
  return cast;
}

/// Counts of one variant of one cast.
struct Counts {
  int visible = 0, identified = 0, unsure = 0;          // the person is there
  int after_first = 0, identified_after = 0;            // the same from the first identification on
  int absent = 0, claimed = 0;                          // he is not
  int with_training = 0, identified_with_training = 0;  // the person is there, from the first image on
  int back_turned = 0, identified_back_turned = 0;
  int somebody_else = 0, images = 0;
  int left_out = 0, identified_left_out = 0;
  int unlike_script = 0;                        // images in which the truth is not what the script means
  std::optional<double> first_s, first_face_s;  // from the first image on
};

bool near_a_change(double time_s) {
  constexpr double kReach_s = kAroundChange * kPeriod_s;
  return std::ranges::any_of(
      std::array{kTurns_s, kTurns_s + kTurned_s, kGone_s, kBack_s, kTurnsAgain_s, kTurnsAgain_s + kTurned_s},
      [time_s](double change_s) { return std::abs(time_s - change_s) <= kReach_s; });
}

/// \param visible  of each image, as the simulator knows it.
Counts count(const std::vector<Seen>& seen, const std::vector<bool>& visible) {
  Counts counts;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Seen& image = seen[i];
    const bool is_it = image.number == 1;
    ++counts.images;
    if (image.number > 1) ++counts.somebody_else;
    if (is_it && !counts.first_s) counts.first_s = image.time_s + kTraining_s;
    if (image.a_face && !counts.first_face_s) counts.first_face_s = image.time_s + kTraining_s;
    if (image.time_s < 0.0) {
      ++counts.with_training;
      counts.identified_with_training += is_it ? 1 : 0;
      continue;
    }
    if (near_a_change(image.time_s)) {
      ++counts.left_out;
      counts.identified_left_out += is_it ? 1 : 0;
      continue;
    }
    const bool scripted = image.time_s < kGone_s || image.time_s > kBack_s;
    counts.unlike_script += visible[i] != scripted ? 1 : 0;
    if (!visible[i]) {
      ++counts.absent;
      counts.claimed += image.number >= 0 ? 1 : 0;
      continue;
    }
    ++counts.visible;
    ++counts.with_training;
    counts.identified_with_training += is_it ? 1 : 0;
    counts.identified += is_it ? 1 : 0;
    counts.unsure += image.unsure ? 1 : 0;
    if (counts.first_s) {
      ++counts.after_first;
      counts.identified_after += is_it ? 1 : 0;
    }
    const bool turned =
        image.time_s < kBack_s ? image.time_s > kTurns_s + kTurned_s : image.time_s > kTurnsAgain_s + kTurned_s;
    if (turned) {
      ++counts.back_turned;
      counts.identified_back_turned += is_it ? 1 : 0;
    }
  }
  return counts;
}

double share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : 0.0;
}

void add_rows(Report& report, const std::string& name, const std::vector<Counts>& casts, std::uint64_t seed) {
  const auto add = [&](const char* quantity, auto part, auto whole) {
    std::vector<double> shares;
    for (const Counts& counts : casts) shares.push_back(share(counts.*part, counts.*whole));
    report.rows.push_back(mean_row(name, quantity, "", shares, seed));
  };
  add("identified where visible", &Counts::identified, &Counts::visible);
  add("unsure where visible", &Counts::unsure, &Counts::visible);
  add("identified where visible, from the first time on", &Counts::identified_after, &Counts::after_first);
  add("identified where visible, the training's images too", &Counts::identified_with_training, &Counts::with_training);
  add("identified where the face is turned away", &Counts::identified_back_turned, &Counts::back_turned);
  add("somebody identified where nobody is", &Counts::claimed, &Counts::absent);
  add("taken for somebody else", &Counts::somebody_else, &Counts::images);
  add("identified around the changes that are left out", &Counts::identified_left_out, &Counts::left_out);
  std::vector<double> unlike;
  for (const Counts& counts : casts) unlike.push_back(counts.unlike_script);
  report.rows.push_back(
      mean_row(name, "images in which he is not visible by the script but by truth, or the reverse", "", unlike, seed));
  std::vector<double> first, face;
  for (const Counts& counts : casts) {
    if (counts.first_s) first.push_back(*counts.first_s);
    if (counts.first_face_s) face.push_back(*counts.first_face_s);
  }
  if (!face.empty()) {
    report.rows.push_back(mean_row(name, "face first noticed after", "s", face, seed));
    report.rows.push_back(plain_row(name, "face first noticed after, worst", "s", *std::ranges::max_element(face),
                                    face.size(), Join::kMax));
  }
  if (!first.empty()) report.rows.push_back(mean_row(name, "first identified after", "s", first, seed));
  report.rows.push_back(share_row(name, "casts in which the person was identified", static_cast<int>(first.size()),
                                  static_cast<int>(casts.size())));
}

// Faces are looked for in every other image: by face counts for some images. Each variant has a base of its own, or it would hide the others.
Curve curve_of(const std::string& name, double base, const std::vector<Seen>& seen) {
  constexpr int kByFace = 5;  // images
  Curve curve{name, {}};
  int since_face = kByFace;
  for (const Seen& image : seen) {
    since_face = image.by_face ? 0 : since_face + 1;
    const double state = image.number != 1 ? 0.0 : since_face < kByFace ? 2.0 : 1.0;
    curve.points.push_back({image.time_s, base + state, {}});
  }
  return curve;
}

/// Which classifiers take part.
struct Variant {
  const char* name;
  const char* in_plot;
  const char* keys;
};
constexpr std::array kVariants{
    Variant{"face, face colour and shirt", "three", ""},  // as it ships
    Variant{"face and shirt", "two", "person.tracker.face_color.enabled = false\n"},
    Variant{"face alone", "face alone",
            "person.tracker = {shirt.enabled = false, face_color.enabled = false, faces_every = 1}\n"},
};

/// What the robot saw of a cast, by variant, and in which images a quarter of his shirt or head is visible.
struct Watched {
  std::vector<std::vector<Seen>> seen;
  std::vector<bool> visible;
};

/// \return of each image whether anybody is visible, by truth.
Result<std::vector<bool>> visible_in(const TableFolder& folder, const std::vector<Seen>& images) {
  auto truth = PeopleTruth::of(folder / "world.toml");
  if (!truth) return tl::unexpected(truth.error());
  std::vector<bool> visible;
  for (const Seen& image : images)
    visible.push_back(std::ranges::any_of(truth->at(image.time_s + kTraining_s), &PersonView::is_visible));
  return visible;
}

Result<Watched> look_on_all(const TableFolder& folder, const std::string& arena, const Cast& cast,
                            const std::string& shipped, std::uint64_t seed) {
  std::ofstream(folder / "world.toml") << arena << cast.person;
  std::ofstream(folder / "scenario.toml") << fmt::format(
      "world = \"world.toml\"\nrobot = \"robot\"\nends_at_s = {}\n[[line]]\nname = \"arming\"\ninput = true\n"
      "[[line]]\nname = \"face light\"\n",
      kTraining_s + kEnds_s);
  const SharedImages images(folder);  // the robot stands
  Watched all;
  for (const Variant& variant : kVariants) {
    auto seen = watch(folder, shipped, seed, variant.keys, kTraining_s);
    if (!seen) return tl::unexpected(seen.error());
    all.seen.push_back(std::move(*seen));
    if (all.seen.back().size() != all.seen.front().size())
      return fail("figure-6.8: two runs of one script have not as many images");
  }
  auto visible = visible_in(folder, all.seen.front());
  if (!visible) return tl::unexpected(visible.error());
  all.visible = std::move(*visible);
  return all;
}

}  // namespace

Result<Report> figure_6_8(const Setting& setting) {
  const std::string shipped =
      setting.config_file.empty() ? source_path("config/robots/sim-people.toml") : setting.config_file;
  const TableFolder folder("figure-6-8");
  Portraits portraits(folder);
  const auto arena = empty_arena();
  if (!arena) return tl::unexpected(arena.error());
  std::array<std::vector<Counts>, kVariants.size()> counts;
  Report report;
  Plot plot{
      "The first cast: identified by face (2 above a variant's base), by colours (1), not at all (0)", "s", "", {}};
  int refused = 0;
  for (int i = 0; i < setting.trials; ++i) {
    setting.progress(fmt::format("figure 6.8, cast {} of {}", i + 1, setting.trials));
    const std::uint64_t seed = setting.seed + static_cast<std::uint64_t>(i);
    const Cast cast = draw_cast(seed);
    std::filesystem::remove(folder / "identities");
    const auto turned_away = enroll_all(cast.identities, portraits, folder / "identities");
    if (!turned_away) return tl::unexpected(turned_away.error());
    refused += *turned_away;
    const auto seen = look_on_all(folder, *arena, cast, shipped, seed);
    if (!seen) return tl::unexpected(seen.error());
    for (std::size_t variant = 0; variant < kVariants.size(); ++variant) {
      counts[variant].push_back(count(seen->seen[variant], seen->visible));
      if (i == 0) {
        const double base = 3.0 * static_cast<double>(kVariants.size() - 1 - variant);
        plot.curves.push_back(
            curve_of(fmt::format("{}, from {}", kVariants[variant].in_plot, base), base, seen->seen[variant]));
      }
    }
  }
  report.title =
      fmt::format("who is seen while a person turns, walks, leaves and comes back, {} casts", setting.trials);
  for (std::size_t variant = 0; variant < kVariants.size(); ++variant)
    add_rows(report, kVariants[variant].name, counts[variant], setting.seed);
  report.rows.push_back(share_row("enrolment", "taken for somebody who is enrolled", refused, setting.trials * 4));
  report.rows.push_back(photographed_again(portraits));
  report.plots.push_back(std::move(plot));
  report.notes = {
      "A cast is a person, his clothes, his way and three others who are enrolled with him, drawn by the seed; "
      "intervals are over casts.",
      fmt::format("Left out: {} images before and after each change of the script.", kAroundChange),
      "Visible: a quarter of the shirt or of the head that is inside the image is seen by the camera, as the simulator "
      "knows it.",
      fmt::format(
          "The script begins after the robot was trained, as the dissertation's does: the person is seen for {} "
          "s before. 'The training's images too' counts from the first image on, as this table did before.",
          kTraining_s)};
  return report;
}

}  // namespace cgsr::lab
