#pragma once

#include <cstdint>
#include <string_view>

#include "pipeline/behavior/finals_parameters.h"
#include "pipeline/person/tracking/shirt_memory.h"
#include "pipeline/stages/tasks.h"

namespace cgsr::stages {

/// What the robot of the Finals is about.
enum class FinalsState : std::uint8_t {
  kMeeting,  ///< waits for the person's face.
  kWith,     ///< is with the person, or with whom it takes for that person by the shirt.
  kSeeking,  ///< was with a stranger: looks for the person.
};
std::string_view to_string(FinalsState state);

/// The demonstration of the Finals (6.4.3): follows a person by face and shirt as FollowPersonTask does; tells when it sees that whom it follows is
/// somebody else, a stranger or another one who is enrolled; turns then to look for the person, whom the face alone proves; and tells when it has found the
/// person again and whether the shirt is another one. What is said is an event of the source `says`, with numbers, never a name.
class FinalsTask final : public Task {
 public:
  /// \param person  the number in the identities file, > 0.  \param camera  of the images that come.  \param light  as FollowPersonTask's.
  FinalsTask(const behavior::FinalsParameters& finals, const behavior::FollowPersonParameters& person,
             const behavior::FollowParameters& follow, const behavior::DriveLimits& limits,
             const geometry::Camera& camera, const behavior::FillLightParameters& light = {});
  [[nodiscard]] Requests first_requests() const override { return follow_.first_requests(); }
  Decision decide(const FrameResult& frame, const ImageView& image, Duration elapsed) override;

  [[nodiscard]] FinalsState state() const { return state_; }
  /// As FollowPersonTask's.
  void keep_to(std::shared_ptr<const behavior::FreeFloor> floor) { follow_.keep_to(std::move(floor)); }

 private:
  void see_person(const person::PersonSighting& who, const ImageView& image, Events& events);
  void see_somebody_else(Events& events);
  void lose(Events& events);
  void say(std::string_view words, Events& events) const;

  behavior::FinalsParameters parameters_;
  person::Label person_;
  FollowPersonTask follow_;
  person::ShirtMemory shirt_;
  FinalsState state_ = FinalsState::kMeeting;
  int person_images_ = 0;  // in a row, of those with a face, with the person's
  int other_images_ = 0;   // with somebody else's
  bool shirt_told_ = true;
};

}  // namespace cgsr::stages
