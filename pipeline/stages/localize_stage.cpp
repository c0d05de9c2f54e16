#include "pipeline/stages/localize_stage.h"

#include <utility>

#include "pipeline/localization/perceive.h"
#include "pipeline/stages/odometry_track.h"

namespace cgsr::stages {

LocalizeStage::LocalizeStage(LocalizationSetup setup)
    : map_(std::move(setup.map)),
      X_CR_(setup.X_RC.inverse()),
      axle_height_m_(setup.axle_height_m),
      camera_(setup.camera),
      working_(localization::working_camera(setup.camera)),
      localizer_(*map_, setup.camera, setup.localizer, std::move(setup.expectation)),
      tracker_(localizer_, setup.X_RC, setup.tracking),
      self_mask_(std::move(setup.self_mask)) {
  tracker_.start(setup.start);
}

bool LocalizeStage::takes(const ImageView& image) const {
  return (image.width_px == camera_.width_px && image.height_px == camera_.height_px) ||
         (image.width_px == working_.width_px && image.height_px == working_.height_px);
}

void LocalizeStage::carry_on(const hal::Odometry& odometry) {
  const geometry::Pose X_OR = pose_of(odometry, axle_height_m_);
  if (X_OR_) carry(X_OR_->inverse() * X_OR);
  X_OR_ = X_OR;
  lean(odometry.pitch_rad, axle_height_m_);
}

PoseEstimate LocalizeStage::update(WorkBudget& budget, const ImageView& image, const runtime::Aged<View>& view,
                                   const std::optional<hal::Odometry>& odometry) {
  const View* const now = view.within(Duration::zero());
  if (now == nullptr || !now->reduced) return {};
  if (odometry) carry_on(*odometry);
  const ImageView grey = now->grey();
  return update(budget, takes(grey) ? grey : image);
}

PoseEstimate LocalizeStage::update(WorkBudget& budget, const ImageView& image) {
  PoseEstimate pose;
  pose.has_map = true;
  pose.camera = tracker_.see(image, budget, mask());
  const geometry::Pose X_WR = pose.camera.X_WC * X_CR_;
  const bool known = pose.camera.state == localization::TrackState::kTracking ||
                     pose.camera.state == localization::TrackState::kRecovered;
  if (pose.camera.state != state_) {
    pose.events.add({"pose", to_string(pose.camera.state), to_string(pose.camera.correction.reason)});
  }
  state_ = pose.camera.state;
  pose.robot = {known, X_WR.translation().x(), X_WR.translation().y(), geometry::heading_of(X_WR)};
  return pose;
}

localization::Correction LocalizeStage::correct(WorkBudget& budget, const ImageView& image,
                                                const localization::Prior& prior) {
  return localizer_.correct(image, prior, budget, mask());
}

}  // namespace cgsr::stages
