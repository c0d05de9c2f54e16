#include "src/input/start_places.h"

#include <fmt/format.h>

#include "pipeline/behavior/free_floor.h"
#include "pipeline/global_localization/candidates.h"
#include "pipeline/global_localization/parameters.h"

namespace cgsr::app {
namespace {

constexpr double kMostFloor_m2 = 2000.0;  // half a gigabyte of panoramas

}  // namespace

Result<std::vector<Eigen::Vector2d>> start_places(const world::Map& map, const std::string& map_file) {
  const global_localization::GlobalLocalizerParameters parameters;
  const behavior::FreeFloor floor(map, {.min_clearance_m = parameters.clearance_m});
  if (floor.width_m() * floor.depth_m() > kMostFloor_m2) {
    return fail(fmt::format(
        "{}: covers {:.0f} x {:.0f} m; a first pose is searched for on at most {:.0f} square metres: is the map in "
        "metres? --scale of cgsr map and cgsr localize converts it",
        map_file, floor.width_m(), floor.depth_m(), kMostFloor_m2));
  }
  auto places = global_localization::grid_of_places(map, parameters.spacing_m,
                                                    [&](double x_m, double y_m) { return floor.is_free(x_m, y_m); });
  if (places.empty()) {
    return fail(fmt::format("{}: a first pose needs a map with free floor: no place in it is {} m from everything",
                            map_file, parameters.clearance_m));
  }
  return places;
}

}  // namespace cgsr::app
