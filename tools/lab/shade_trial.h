#pragma once

#include <memory>

#include "pipeline/runtime/stage_budget.h"
#include "pipeline/stages/shade_stage.h"
#include "pipeline/stages/track_stage.h"
#include "platform/error.h"
#include "src/config/robot.h"

namespace cgsr::lab {

/// \return a stage's row of the robot's schedule.
template <class Worker>
runtime::StageParameters row_of(const config::Robot& robot) {
  VisionStages rows = robot.stage;
  return rows.of<Worker>();
}

/// The units of work that a row of the schedule grants one run; 0 there grants all.
runtime::StageBudget budget_of(const runtime::StageParameters& row);

/// What a robot does not know, and states: together about 1.6 cm and 0.17 degrees of pose, 2.5 cm of lamp.
struct StatedErrors {
  double place_sigma_m = 0.010;  ///< of the camera, each axis.
  double turn_sigma_rad = 0.0018;
  double lamp_sigma_m = 0.016;

  [[nodiscard]] geometry::Matrix6d pose() const;
  [[nodiscard]] illumination::KnownLamp lamp(const Eigen::Vector3d& p_WL) const;
};

/// The masks that the stage gives a camera which stands still: turn after turn with the schedule's units, until a new place of the lamp is
/// prepared and there are masks.
/// \return what the stage says instead of masks.
Result<stages::ShadowMasks> masks_of(stages::ShadeStage& stage, const runtime::StageParameters& row,
                                     const geometry::Pose& X_WC, const geometry::Matrix6d& covariance,
                                     const illumination::KnownLamp& lamp);

/// The output of the stage for masks that come from elsewhere.
stages::ShadowMasks given_masks(shade::ShadeMasks masks);

/// The stage track for a ball (5.3), image after image with masks that are given, within the schedule's units.
class BallTracker {
 public:
  BallTracker(color::IntegratedTracker tracker, const runtime::StageParameters& row)
      : stage_(std::make_unique<stages::TrackStage>(std::move(tracker))), row_(row) {}

  /// \param masks  of this image; without any, dark histograms are searched everywhere.
  color::BallSighting track(const ImageView& image, const stages::ShadowMasks& masks);

 private:
  std::unique_ptr<stages::TrackStage> stage_;
  runtime::StageParameters row_;
};

}  // namespace cgsr::lab
