#include "pipeline/stages/tasks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "pipeline/person/context.h"
#include "pipeline/person/face/face_detector.h"
#include "pipeline/stages/ball_track.h"

namespace cgsr::stages {
namespace {

// A face has its name for two comparisons at least, and by then the third, that of a face that is not sure, has been answered too.
constexpr int kStrangerImages = 12;

behavior::FollowParameters by_faces(behavior::FollowParameters follow) {
  follow.learned_distance_m = 1.0;
  return follow;
}

behavior::LearnedSize face_at_a_metre(double face_width_m, double fx_px) {
  return {face_width_m * fx_px, face_width_m * fx_px};
}

bool is_mostly_within(const Box& box, const ImageView& image) {
  const Box whole{0, 0, static_cast<double>(image.width_px), static_cast<double>(image.height_px)};
  return intersection(box, whole).area() > 0.5 * box.area();
}

/// Whoever stands before the robot has the face there.
Box where_faces_are(const ImageView& image) {
  return {image.width_px / 4.0, image.height_px / 8.0, image.width_px / 2.0, image.height_px / 2.0};
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
  const ShadowMasks* const masks = shade.within(kMaxMaskAge);
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

behavior::PlanarPose pose_to_drive_by(const runtime::Aged<PoseEstimate>& pose) {
  behavior::PlanarPose here = pose.value.robot;
  here.known = here.known && pose.within(kMaxPoseAge) != nullptr;
  return here;
}

Decision FollowTask::decide(const FrameResult& frame, const ImageView& image, Duration elapsed) {
  const color::TrackedObject& object = frame.objects.value.first().object;
  const behavior::FollowDecision follow = follow_.decide(
      {object.found, object.box, frame.objects.age, image.width_px, image.height_px, camera_.fx_px, camera_.cx_px},
      elapsed);
  return {follow.goal, follow.halt, behavior::to_string(follow.state), behavior::to_string(follow.reason), {}};
}

FollowPersonTask::FollowPersonTask(const behavior::FollowPersonParameters& person,
                                   const behavior::FollowParameters& follow, const behavior::DriveLimits& limits,
                                   const geometry::Camera& camera, const behavior::FillLightParameters& light)
    : person_(person.number),
      follow_(by_faces(follow), face_at_a_metre(person.face_width_m, camera.fx_px), limits),
      camera_(camera),
      deceleration_mps2_(limits.max_deceleration_mps2) {
  if (light.enabled) light_.emplace(light);
}

Requests FollowPersonTask::first_requests() const {
  Requests requests;
  if (person_ > person::kStranger) requests.person = person_;
  return requests;
}

// As large as the face would be, where the person was seen: one size for both characteristics.
behavior::Sighting FollowPersonTask::sighting_of(const person::PersonSighting& who, const ImageView& image) const {
  const double x = who.box.x + who.box.width / 2;
  const double y = who.box.y + who.box.height / 2;
  const Box face{x - who.face_px / 2, y - who.face_px / 2, who.face_px, who.face_px};
  return {true, face, {}, image.width_px, image.height_px, camera_.fx_px, camera_.cx_px};
}

bool FollowPersonTask::is_with_a_stranger() const {
  return stranger_images_ >= kStrangerImages;
}

void FollowPersonTask::look_above_the_shirt(const IdentifiedPeople& people) {
  const person::PersonSighting& who = people.person;
  if (who.person == person_ && who.source != person::PersonSource::kShirt) stranger_images_ = 0;
  if (!people.expected_face) return;
  for (const person::SeenFace& face : people.seen_faces()) {
    if (!face.compared || !person::same_face(face.box, *people.expected_face)) continue;
    stranger_images_ = face.person ? 0 : stranger_images_ + 1;
  }
}

// A face of plausible size is one that lies at its place; one that identifies the person is his wherever it is.
void FollowPersonTask::light_the_face(const IdentifiedPeople* people, const ImageView& image, Duration elapsed,
                                      Decision& decision) {
  if (!light_) return;
  behavior::FaceEvidence evidence;
  if (people != nullptr) {
    evidence.seen = people->person.source == person::PersonSource::kFace;
    if (evidence.seen) evidence.dark = person::context_of(image, people->person.box).dark;
    const bool nobody = people->person.source == person::PersonSource::kNone;
    if (nobody) {  // waits for a face that can be named: the light may show one, or whose a noisy one is
      evidence.seen = std::ranges::any_of(people->seen_faces(), &person::SeenFace::compared);
      evidence.lost = people->seen_faces().empty();
      evidence.expected = true;
      evidence.dark = person::mean_luma(image, where_faces_are(image)) <= light_->max_waiting_luma() ? 1.0 : 0.0;
    } else if (const auto& face = people->expected_face) {
      evidence.expected = is_mostly_within(*face, image);
      evidence.dark = person::context_of(image, *face).dark;
      for (const person::SeenFace& seen : people->seen_faces())
        evidence.seen = evidence.seen || person::same_face(seen.box, *face);
    }
  }
  const behavior::FillLightDecision light = light_->decide(evidence, elapsed);
  decision.requests.lamps[static_cast<std::size_t>(LampLine::kFillLight)] = light.on;
  if (!light.changed) return;
  Event event{"fill light", light.on ? "on" : "off", light.reason};
  if (evidence.expected) event.numbers[event.number_count++] = {"dark", evidence.dark, ""};
  decision.events.add(event);
}

void FollowPersonTask::keep_to_floor(const FrameResult& frame, Decision& decision) const {
  if (!floor_) return;
  const auto kept = behavior::keep_to_floor(*floor_, pose_to_drive_by(frame.pose), decision.goal, deceleration_mps2_);
  if (kept.forward_mps != decision.goal.forward_mps) decision.reason = "the map's free floor ends there";
  decision.goal = kept;
}

// Where the person was a moment ago is where he is, until somebody else stands there: faces are looked for in every other image.
Decision FollowPersonTask::decide(const FrameResult& frame, const ImageView& image, Duration elapsed) {
  const IdentifiedPeople* const people = frame.people.within(Duration::zero());
  const person::PersonSighting who = people != nullptr ? people->person : person::PersonSighting{};
  const PersonState state = people != nullptr ? IdentifiedPeople::state_of(*people) : PersonState::kNobody;
  const bool enrolled = state == PersonState::kEnrolled;
  if (person_ == person::kStranger && enrolled) person_ = *who.person;
  if (people != nullptr) look_above_the_shirt(*people);
  const bool is_person = enrolled && who.person == person_;
  if (last_) last_->age += elapsed;
  if ((who.person && !is_person) || is_with_a_stranger()) last_.reset();
  const bool primary = who.source == person::PersonSource::kFace || who.source == person::PersonSource::kMarker;
  const bool believed = primary || !(by_primary_only_ || is_with_a_stranger());
  if (is_person && believed && who.age_images == 0) last_ = sighting_of(who, image);
  const behavior::FollowDecision follow = follow_.decide(last_.value_or(behavior::Sighting{}), elapsed);
  std::string_view reason = behavior::to_string(follow.reason);
  if (!last_ && who.person) reason = enrolled ? "somebody else is in view" : "a stranger is in view";
  if (!last_ && state == PersonState::kUnsure) reason = "not sure who is in view";
  if (!last_ && is_with_a_stranger()) reason = "the face above the shirt is a stranger's";
  Decision decision{follow.goal, follow.halt, behavior::to_string(follow.state), reason, {}};
  decision.requests = first_requests();
  keep_to_floor(frame, decision);
  light_the_face(people, image, elapsed, decision);
  return decision;
}

Decision WhoIsWhoTask::decide(const FrameResult& frame, const ImageView& /*image*/, Duration elapsed) {
  std::array<behavior::FaceAtBearing, person::FaceTracks::kMaxFaces> faces{};
  std::size_t count = 0;
  if (const IdentifiedPeople* const people = frame.people.within(Duration::zero())) {
    for (const person::SeenFace& face : people->seen_faces()) {
      const double off_px = camera_.cx_px - (face.box.x + face.box.width / 2);
      faces[count++] = {std::atan2(off_px, camera_.fx_px), face.compared, face.person.value_or(person::kStranger),
                        face.confidence};
    }
  }
  const auto heading_rad = frame.odometry ? std::optional(frame.odometry->heading_rad) : std::nullopt;
  const behavior::LookAlongDecision look = look_.decide(std::span(faces).first(count), heading_rad, elapsed);
  Decision decision{look.goal, false, behavior::to_string(look.state), {}, {}};
  if (!look.told) return decision;
  Event says{"says", look.told->number == person::kStranger ? "here is somebody whom I do not know" : "here is", {}};
  const auto add = [&says](std::string_view name, double value, std::string_view unit) {
    says.numbers[says.number_count++] = {name, value, unit};
  };
  add("place", look.place, "");
  if (look.told->number != person::kStranger) add("number", look.told->number, "");
  add("confidence", look.told->confidence, "");
  add("bearing", look.told->bearing_rad * 180.0 / std::numbers::pi, "deg");
  decision.events.add(says);
  return decision;
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
