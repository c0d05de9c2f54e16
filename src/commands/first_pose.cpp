#include "src/commands/first_pose.h"

#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "src/input/start_places.h"

namespace cgsr::app {
using global_localization::Candidate;
using global_localization::Phase;

Result<std::unique_ptr<FirstPose>> FirstPose::make(const world::Map& map, const std::string& map_file,
                                                   const geometry::Camera& camera, const geometry::Pose& X_RC,
                                                   const config::Localization& config) {
  auto places = start_places(map, map_file);
  if (!places) return tl::unexpected(places.error());
  return std::unique_ptr<FirstPose>(new FirstPose(map, camera, X_RC, config, std::move(*places)));
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
