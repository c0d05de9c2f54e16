#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace cgsr::lab {

// Whose sources a table measures: a change in them makes its published rows stale.

/// The stages of chapters 3 to 5 and what they hand each other: who is identified and what a task decides is not in their tables.
inline constexpr std::array<std::string_view, 19> kVisionStages{
    "pipeline/stages/color_stages.cpp", "pipeline/stages/color_stages.h",     "pipeline/stages/decode_stage.cpp",
    "pipeline/stages/decode_stage.h",   "pipeline/stages/events.h",           "pipeline/stages/localize_stage.cpp",
    "pipeline/stages/localize_stage.h", "pipeline/stages/odometry_track.cpp", "pipeline/stages/odometry_track.h",
    "pipeline/stages/probes_stage.cpp", "pipeline/stages/probes_stage.h",     "pipeline/stages/requests.h",
    "pipeline/stages/search_stage.cpp", "pipeline/stages/search_stage.h",     "pipeline/stages/shade_stage.cpp",
    "pipeline/stages/shade_stage.h",    "pipeline/stages/track_stage.cpp",    "pipeline/stages/track_stage.h",
    "pipeline/stages/tracked_objects.h"};

template <std::size_t kCount>
constexpr auto with_stages(const std::array<std::string_view, kCount>& rooms) {
  std::array<std::string_view, kCount + kVisionStages.size()> all{};
  std::ranges::copy(kVisionStages, std::ranges::copy(rooms, all.begin()).out);
  return all;
}

inline constexpr auto kColorRooms = with_stages(std::array<std::string_view, 5>{
    "pipeline/color", "pipeline/imaging", "pipeline/runtime", "tools/lab/scenes", "tools/lab/ours.cpp"});
inline constexpr auto kLocalizationRooms = with_stages(std::array<std::string_view, 9>{
    "pipeline/localization", "pipeline/render", "pipeline/world", "pipeline/geometry", "pipeline/imaging",
    "pipeline/runtime", "hal/sim/render", "hal/sim/calibration", "tools/lab/localization"});
inline constexpr std::array<std::string_view, 10> kMappingRooms{
    "pipeline/mapping", "pipeline/localization", "pipeline/render",     "pipeline/world",         "pipeline/geometry",
    "pipeline/imaging", "hal/sim/render",        "hal/sim/calibration", "tools/lab/localization", "tools/lab/mapping"};
inline constexpr auto kLampRooms = with_stages(std::array<std::string_view, 8>{
    "pipeline/illumination", "pipeline/geometry", "pipeline/imaging", "pipeline/runtime", "hal/sim/render",
    "hal/sim/calibration", "tools/lab/probe_room.cpp", "tools/lab/probes_trial.cpp"});
inline constexpr auto kShadeRooms = with_stages(std::array<std::string_view, 8>{
    "pipeline/render", "pipeline/world", "pipeline/geometry", "pipeline/runtime", "hal/sim/render",
    "hal/sim/calibration", "tools/lab/localization", "tools/lab/shade_trial.cpp"});
inline constexpr auto kBallRooms = with_stages(std::array<std::string_view, 8>{
    "pipeline/color", "pipeline/imaging", "pipeline/render", "pipeline/geometry", "pipeline/runtime", "hal/sim/render",
    "tools/lab/ball_film.cpp", "tools/lab/shade_trial.cpp"});
inline constexpr std::array<std::string_view, 1> kPersonRooms{"pipeline/person"};
/// Not pipeline/mapping: no robot links it.
inline constexpr std::array<std::string_view, 18> kWholeRobot{"pipeline/behavior",
                                                              "pipeline/calibration",
                                                              "pipeline/color",
                                                              "pipeline/geometry",
                                                              "pipeline/illumination",
                                                              "pipeline/imaging",
                                                              "pipeline/localization",
                                                              "pipeline/motion",
                                                              "pipeline/person",
                                                              "pipeline/render",
                                                              "pipeline/runtime",
                                                              "pipeline/stages",
                                                              "pipeline/world",
                                                              "pipeline/vision_loop.cpp",
                                                              "pipeline/vision_loop.h",
                                                              "hal/sim",
                                                              "hal/rmp",
                                                              "config/scenarios"};

}  // namespace cgsr::lab
