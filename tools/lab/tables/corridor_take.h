#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "platform/error.h"
#include "tools/lab/corridor_film.h"
#include "tools/lab/experiment.h"
#include "tools/lab/report.h"

namespace cgsr::lab {

/// Who follows the shirt of Figure 3.3, by their names in trackers().
inline constexpr std::array<std::string_view, 3> kCorridorTrackers{"ours", "plain", "CAM-Shift"};

/// Means over the images of one second.
struct CorridorSecond {
  double precision = 0.0, recall = 0.0, iou = 0.0, found = 0.0;
};
using CorridorSeconds = std::array<CorridorSecond, CorridorFilm::kSeconds>;

/// What one take of the film of Figure 3.3 gave.
struct CorridorTake {
  using Lights = std::array<std::optional<Light>, CorridorFilm::kSeconds>;

  std::array<CorridorSeconds, kCorridorTrackers.size()> seconds{};  ///< [tracker]

  // Light in the tracker's terms: relative to what Alg. 3.1 assumed at learning, encoded.
  Lights estimated;  ///< by ours: the plurality of each second
  Lights exact;      ///< by ours: the last estimate in each second, not bound to the grid
  Lights real;       ///< on the shirt, in the last image of each second
  double light_error = 0.0,
         exact_error = 0.0;  ///< sums over images of the mean over channels: on the grid, and between its lights
  int lights = 0;            ///< images with an estimate

  std::vector<double> of_its_hues;  ///< share of the background in the shirt's hues, once a second
  double near_white = 0.0;          ///< in the image learned from
  Light first_light, last_light;    ///< of the script, linear
  std::vector<Picture> pictures;    ///< at the seconds that the dissertation shows, with everybody's box
};

/// Draws a take and lets every tracker follow the shirt in it, all in one pass; all learn from image 0, which is scored like any other.
/// \return why the world cannot be drawn, or a tracker refuses the shirt.
Result<CorridorTake> run_corridor_take(const Setting& setting, std::uint64_t seed);

}  // namespace cgsr::lab
