#pragma once

#include <memory>
#include <string>

#include "pipeline/geometry/camera.h"
#include "pipeline/global_localization/global_localizer.h"
#include "pipeline/localization/localizer.h"
#include "pipeline/world/map.h"
#include "platform/error.h"
#include "src/config/localization.h"

namespace cgsr::app {

/// Finds the first pose of a robot that turns on the spot, for `cgsr localize --anywhere`: with a localizer of its own, from every place of the map's free
/// floor.
class FirstPose {
 public:
  /// \param map  outlives it.  \param map_file  its name, for the error's words: it has no free floor, or too much.
  static Result<std::unique_ptr<FirstPose>> make(const world::Map& map, const std::string& map_file,
                                                 const geometry::Camera& camera, const geometry::Pose& X_RC,
                                                 const config::Localization& config);

  /// Looks at the next image. Where the search ended without a pose it begins anew.
  /// \param X_OR  where the odometry says the robot is. \return whether the pose is found.
  bool see(const ImageView& image, const geometry::Pose& X_OR, WorkBudget& budget);

  [[nodiscard]] const localization::TrackedPose& found() const { return searcher_.found(); }
  [[nodiscard]] global_localization::Phase phase() const { return searcher_.phase(); }
  [[nodiscard]] std::size_t places() const { return places_; }
  /// What the last search that ended came to: where the robot may be, a line each, the most alike first.
  [[nodiscard]] const std::string& outcome() const { return outcome_; }
  /// Its candidates.
  [[nodiscard]] const std::vector<global_localization::Candidate>& candidates() const { return candidates_; }

 private:
  FirstPose(const world::Map& map, const geometry::Camera& camera, const geometry::Pose& X_RC,
            const config::Localization& config, std::vector<Eigen::Vector2d> places_m);

  void describe();

  std::size_t places_;
  localization::Localizer localizer_;
  global_localization::GlobalLocalizer searcher_;
  std::vector<global_localization::Candidate> candidates_;
  std::string outcome_;
};

}  // namespace cgsr::app
