#pragma once

#include <array>
#include <string_view>

namespace cgsr::lab {

// Whose sources a table measures: a change in them makes its published rows stale. Of the stages those that the table runs: a change of another one does not.
inline constexpr std::array<std::string_view, 13> kColorRooms{"pipeline/color",
                                                              "pipeline/imaging",
                                                              "pipeline/runtime",
                                                              "pipeline/stages/color_stages.cpp",
                                                              "pipeline/stages/color_stages.h",
                                                              "pipeline/stages/decode_stage.cpp",
                                                              "pipeline/stages/decode_stage.h",
                                                              "pipeline/stages/search_stage.cpp",
                                                              "pipeline/stages/search_stage.h",
                                                              "pipeline/stages/track_stage.cpp",
                                                              "pipeline/stages/track_stage.h",
                                                              "tools/lab/scenes",
                                                              "tools/lab/ours.cpp"};
inline constexpr std::array<std::string_view, 13> kLocalizationRooms{"pipeline/localization",
                                                                     "pipeline/render",
                                                                     "pipeline/world",
                                                                     "pipeline/geometry",
                                                                     "pipeline/imaging",
                                                                     "pipeline/runtime",
                                                                     "pipeline/stages/localize_stage.cpp",
                                                                     "pipeline/stages/localize_stage.h",
                                                                     "pipeline/stages/odometry_track.cpp",
                                                                     "pipeline/stages/odometry_track.h",
                                                                     "hal/sim/render",
                                                                     "hal/sim/calibration",
                                                                     "tools/lab/localization"};
inline constexpr std::array<std::string_view, 10> kLampRooms{"pipeline/illumination",
                                                             "pipeline/geometry",
                                                             "pipeline/imaging",
                                                             "pipeline/runtime",
                                                             "pipeline/stages/probes_stage.cpp",
                                                             "pipeline/stages/probes_stage.h",
                                                             "hal/sim/render",
                                                             "hal/sim/calibration",
                                                             "tools/lab/probe_room.cpp",
                                                             "tools/lab/probes_trial.cpp"};
inline constexpr std::array<std::string_view, 10> kShadeRooms{"pipeline/render",
                                                              "pipeline/world",
                                                              "pipeline/geometry",
                                                              "pipeline/runtime",
                                                              "pipeline/stages/shade_stage.cpp",
                                                              "pipeline/stages/shade_stage.h",
                                                              "hal/sim/render",
                                                              "hal/sim/calibration",
                                                              "tools/lab/localization",
                                                              "tools/lab/shade_trial.cpp"};
inline constexpr std::array<std::string_view, 14> kBallRooms{"pipeline/color",
                                                             "pipeline/imaging",
                                                             "pipeline/render",
                                                             "pipeline/geometry",
                                                             "pipeline/runtime",
                                                             "pipeline/stages/color_stages.cpp",
                                                             "pipeline/stages/color_stages.h",
                                                             "pipeline/stages/track_stage.cpp",
                                                             "pipeline/stages/track_stage.h",
                                                             "pipeline/stages/shade_stage.cpp",
                                                             "pipeline/stages/shade_stage.h",
                                                             "hal/sim/render",
                                                             "tools/lab/ball_film.cpp",
                                                             "tools/lab/shade_trial.cpp"};
inline constexpr std::array<std::string_view, 1> kPersonRooms{"pipeline/person"};
inline constexpr std::array<std::string_view, 4> kWholeRobot{"pipeline", "hal/sim", "hal/rmp", "config/scenarios"};

}  // namespace cgsr::lab
