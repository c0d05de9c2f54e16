#include "pipeline/stages/search_people_task.h"

#include <array>
#include <span>
#include <utility>

#include "pipeline/stages/tasks.h"

namespace cgsr::stages {
namespace {

constexpr double kSmallHead = 0.85;  // of the width of a usual one

Event event_of(const behavior::PersonTold& told) {
  const bool stranger = told.number == person::kStranger;
  Event says{"says", told.in_the_end ? "there stands" : "here is", {}};
  if (stranger)
    says.state = told.in_the_end ? "there stands somebody whom I do not know" : "here is somebody whom I do not know";
  const auto add = [&says](std::string_view name, double value, std::string_view unit) {
    says.numbers[says.number_count++] = {name, value, unit};
  };
  if (!stranger) add("number", told.number, "");
  add("confidence", told.confidence, "");
  add("x", told.place.x_m, "m");
  add("y", told.place.y_m, "m");
  return says;
}

}  // namespace

SearchPeopleTask::SearchPeopleTask(behavior::SearchPeople search, const behavior::SearchPeopleParameters& parameters,
                                   const geometry::Camera& camera)
    : search_(std::move(search)), parameters_(parameters), camera_(camera) {}

std::optional<behavior::FaceInMap> SearchPeopleTask::in_map(const person::SeenFace& face,
                                                            const geometry::Pose& X_WC) const {
  if (face.box.width < kSmallHead * parameters_.min_face_px) return std::nullopt;
  const Eigen::Vector2d ideal = camera_.ideal_of({face.box.x + face.box.width / 2, face.box.y + face.box.height / 2});
  const double depth_m = parameters_.face_width_m * camera_.fx_px / face.box.width;
  const Eigen::Vector3d p_W = X_WC * Eigen::Vector3d(depth_m * ideal.x(), depth_m * ideal.y(), depth_m);
  if (p_W.z() < parameters_.min_face_height_m || p_W.z() > parameters_.max_face_height_m) return std::nullopt;
  const double nearness = face.box.width / parameters_.min_face_px;
  return behavior::FaceInMap{
      {p_W.x(), p_W.y()}, face.compared, face.person.value_or(person::kStranger), face.confidence, nearness * nearness};
}

Decision SearchPeopleTask::decide(const FrameResult& frame, const ImageView& /*image*/, Duration elapsed) {
  const behavior::PlanarPose here = pose_to_drive_by(frame.pose);
  std::array<behavior::FaceInMap, person::FaceTracks::kMaxFaces> faces{};
  std::size_t count = 0;
  const IdentifiedPeople* const people = frame.people.within(Duration::zero());
  if (people != nullptr && here.known) {
    for (const person::SeenFace& face : people->seen_faces()) {
      if (const auto placed = in_map(face, frame.pose.value.camera.X_WC)) faces[count++] = *placed;
    }
  }
  const behavior::SearchPeopleDecision search = search_.decide(here, std::span(faces).first(count), elapsed);
  Decision decision{search.goal, search.halt, behavior::to_string(search.state), {}, {}};
  if (search.told) decision.events.add(event_of(*search.told));
  return decision;
}

}  // namespace cgsr::stages
