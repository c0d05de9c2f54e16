#include "tools/lab/experiment.h"

#include <algorithm>
#include <array>

#include "tools/lab/configurations.h"
#include "tools/lab/rooms.h"
#include "tools/lab/source_path.h"
#include "tools/lab/sources.h"
#include "tools/lab/tables/faces_caltech.h"
#include "tools/lab/tables/people_tables.h"
#include "tools/lab/tables/requirements.h"

namespace cgsr::lab {
namespace {

// In the order of the chapters. The trials are those that fit an hour together, counting included.
constexpr std::array kExperiments{
    Experiment{"light-sweep",
               "Chapter 3 on generated scenes while the light changes (3.1.1, 3.2.1)",
               3,
               60,
               false,
               true,
               light_sweep,
               color_hash,
               kColorRooms,
               {"tools/lab/tables/light_sweep.cpp"}},
    Experiment{"real-video",
               "Chapter 3 beside CAM-Shift, KCF and CSRT on real video",
               3,
               1,
               true,
               false,
               real_video,
               color_hash,
               kColorRooms,
               {"tools/lab/tables/real_video.cpp", "tools/lab/peers.cpp"}},
    Experiment{"tracking-benchmark",
               "Chapter 3 on many recorded sequences: robustness, relit, object absent",
               3,
               1,
               true,
               false,
               tracking_benchmark,
               color_hash,
               kColorRooms,
               {"tools/lab/tables/tracking_benchmark.cpp", "tools/lab/tracking", "tools/lab/peers.cpp"}},
    Experiment{"search-cost",
               "What labels and search cost per image (3.3.2)",
               3,
               60,
               true,
               true,
               search_cost,
               color_hash,
               kColorRooms,
               {"tools/lab/tables/search_cost.cpp"}},
    Experiment{"figure-3.3",
               "A shirt followed from a corridor into daylight (Figure 3.3)",
               3,
               2,
               true,
               true,
               figure_3_3,
               color_hash,
               kColorRooms,
               {"tools/lab/tables/figure_3_3.cpp", "tools/lab/corridor_film.cpp", "config/worlds/corridor.toml"}},
    Experiment{"closed-loop",
               "The simulated home's robot follows a cart through changing light",
               3,
               3,
               true,
               true,
               closed_loop,
               home_robot_hash,
               kWholeRobot,
               {"tools/lab/tables/closed_loop.cpp", "config/worlds/home.toml"}},
    Experiment{"table-4.1",
               "A camera's pose corrected on the field (Table 4.1)",
               4,
               60,
               true,
               true,
               table_4_1,
               localization_hash,
               kLocalizationRooms,
               {"tools/lab/tables/table_4_1.cpp", "config/worlds/spl-field.toml"}},
    Experiment{"homes-4.1",
               "Table 4.1 over homes drawn from seeds",
               4,
               20,
               true,
               true,
               homes_4_1,
               localization_hash,
               kLocalizationRooms,
               {"tools/lab/tables/homes_4_1.cpp", "hal/sim/generator"}},
    Experiment{"table-4.2",
               "What a correction costs by the edges in the map (Table 4.2)",
               4,
               6,
               true,
               true,
               table_4_2,
               localization_hash,
               kLocalizationRooms,
               {"tools/lab/tables/table_4_2.cpp", "config/worlds/planar.toml"}},
    Experiment{"section-4.3.3",
               "The same with cloth walls in between, and without them (4.3.3)",
               4,
               5,
               true,
               true,
               section_4_3_3,
               localization_hash,
               kLocalizationRooms,
               {"tools/lab/tables/section_4_3_3.cpp", "config/worlds/occlusion.toml"}},
    Experiment{"false-corrections",
               "How often 'corrected' is claimed and wrong",
               4,
               300,
               true,
               true,
               false_corrections,
               localization_hash,
               kLocalizationRooms,
               {"tools/lab/tables/false_corrections.cpp", "config/worlds"}},
    Experiment{"home-round",
               "Three minutes through the simulated home on wheels that slip",
               4,
               1,
               true,
               true,
               home_round,
               round_robot_hash,
               kWholeRobot,
               {"tools/lab/tables/home_round.cpp", "config/worlds/home.toml"}},
    Experiment{"real-localization",
               "Chapter 4 on a cube, a desk and ViSP's castle",
               4,
               40,
               true,
               true,
               real_localization,
               localization_hash,
               kLocalizationRooms,
               {"tools/lab/tables/real_localization.cpp"}},
    Experiment{"table-5.1",
               "Where the lamp is, out of the probes' shadows (Table 5.1)",
               5,
               60,
               true,
               true,
               table_5_1,
               lamp_hash,
               kLampRooms,
               {"tools/lab/tables/table_5_1.cpp", "config/worlds/home.toml"}},
    Experiment{"lamps-5.1",
               "Table 5.1 over lamps that are drawn: place, radius, strength, ambient light",
               5,
               60,
               true,
               true,
               lamps_5_1,
               lamp_hash,
               kLampRooms,
               {"tools/lab/tables/lamps_5_1.cpp", "config/worlds/home.toml"}},
    Experiment{"lamp-cases",
               "Lamps off, two, behind, flickering, moving; strengths and angles (5.4.1)",
               5,
               300,
               true,
               true,
               lamp_cases,
               lamp_hash,
               kLampRooms,
               {"tools/lab/tables/lamp_cases.cpp", "config/worlds/home.toml"}},
    Experiment{"lamp-drives",
               "A lamp's place and height while the robot drives",
               5,
               20,
               true,
               true,
               lamp_drives,
               lamp_hash,
               kLampRooms,
               {"tools/lab/tables/lamp_drives.cpp", "config/worlds/home.toml"}},
    Experiment{"section-5.4.2",
               "Shaded regions beside the ray tracer's, and their cost (5.4.2)",
               5,
               20,
               true,
               true,
               section_5_4_2,
               shade_hash,
               kShadeRooms,
               {"tools/lab/tables/section_5_4_2.cpp", "config/worlds"}},
    Experiment{"shaded-ball",
               "A ball in light and shade, with the mask of shade and without (5.4.3)",
               5,
               1,
               true,
               true,
               shaded_ball,
               ball_hash,
               kBallRooms,
               {"tools/lab/tables/shaded_ball.cpp", "tools/lab/ball_follower.cpp", "config/worlds/home.toml"}},
    Experiment{"section-5.4.3",
               "Algorithm 5.2 in the simulated home, a ball tracked with masks (5.4.3)",
               5,
               1,
               true,
               true,
               section_5_4_3,
               lamp_robot_hash,
               kWholeRobot,
               {"tools/lab/tables/section_5_4_3.cpp", "config/worlds/home.toml"}},
    Experiment{"faces-caltech",
               "Whose face it is, on photographs (6.2.1)",
               6,
               1,
               true,
               false,
               faces_caltech,
               faces_hash,
               kPersonRooms,
               {"tools/lab/tables/faces_caltech.cpp"}},
    Experiment{"figure-6.7",
               "What identifying people costs: face in every image, in every other one, face and shirt (6.4)",
               6,
               1,
               true,
               true,
               figure_6_7,
               people_robot_hash,
               kWholeRobot,
               {"tools/lab/tables/figure_6_7.cpp", "tools/lab/person_cast.cpp", "config/worlds/people.toml"}},
    Experiment{"figure-6.8",
               "Face and shirt while a person turns, walks, leaves and comes back (6.3)",
               6,
               4,
               true,
               true,
               figure_6_8,
               people_robot_hash,
               kWholeRobot,
               {"tools/lab/tables/figure_6_8.cpp", "tools/lab/person_cast.cpp", "tools/lab/person_watch.cpp",
                "config/worlds/people.toml"}},
    Experiment{
        "people-cases",
        "Exchanged shirts, a white shirt at a white wall, changing light, crossing people, a dark face (6.2.4, 6.3)",
        6,
        4,
        true,
        true,
        people_cases,
        people_robot_hash,
        kWholeRobot,
        {"tools/lab/tables/people_cases.cpp", "tools/lab/person_cast.cpp", "tools/lab/person_watch.cpp",
         "config/worlds/people.toml"}},
    Experiment{"who-is-who",
               "Who Is Who in a line: four known people and a stranger (6.4.1.2)",
               6,
               10,
               true,
               true,
               who_is_who,
               people_line_robot_hash,
               kWholeRobot,
               {"tools/lab/tables/who_is_who.cpp", "tools/lab/person_cast.cpp", "config/worlds/people.toml"}},
    Experiment{"finals",
               "The Finals: strangers in the person's shirt are noticed, the person is found again, in another shirt "
               "or the same (6.4.3)",
               6,
               4,
               true,
               true,
               finals,
               people_finals_robot_hash,
               kWholeRobot,
               {"tools/lab/tables/finals.cpp", "tools/lab/person_cast.cpp", "tools/lab/people_script.cpp",
                "config/worlds/people.toml"}},
};

void add_requirements(const Experiment& experiment, Report& report) {
  for (const NamedRequirement& required : requirements_of(experiment.name)) {
    const auto is_it = [&](const Row& row) { return row.row == required.row && row.quantity == required.quantity; };
    const auto row = std::ranges::find_if(report.rows, is_it);
    if (row != report.rows.end()) row->requirement = required.requirement;
  }
}

}  // namespace

std::vector<std::string_view> Experiment::sources() const {
  std::vector<std::string_view> all(rooms.begin(), rooms.end());
  std::ranges::copy_if(own, std::back_inserter(all), [](std::string_view path) { return !path.empty(); });
  return all;
}

std::span<const Experiment> experiments() {
  return kExperiments;
}

const Experiment* experiment_of(std::string_view name) {
  const auto found = std::ranges::find(experiments(), name, &Experiment::name);
  return found == experiments().end() ? nullptr : &*found;
}

Result<Report> measure(const Experiment& experiment, Setting setting) {
  if (setting.trials <= 0) setting.trials = experiment.trials;
  auto configuration = experiment.config_sha256(setting);
  if (!configuration) return tl::unexpected(configuration.error());
  const auto paths = experiment.sources();
  auto sources = sources_sha256(source_path(""), paths);
  if (!sources) return tl::unexpected(sources.error());
  auto report = experiment.run(setting);
  if (!report) return report;
  report->name = experiment.name;
  report->config_sha256 = std::move(*configuration);
  report->sources_sha256 = std::move(*sources);
  report->seed = setting.seed;
  report->runs = {{setting.seed, setting.trials, commit_of(source_path(""), paths)}};
  add_requirements(experiment, *report);
  return report;
}

}  // namespace cgsr::lab
