// The steps that make the stage of chapter 6 out of files: the cascade and the people who are known.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "src/boot/robot_plan.h"
#include "src/input/face_detector_file.h"
#include "src/input/identities_file.h"
#include "src/tasks/recognition_task.h"

namespace cgsr::boot {

/// Who is known. A file that is not there is an error: a robot that is to identify people does not begin without any.
Result<void> load_people(RobotState& state) {
  const config::Person& config = state.setup.config.person;
  if (!config.knows_faces()) return {};
  auto identities = app::load_identities(config.identities);
  if (!identities) return tl::unexpected(identities.error());
  if (identities->people.empty()) {
    return fail(
        fmt::format("{}: nobody is enrolled; cgsr people enroll --identities FILE --name NAME --input IMAGES does it",
                    config.identities));
  }
  const person::Label asked = state.setup.config.task.person.number;
  const bool by_marker = config.identifier.marker.enabled && config.identifier.marker.number == asked;
  if (asked != person::kStranger && !by_marker && state.setup.config.follows_person() &&
      std::ranges::find(identities->people, asked, &person::Identity::number) == identities->people.end()) {
    return fail(fmt::format("task.person.number = {}: nobody in {} has that number", asked, config.identities));
  }
  state.report.notes.push_back(fmt::format("people: {} enrolled", identities->people.size()));
  auto detector = app::read_face_detector(config.cascade, config.identifier.detector);
  if (!detector) return tl::unexpected(detector.error());
  auto eyes = app::read_eye_detector(config.eye_cascade);
  if (!eyes) return tl::unexpected(eyes.error());
  state.vision.face_detector = std::move(*detector);
  state.vision.people.emplace(person::gallery_of(*identities, config.identifier.match), std::move(*eyes));
  return {};
}

/// The stage that identifies people, by a marker alone where no faces are known. Live, faces are named on a thread of their own; in lock-step so many images
/// later.
Result<void> make_people(RobotState& state) {
  const config::Person& config = state.setup.config.person;
  if (!config.enabled()) return {};
  person::IdentifierParameters parameters = config.identifier;
  person::ShirtParameters& shirt = parameters.tracker.shirt;
  shirt.max_width_px = std::max(shirt.max_width_px, state.devices.mode.width_px);
  shirt.max_height_px = std::max(shirt.max_height_px, state.devices.mode.height_px);
  std::unique_ptr<person::FaceRecognizer> recognizer;
  if (!state.vision.people) {
    state.report.notes.push_back(
        fmt::format("people: number {} by marker {}", parameters.marker.number, parameters.marker.id));
  } else if (state.setup.live()) {
    recognizer = std::make_unique<tasks::LinkedRecognizer>(state.links);
  } else {
    recognizer =
        std::make_unique<person::SteppedRecognizer>(std::move(*state.vision.people), parameters.answer_after_images);
    state.vision.people.reset();
  }
  state.vision.parts.make<stages::IdentifyStage>(std::move(state.vision.face_detector), std::move(recognizer),
                                                 parameters);
  return {};
}

}  // namespace cgsr::boot
