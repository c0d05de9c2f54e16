// Figure 6.7: what identifying somebody costs. Theirs is frames per second on 1 GHz (15 with the face in every image, up to 22.5 with the face in every other one); ours is
// instructions per image at 640x480, from the first image on: while the face is looked for, the shirt is learned, and both are followed.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "pipeline/person/face/face_tracks.h"
#include "tools/lab/counting.h"
#include "tools/lab/experiment.h"
#include "tools/lab/person_cast.h"
#include "tools/lab/source_path.h"
#include "tools/lab/tables/people_tables.h"

namespace cgsr::lab {
namespace {

constexpr double kImages_per_s = 30.0;
constexpr double kInstructions_per_image_m = 1000.0 / kImages_per_s;  // Minstr: 1 GHz, one in each cycle
constexpr double kCounted_s = 5.0, kTurns_s = 3.0;                    // from the front, then turned away and walking

struct Variant {
  const char* name;
  const char* keys;
  int identity = 0;  // of whoever is seen
};
constexpr Variant kVariants[] = {
    {"face alone, in every image",
     "person.tracker = {shirt.enabled = false, face_color.enabled = false, faces_every = 1}\n"},
    {"face alone, in every other image", "person.tracker = {shirt.enabled = false, face_color.enabled = false}\n"},
    {"face and shirt", "person.tracker.face_color.enabled = false\n"},
    {"face, face colour and shirt", ""},  // as it ships: the face in every other image
    {"face, face colour and shirt, a stranger", "", 4},
};

/// The robot stands (6.2): where it drives, the counted run would have to repeat every motion of the one that drew its images.
Result<void> write_scene(const TableFolder& folder, int identity) {
  const auto arena = empty_arena();
  if (!arena) return tl::unexpected(arena.error());
  std::ofstream(folder / "world.toml")
      << *arena
      << fmt::format(
             "[[person]]\nname = \"somebody\"\nidentity = {}\n[person.walk]\nstop = [\n"
             "{{ at_m = [2.4, 0.0, 0.0], wait_s = {}, heading_deg = 180.0 }},\n"
             "{{ at_m = [3.2, 0.3, 0.0], speed_mps = 0.4, heading_deg = 0.0 }}]\n",
             identity, kTurns_s);
  std::ofstream(folder / "scenario.toml") << fmt::format(
      "world = \"world.toml\"\nrobot = \"robot\"\nends_at_s = {}\n[[line]]\nname = \"arming\"\ninput = true\n"
      "[[line]]\nname = \"face light\"\n",
      kCounted_s);
  return {};
}

Result<Counted> count_variant(const TableFolder& folder, const std::string& shipped, std::uint64_t seed,
                              const Variant& variant) {
  const auto robot = folder / "robot.toml";
  std::ofstream(robot) << fmt::format(
      "extends = \"{}\"\nsim.scenario = \"scenario.toml\"\nperson.identities = \"identities\"\n{}",
      std::filesystem::absolute(shipped).string(), variant.keys);
  return count_program("cgsr",
                       {"run", "--config", robot.string(), "--seed", std::to_string(seed), "--log-level", "warning"});
}

/// A stage that never ran has cost nothing.
Cost cost_of(const Counted& counted, const std::string& stage) {
  const auto found = counted.stages.find(stage);
  return found == counted.stages.end() ? Cost{} : found->second;
}

void add_rows(const Variant& variant, const Counted& counted, Report& report) {
  const auto trials = static_cast<std::size_t>(counted.images);
  const auto add = [&](const char* quantity, const char* unit, double value, Join join) {
    report.rows.push_back(plain_row(variant.name, quantity, unit, value, trials, join));
  };
  const Cost identify = cost_of(counted, "identify"), recognition = cost_of(counted, "recognition");
  const double beside = recognition.mean_minstr * recognition.images / std::max(1, counted.images);
  const double frame_path = counted.image.mean_minstr - beside;
  add("identify", "Minstr", identify.mean_minstr, Join::kWeighted);
  add("identify, worst", "Minstr", identify.worst_minstr, Join::kMax);
  add("all of the frame path", "Minstr", frame_path, Join::kWeighted);
  add("recognition beside the frame path", "Minstr", beside, Join::kWeighted);
  add("recognition, of one face", "Minstr", recognition.mean_minstr, Join::kWeighted);
  const double left = std::max(1.0, kInstructions_per_image_m - frame_path);
  const double answer_ms = recognition.mean_minstr / left * 1000.0 / kImages_per_s;
  add("from crop to answer at 1 GHz, the frame path first", "ms", answer_ms, Join::kWeighted);
  add("from the first crop to a name at 1 GHz, the frame path first", "ms",
      person::FaceTrackParameters{}.min_agreeing * answer_ms, Join::kWeighted);
  add("recognition beside the frame path, worst second", "Minstr", recognition.worst_second_minstr, Join::kMax);
  const double comparisons = person::FaceTrackParameters{}.max_comparisons;
  add("recognition beside the frame path, at most in a second", "Minstr",
      comparisons * recognition.worst_minstr / kImages_per_s, Join::kMax);
}

}  // namespace

Result<Report> figure_6_7(const Setting& setting) {
  if (!setting.count) return fail("figure-6.7 counts instructions and nothing else: not with --no-count");
  const std::string shipped =
      setting.config_file.empty() ? source_path("config/robots/sim-people.toml") : setting.config_file;
  const TableFolder folder("figure-6-7");
  Portraits portraits(folder);
  if (const auto enrolled = enroll_all({0, 1, 2, 3}, portraits, folder / "identities"); !enrolled)
    return tl::unexpected(enrolled.error());
  Report report;
  report.title =
      fmt::format("instructions per image of identifying one of four people, or a stranger, {} s", kCounted_s);
  for (const Variant& variant : kVariants) {
    if (const auto written = write_scene(folder, variant.identity); !written) return tl::unexpected(written.error());
    setting.progress(fmt::format("figure 6.7, {}", variant.name));
    const auto counted = count_variant(folder, shipped, setting.seed, variant);
    if (!counted) return tl::unexpected(counted.error());
    add_rows(variant, *counted, report);
  }
  report.notes = {
      "SSE2 baseline, counted by tools/count; repeats exactly. Somebody is seen from the front and turns away; the "
      "robot stands.",
      "Recognition is what the thread of that name does on a robot: its mean is over all images, the frame path is "
      "without it. At most in a second: as many comparisons as the robot may make in 30 images, each as dear as the "
      "dearest that was counted; worst second: the 30 images in a row in which it did "
      "most. The name of a face needs two answers that agree, one after the "
      "other."};
  return report;
}

}  // namespace cgsr::lab
