#include "pipeline/stages/localize_stage.h"

#include <utility>

#include "pipeline/global_localization/global_localizer.h"
#include "pipeline/localization/perceive.h"
#include "pipeline/stages/odometry_track.h"

namespace cgsr::stages {

using global_localization::Phase;

LocalizeStage::LocalizeStage(LocalizationSetup setup)
    : map_(std::move(setup.map)),
      X_CR_(setup.X_RC.inverse()),
      axle_height_m_(setup.axle_height_m),
      camera_(setup.camera),
      working_(localization::working_camera(setup.camera)),
      localizer_(*map_, setup.camera, setup.localizer, std::move(setup.expectation)),
      tracker_(localizer_, setup.X_RC, setup.tracking),
      self_mask_(std::move(setup.self_mask)),
      first_turn_radps_(setup.first_turn_radps) {
  if (setup.start_places_m.empty()) {
    tracker_.start(setup.start);
  } else {
    first_pose_ = std::make_unique<global_localization::GlobalLocalizer>(
        *map_, camera_, setup.X_RC, std::move(setup.start_places_m), localizer_, setup.tracking,
        global_localization::GlobalLocalizerParameters{});
  }
}

LocalizeStage::~LocalizeStage() = default;

bool LocalizeStage::seeks_first_pose() const {
  return first_pose_ != nullptr && first_pose_->phase() != Phase::kFound;
}

bool LocalizeStage::takes(const ImageView& image) const {
  return (image.width_px == camera_.width_px && image.height_px == camera_.height_px) ||
         (image.width_px == working_.width_px && image.height_px == working_.height_px);
}

void LocalizeStage::carry_on(const hal::Odometry& odometry) {
  const geometry::Pose X_OR = pose_of(odometry, axle_height_m_);
  // While it is sought the localizer looks at images of before, which this motion does not move.
  if (X_OR_ && !seeks_first_pose()) carry(X_OR_->inverse() * X_OR);
  X_OR_ = X_OR;
  pitch_rad_ = odometry.pitch_rad;
  lean(odometry.pitch_rad, axle_height_m_);
}

PoseEstimate LocalizeStage::update(WorkBudget& budget, const ImageView& image, const runtime::Aged<View>& view,
                                   const std::optional<hal::Odometry>& odometry) {
  const View* const now = view.within(Duration::zero());
  if (now == nullptr || !now->reduced) {
    PoseEstimate unseen;
    if (first_pose_ != nullptr) unseen.first_pose = first_pose_->phase();
    return unseen;
  }
  if (odometry) carry_on(*odometry);
  const ImageView grey = now->grey();
  const ImageView& seen = takes(grey) ? grey : image;
  return seeks_first_pose() ? seek_first_pose(budget, seen) : update(budget, seen);
}

PoseEstimate LocalizeStage::seek_first_pose(WorkBudget& budget, const ImageView& image) {
  PoseEstimate pose;
  pose.has_map = true;
  pose.camera.correction.reason = localization::Reason::kSearching;
  const Phase before = first_pose_->phase();
  const bool given_up = before == Phase::kAmbiguous || before == Phase::kNotFound;
  if (X_OR_ && !given_up) first_pose_->update(image, {*X_OR_, pitch_rad_, axle_height_m_}, budget, mask());
  const Phase phase = first_pose_->phase();
  if (phase != before) pose.events.add({"first pose", to_string(phase), {}});
  if (phase == Phase::kFound) {
    pose.camera = first_pose_->found();
    tracker_.start({pose.camera.X_WC, pose.camera.correction.covariance});
    tell(pose);
  } else if ((phase == Phase::kAmbiguous || phase == Phase::kNotFound) && !given_up && ++first_turns_ < kFirstTurns) {
    first_pose_->restart();
  }
  pose.first_pose = first_pose_->phase();
  pose.turn_radps = X_OR_ && first_pose_->wants_turn() ? first_turn_radps_ : 0.0;
  return pose;
}

PoseEstimate LocalizeStage::update(WorkBudget& budget, const ImageView& image) {
  PoseEstimate pose;
  pose.has_map = true;
  pose.camera = tracker_.see(image, budget, mask());
  tell(pose);
  return pose;
}

void LocalizeStage::tell(PoseEstimate& pose) {
  const geometry::Pose X_WR = pose.camera.X_WC * X_CR_;
  const bool known = pose.camera.state == localization::TrackState::kTracking ||
                     pose.camera.state == localization::TrackState::kRecovered;
  if (pose.camera.state != state_) {
    pose.events.add({"pose", to_string(pose.camera.state), to_string(pose.camera.correction.reason)});
  }
  state_ = pose.camera.state;
  pose.robot = {known, X_WR.translation().x(), X_WR.translation().y(), geometry::heading_of(X_WR)};
}

localization::Correction LocalizeStage::correct(WorkBudget& budget, const ImageView& image,
                                                const localization::Prior& prior) {
  return localizer_.correct(image, prior, budget, mask());
}

}  // namespace cgsr::stages
