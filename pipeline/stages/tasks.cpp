#include "pipeline/stages/tasks.h"

#include <cmath>

namespace cgsr::stages {
namespace {

behavior::PlanarPose pose_to_drive_by(const runtime::Aged<PoseEstimate>& pose) {
  behavior::PlanarPose here = pose.value.robot;
  here.known = here.known && pose.within(kMaxPoseAge) != nullptr;
  return here;
}

/// What the behaviour needs of the lamp. A report that is too old says no more than that there is a board.
behavior::LampBelief lamp_belief(const runtime::Aged<LampReport>& aged, const runtime::Aged<ShadowMasks>& shade) {
  using illumination::ObservationStatus;
  behavior::LampBelief belief;
  belief.has_board = aged.value.has_board;
  const LampReport* const report = aged.within(kMaxLampReportAge);
  if (report == nullptr) return belief;
  const bool registered =
      report->observation == ObservationStatus::kSeen || report->observation == ObservationStatus::kNoShadow;
  belief.readable = report->switching() || (registered && !report->cone_missing);
  belief.probes_check = report->probes_check.state;
  belief.lamp_proof = report->lamp_proof.state;
  belief.seen = report->single_image.status == illumination::LampStatus::kFound;
  const ShadowMasks* const masks = shade.within(TrackStage::kMaxMaskAge);
  belief.masked = masks != nullptr && masks->status == ShadeStatus::kMasked;
  belief.known = report->known;
  if (!report->known) return belief;
  belief.x_m = report->lamp.p_WL.x();
  belief.y_m = report->lamp.p_WL.y();
  belief.z_m = report->lamp.p_WL.z();
  belief.sigma_m = std::sqrt(report->lamp.covariance.trace());
  return belief;
}

}  // namespace

Decision FollowTask::decide(const FrameResult& frame, const ImageView& image, Duration elapsed) {
  const color::TrackedObject& object = frame.objects.value.first().object;
  const behavior::FollowDecision follow = follow_.decide(
      {object.found, object.box, frame.objects.age, image.width_px, image.height_px, camera_.fx_px, camera_.cx_px},
      elapsed);
  return {follow.goal, follow.halt, behavior::to_string(follow.state), behavior::to_string(follow.reason), {}};
}

Decision RouteTask::decide(const FrameResult& frame, const ImageView& /*image*/, Duration elapsed) {
  const behavior::RouteDecision route = route_.decide(pose_to_drive_by(frame.pose), elapsed);
  return {route.goal, route.halt, behavior::to_string(route.state), {}, {}};
}

Decision LampTask::decide(const FrameResult& frame, const ImageView& /*image*/, Duration elapsed) {
  const behavior::SeekDecision seek =
      seek_.decide(pose_to_drive_by(frame.pose), lamp_belief(frame.lamp, frame.shade), elapsed);
  Decision decision{seek.goal, seek.halt, behavior::to_string(seek.state), behavior::to_string(seek.reason), {}};
  decision.requests.track = seek_.tracks();
  decision.requests.check = seek.make_sure;
  return decision;
}

}  // namespace cgsr::stages
