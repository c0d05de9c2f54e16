#include "pipeline/localization/pose_tracker.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace cgsr::localization {
namespace {

using geometry::Matrix6d;
using geometry::Pose;

constexpr double kDegree = std::numbers::pi / 180.0;

// An error that is the same share of every step adds up along the way: what this step adds to the variance.
double grown(double share, double before, double step) {
  return share * share * (2.0 * before * step + step * step);
}

// Nothing was seen: that is no evidence that the pose is elsewhere.
bool says_nothing(Reason reason) {
  return reason == Reason::kSearching || reason == Reason::kWrongSize || reason == Reason::kTooDark ||
         reason == Reason::kTooBright || reason == Reason::kTooFewEdges || reason == Reason::kNoBudget ||
         reason == Reason::kNoMap;
}

// There is nothing to see of the map: a bare wall, or what the map does not hold. The image itself is a good one.
bool shows_nothing(Reason reason) {
  return reason == Reason::kTooFewEdges || reason == Reason::kNothingExpected;
}

}  // namespace

std::string_view to_string(TrackState state) {
  switch (state) {
    case TrackState::kUnsure:
      return "unsure";
    case TrackState::kTracking:
      return "tracking";
    case TrackState::kLost:
      return "lost";
    case TrackState::kRecovered:
      return "recovered";
  }
  return "";
}

PoseTracker::PoseTracker(Localizer& localizer, const Pose& X_RC, const PoseTrackerParameters& parameters)
    : localizer_(&localizer), X_RC_(X_RC), parameters_(parameters) {}

void PoseTracker::start(const Prior& prior) {
  localizer_->restart();
  now_ = TrackedPose{};
  now_.X_WC = prior.X_WC;
  now_.covariance = prior.covariance;
  belief_ = prior.covariance;
  driven_m_ = 0.0;
  turned_rad_ = 0.0;
}

void PoseTracker::take_over(const Prior& confirmed) {
  start(confirmed);
  now_.state = TrackState::kTracking;
  now_.covariance = localizer_->in_world(belief_);
}

void PoseTracker::moved(const Pose& X_R0R1) {
  if (!X_R0R1.matrix().allFinite()) return;
  const Pose X_C0C1 = X_RC_.inverse() * X_R0R1 * X_RC_;
  const Eigen::Vector3d way_W = now_.X_WC.linear() * X_C0C1.translation();
  // An error of the direction swings what comes after it.
  Matrix6d F = Matrix6d::Identity();
  F.topRightCorner<3, 3>() << 0.0, way_W.z(), -way_W.y(), -way_W.z(), 0.0, way_W.x(), way_W.y(), -way_W.x(), 0.0;
  belief_ = F * belief_ * F.transpose();
  now_.X_WC = geometry::normalized(now_.X_WC * X_C0C1);

  const double way_m = X_R0R1.translation().norm();
  const double turn_rad = geometry::vector_of(X_R0R1.linear()).norm();
  const double place = grown(parameters_.slip, driven_m_, way_m) + parameters_.drift_m * parameters_.drift_m;
  const double drift_rad = parameters_.drift_deg * kDegree;
  const double turn = grown(parameters_.slip_turn, turned_rad_, turn_rad) + drift_rad * drift_rad;
  driven_m_ += way_m;
  turned_rad_ += turn_rad;
  belief_(0, 0) += place;
  belief_(1, 1) += place;
  belief_(5, 5) += turn;
  if (!parameters_.floor) {
    belief_(2, 2) += place;
    belief_(3, 3) += turn;
    belief_(4, 4) += turn;
  }
  now_.covariance = localizer_->in_world(belief_);
  localizer_->carried(X_C0C1);
}

// A robot on a level floor: its height is the mount's. Roll and pitch are the mount's too, which was told a little wrong:
// what good views showed of that is kept for those that show nothing of it, for before a wall a roll that is off by a
// third of a degree looks like a heading that is off by one. It is forgotten slowly, back to what was told. The camera stays
// above where it was: turned about the wheels instead, a mount that is told wrong would push it aside at every image.
void PoseTracker::flatten() {
  const double kept = parameters_.tilt_kept;
  const Eigen::Vector3d axle(0.0, 0.0, axle_height_m_);
  Pose tilt = Pose::Identity();
  tilt.linear() = Eigen::AngleAxisd(pitch_rad_, Eigen::Vector3d::UnitY()).toRotationMatrix();
  tilt.translation() = axle - tilt.linear() * axle;
  const Pose X_WR = now_.X_WC * X_RC_.inverse() * tilt.inverse();
  const Pose level = geometry::pose_on_floor(0.0, 0.0, geometry::heading_of(X_WR)) * tilt * X_RC_;
  Eigen::Vector3d off_level = geometry::vector_of(now_.X_WC.linear() * level.linear().transpose());
  off_level.z() = 0.0;
  now_.X_WC.linear() = geometry::rotation_of(kept * off_level) * level.linear();
  now_.X_WC.translation().z() = level.translation().z();

  Matrix6d& covariance = belief_;
  covariance.row(2).setZero();
  covariance.col(2).setZero();
  covariance(2, 2) = parameters_.height_m * parameters_.height_m;
  const double tilt_rad = parameters_.tilt_deg * kDegree;
  const double level_rad = parameters_.level_deg * kDegree;
  for (const int i : {3, 4}) {
    covariance.row(i) *= kept;
    covariance.col(i) *= kept;
    const double forgotten = (1.0 - kept * kept) * tilt_rad * tilt_rad;
    covariance(i, i) = std::max(covariance(i, i) + forgotten, level_rad * level_rad);
  }
}

void PoseTracker::widen() {
  const double wide_rad = parameters_.max_lost_sigma_deg * kDegree;
  for (int i = 0; i < 6; ++i) {
    if (parameters_.floor && i >= 2 && i <= 4) continue;
    const double most = i < 3 ? parameters_.max_lost_sigma_m : wide_rad;
    const double sigma = std::sqrt(belief_(i, i));
    // Scaling rows and columns alike keeps it a covariance.
    const double factor = std::max(1.0, std::min(parameters_.widen, most / sigma));
    belief_.row(i) *= factor;
    belief_.col(i) *= factor;
  }
}

// Carried along for so long that only a search would find it again.
bool PoseTracker::has_outgrown() const {
  const double place = std::sqrt(std::max(belief_(0, 0), belief_(1, 1)));
  return place > parameters_.max_sigma_m || std::sqrt(belief_(5, 5)) > parameters_.max_sigma_deg * kDegree;
}

const TrackedPose& PoseTracker::see(const ImageView& image, WorkBudget& budget, const std::uint8_t* mask) {
  if (parameters_.floor) flatten();
  now_.correction = localizer_->correct(image, {.X_WC = now_.X_WC, .covariance = belief_}, budget, mask);
  if (now_.correction.corrected) {
    now_.X_WC = now_.correction.X_WC;
    belief_ = now_.correction.covariance;
    now_.images_since_correction = 0;
    now_.failures = 0;
    driven_m_ = 0.0;
    turned_rad_ = 0.0;
    now_.state = now_.state == TrackState::kLost ? TrackState::kRecovered : TrackState::kTracking;
  } else {
    was_not_corrected();
  }
  now_.covariance = localizer_->in_world(belief_);
  return now_;
}

void PoseTracker::was_not_corrected() {
  ++now_.images_since_correction;
  if (now_.state == TrackState::kRecovered) now_.state = TrackState::kTracking;
  const bool first_search = now_.state == TrackState::kUnsure && now_.failures == 0 && localizer_->searching();
  if (!first_search && !shows_nothing(now_.correction.reason)) ++now_.failures;
  const bool outgrown = now_.state == TrackState::kTracking && has_outgrown();
  if (outgrown || now_.failures >= parameters_.max_missed_corrections) now_.state = TrackState::kLost;
  if (now_.state == TrackState::kLost && !says_nothing(now_.correction.reason)) widen();
}

}  // namespace cgsr::localization
