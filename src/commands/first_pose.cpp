#include "src/commands/first_pose.h"

#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pipeline/behavior/free_floor.h"

namespace cgsr::app {
namespace {

constexpr double kMostFloor_m2 = 2000.0;  // half a gigabyte of panoramas

}  // namespace

using global_localization::Candidate;
using global_localization::GlobalLocalizerParameters;
using global_localization::Phase;

Result<std::unique_ptr<FirstPose>> FirstPose::make(const world::Map& map, const std::string& map_file,
                                                   const geometry::Camera& camera, const geometry::Pose& X_RC,
                                                   const config::Localization& config) {
  const GlobalLocalizerParameters parameters;
  const behavior::FreeFloor floor(map, {.min_clearance_m = parameters.clearance_m});
  if (floor.width_m() * floor.depth_m() > kMostFloor_m2) {
    return fail(fmt::format(
        "{}: covers {:.0f} x {:.0f} m: --anywhere searches at most {:.0f} square metres; is the map in metres "
        "(--scale)?",
        map_file, floor.width_m(), floor.depth_m(), kMostFloor_m2));
  }
  auto places = global_localization::grid_of_places(map, parameters.spacing_m,
                                                    [&](double x_m, double y_m) { return floor.is_free(x_m, y_m); });
  if (places.empty()) {
    return fail(fmt::format("{}: --anywhere needs a map with free floor: no place in it is {} m from everything",
                            map_file, parameters.clearance_m));
  }
  return std::unique_ptr<FirstPose>(new FirstPose(map, camera, X_RC, config, std::move(places)));
}

FirstPose::FirstPose(const world::Map& map, const geometry::Camera& camera, const geometry::Pose& X_RC,
                     const config::Localization& config, std::vector<Eigen::Vector2d> places_m)
    : places_(places_m.size()),
      localizer_(map, camera, config.localizer),
      searcher_(map, camera, X_RC, std::move(places_m), localizer_, config.tracker, {}) {}

bool FirstPose::see(const ImageView& image, const geometry::Pose& X_OR, WorkBudget& budget) {
  if (searcher_.phase() == Phase::kAmbiguous || searcher_.phase() == Phase::kNotFound) searcher_.restart();
  // About the floor instead of an axle of unknown height, as when following.
  const Phase phase =
      searcher_.update(image, {.X_OR = X_OR, .pitch_rad = geometry::pitch_of(X_OR), .axle_height_m = 0.0}, budget);
  if (phase >= Phase::kFound) describe();
  return phase == Phase::kFound;
}

void FirstPose::describe() {
  candidates_.assign(searcher_.candidates().begin(), searcher_.candidates().end());
  outcome_ = fmt::format("first pose: {}", to_string(searcher_.phase()));
  for (const Candidate& candidate : candidates_) {
    const Eigen::Vector3d& place = candidate.X_WR.translation();
    outcome_ += fmt::format(
        "\n  at {:.2f} {:.2f} m, heading {:.0f} degrees: likeness {:.2f}, {}", place.x(), place.y(),
        geometry::heading_of(candidate.X_WR) * 180.0 / std::numbers::pi, candidate.likeness,
        candidate.tried ? fmt::format("corrected in {} of the images of the turn", candidate.corrected) : "not tried");
  }
}

}  // namespace cgsr::app
