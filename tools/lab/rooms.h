#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace cgsr::lab {

// Whose sources a table measures: a change in them makes its published rows stale.

/// The stages that a chapter's tables run, and what they hand each other. Who is identified and what a task decides is in none of them; masks are not in those
/// of the trackers alone.
inline constexpr std::array<std::string_view, 11> kColorStages{
    "pipeline/stages/color_stages.cpp", "pipeline/stages/color_stages.h",   "pipeline/stages/decode_stage.cpp",
    "pipeline/stages/decode_stage.h",   "pipeline/stages/events.h",         "pipeline/stages/requests.h",
    "pipeline/stages/search_stage.cpp", "pipeline/stages/search_stage.h",   "pipeline/stages/track_stage.cpp",
    "pipeline/stages/track_stage.h",    "pipeline/stages/tracked_objects.h"};
inline constexpr std::array<std::string_view, 7> kLocalizationStages{
    "pipeline/stages/decode_stage.cpp",   "pipeline/stages/decode_stage.h",   "pipeline/stages/events.h",
    "pipeline/stages/localize_stage.cpp", "pipeline/stages/localize_stage.h", "pipeline/stages/odometry_track.cpp",
    "pipeline/stages/odometry_track.h"};
inline constexpr std::array<std::string_view, 3> kProbesStages{
    "pipeline/stages/probes_stage.cpp", "pipeline/stages/probes_stage.h", "pipeline/stages/requests.h"};
inline constexpr std::array<std::string_view, 4> kShadeStages{
    "pipeline/stages/ball_track.cpp", "pipeline/stages/ball_track.h", "pipeline/stages/shade_stage.cpp",
    "pipeline/stages/shade_stage.h"};

template <std::size_t... kCounts>
constexpr auto all_of(const std::array<std::string_view, kCounts>&... lists) {
  std::array<std::string_view, (kCounts + ...)> all{};
  auto at = all.begin();
  ((at = std::ranges::copy(lists, at).out), ...);
  return all;
}

inline constexpr auto kColorRooms = all_of(
    std::array<std::string_view, 7>{"pipeline/color/learn", "pipeline/color/search", "pipeline/color/track",
                                    "pipeline/imaging", "pipeline/runtime", "tools/lab/scenes", "tools/lab/ours.cpp"},
    kColorStages);
inline constexpr auto kLocalizationRooms =
    all_of(std::array<std::string_view, 9>{"pipeline/localization", "pipeline/render", "pipeline/world",
                                           "pipeline/geometry", "pipeline/imaging", "pipeline/runtime",
                                           "hal/sim/render", "hal/sim/calibration", "tools/lab/localization"},
           kLocalizationStages);
inline constexpr std::array<std::string_view, 10> kMappingRooms{
    "pipeline/mapping", "pipeline/localization", "pipeline/render",     "pipeline/world",         "pipeline/geometry",
    "pipeline/imaging", "hal/sim/render",        "hal/sim/calibration", "tools/lab/localization", "tools/lab/mapping"};
inline constexpr auto kLampRooms =
    all_of(std::array<std::string_view, 8>{"pipeline/illumination", "pipeline/geometry", "pipeline/imaging",
                                           "pipeline/runtime", "hal/sim/render", "hal/sim/calibration",
                                           "tools/lab/probe_room.cpp", "tools/lab/probes_trial.cpp"},
           kLocalizationStages, kProbesStages);
inline constexpr auto kShadeRooms =
    all_of(std::array<std::string_view, 9>{"pipeline/shade", "pipeline/render", "pipeline/world", "pipeline/geometry",
                                           "pipeline/runtime", "hal/sim/render", "hal/sim/calibration",
                                           "tools/lab/localization", "tools/lab/shade_trial.cpp"},
           kColorStages, kLocalizationStages, kProbesStages, kShadeStages);
inline constexpr auto kBallRooms =
    all_of(std::array<std::string_view, 9>{"pipeline/color", "pipeline/imaging", "pipeline/shade", "pipeline/render",
                                           "pipeline/geometry", "pipeline/runtime", "hal/sim/render",
                                           "tools/lab/ball_film.cpp", "tools/lab/shade_trial.cpp"},
           kColorStages, kLocalizationStages, kProbesStages, kShadeStages);
inline constexpr std::array<std::string_view, 1> kPersonRooms{"pipeline/person"};
/// All that a robot links which identifies nobody. Not pipeline/mapping: no robot links it.
inline constexpr std::array<std::string_view, 18> kRobotWithoutPeople{"pipeline/behavior",
                                                                      "pipeline/calibration",
                                                                      "pipeline/color",
                                                                      "pipeline/geometry",
                                                                      "pipeline/illumination",
                                                                      "pipeline/imaging",
                                                                      "pipeline/localization",
                                                                      "pipeline/motion",
                                                                      "pipeline/render",
                                                                      "pipeline/runtime",
                                                                      "pipeline/shade",
                                                                      "pipeline/stages",
                                                                      "pipeline/world",
                                                                      "pipeline/vision_loop.cpp",
                                                                      "pipeline/vision_loop.h",
                                                                      "hal/sim",
                                                                      "hal/rmp",
                                                                      "config/scenarios"};
inline constexpr auto kWholeRobot = all_of(kRobotWithoutPeople, kPersonRooms);

}  // namespace cgsr::lab
