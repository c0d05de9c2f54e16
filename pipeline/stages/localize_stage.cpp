#include "pipeline/stages/localize_stage.h"

#include <utility>

#include "pipeline/global_localization/global_localizer.h"
#include "pipeline/localization/perceive.h"
#include "pipeline/stages/odometry_track.h"

namespace cgsr::stages {

using global_localization::Phase;

namespace {

bool is_without_answer(Phase phase) {
  return phase == Phase::kAmbiguous || phase == Phase::kNotFound;
}

}  // namespace

LocalizeStage::LocalizeStage(LocalizationSetup setup)
    : map_(std::move(setup.map)),
      X_CR_(setup.X_RC.inverse()),
      axle_height_m_(setup.axle_height_m),
      camera_(setup.camera),
      working_(localization::working_camera(setup.camera)),
      localizer_(*map_, setup.camera, setup.localizer, std::move(setup.expectation)),
      tracker_(localizer_, setup.X_RC, setup.tracking),
      self_mask_(std::move(setup.self_mask)),
      seek_turn_radps_(setup.seek_turn_radps),
      seek_again_after_(setup.seek_again_after) {
  if (!setup.places_m.empty()) {
    whole_map_ = std::make_unique<global_localization::GlobalLocalizer>(
        *map_, camera_, setup.X_RC, std::move(setup.places_m), localizer_, setup.tracking,
        global_localization::GlobalLocalizerParameters{});
  }
  seeks_ = whole_map_ != nullptr && setup.seeks_first_pose;
  if (!seeks_) tracker_.start(setup.start);
}

LocalizeStage::~LocalizeStage() = default;

bool LocalizeStage::takes(const ImageView& image) const {
  return (image.width_px == camera_.width_px && image.height_px == camera_.height_px) ||
         (image.width_px == working_.width_px && image.height_px == working_.height_px);
}

void LocalizeStage::carry_on(const hal::Odometry& odometry) {
  const geometry::Pose X_OR = pose_of(odometry, axle_height_m_);
  // While it is sought the localizer looks at images of before, which this motion does not move.
  if (X_OR_ && !seeks_) carry(X_OR_->inverse() * X_OR);
  X_OR_ = X_OR;
  pitch_rad_ = odometry.pitch_rad;
  lean(odometry.pitch_rad, axle_height_m_);
}

PoseEstimate LocalizeStage::update(WorkBudget& budget, const ImageView& image, const runtime::Aged<View>& view,
                                   const std::optional<hal::Odometry>& odometry) {
  const View* const now = view.within(Duration::zero());
  if (now == nullptr || !now->reduced) {
    PoseEstimate unseen;
    if (seeks_) tell_search(unseen);
    unseen.turn_radps = 0.0;
    return unseen;
  }
  if (odometry) carry_on(*odometry);
  const ImageView grey = now->grey();
  const ImageView& seen = takes(grey) ? grey : image;
  if (seeks_) return seek_pose(budget, seen);
  PoseEstimate pose = update(budget, seen);
  if (whole_map_ == nullptr || !odometry) return pose;
  time_lost_.add(pose.camera, odometry->stamp);
  if (seek_again_after_ > Duration::zero() && time_lost_.lasted() >= seek_again_after_) seek_anew(pose);
  return pose;
}

void LocalizeStage::tell_search(PoseEstimate& pose) const {
  pose.search = whole_map_->phase();
  pose.anew = anew_;
  const double turn_radps = whole_map_->turns_back() ? -seek_turn_radps_ : seek_turn_radps_;
  pose.turn_radps = X_OR_ && whole_map_->wants_turn() ? turn_radps : 0.0;
}

PoseEstimate LocalizeStage::seek_pose(WorkBudget& budget, const ImageView& image) {
  PoseEstimate pose;
  pose.has_map = true;
  pose.anew = anew_;
  pose.camera.correction.reason = localization::Reason::kSearching;
  const Phase before = whole_map_->phase();
  if (X_OR_ && !is_without_answer(before))
    whole_map_->update(image, {*X_OR_, pitch_rad_, axle_height_m_}, budget, mask());
  const Phase phase = whole_map_->phase();
  if (phase != before) pose.events.add({pose.sought(), to_string(phase), {}});
  if (phase == Phase::kFound) {
    seeks_ = false;
    pose.camera = whole_map_->found();
    tracker_.take_over({pose.camera.X_WC, pose.camera.correction.covariance});
    tell(pose);
  } else if (is_without_answer(phase) && phase != before) {
    turn_led_nowhere(pose);
  }
  if (seeks_) tell_search(pose);
  return pose;
}

void LocalizeStage::turn_led_nowhere(PoseEstimate& pose) {
  if (++turns_ < kMaxTurns) {
    whole_map_->restart();
  } else if (anew_) {
    go_on_lost(pose);
  }
}

void LocalizeStage::seek_anew(PoseEstimate& pose) {
  whole_map_->restart();
  X_OR_lost_ = *X_OR_;
  turns_ = 0;
  time_lost_ = {};
  seeks_ = anew_ = true;
  tell_search(pose);
  pose.events.add({pose.sought(), to_string(pose.search), "lost for long"});
}

// The turns on the spot end about where they began, but the odometry knows their sum worse than the one step that is made of it says.
void LocalizeStage::go_on_lost(PoseEstimate& pose) {
  seeks_ = false;
  localizer_.restart();
  carry(X_OR_lost_.inverse() * *X_OR_);
  time_lost_.give_up();
  pose.camera = tracker_.now();
  pose.camera.correction = {.reason = localization::Reason::kSearching};
  pose.events.add({"pose", to_string(pose.camera.state), "goes on from where it was lost"});
  tell(pose);
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
