#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "pipeline/person/tracking/identifier.h"
#include "pipeline/runtime/schedule.h"
#include "pipeline/stages/events.h"
#include "pipeline/stages/requests.h"
#include "platform/description.h"

namespace cgsr::stages {

/// Whether somebody is identified. Unsure: a face is in view, and nobody is identified yet. Ours.
enum class PersonState : std::uint8_t { kNobody, kEnrolled, kStranger, kUnsure };
std::string_view to_string(PersonState state);

/// Who is in view. People have numbers here and everywhere behind it; their names stand in the identities file alone.
struct IdentifiedPeople : person::PeopleInView {
  Events events{};  ///< that somebody was identified, or no longer is.

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    const bool somebody = self.person.person.has_value();
    const Box& box = self.person.box;
    visit.choice("person", state_of(self), PersonState::kUnsure, "who is identified");
    visit.integer("person_number", self.person.person, "", "the number in the identities file; 0 for a stranger");
    visit.choice("person_by", self.person.source, person::PersonSource::kMarker,
                 "the characteristic that identified the person");
    visit.number("person_confidence", when(somebody, self.person.confidence), {3}, "", "how likely this is right");
    visit.number("person_x_px", when(somebody, box.x), {1}, "px", "left edge of what identified the person");
    visit.number("person_y_px", when(somebody, box.y), {1}, "px", "its upper edge");
    visit.number("person_width_px", when(somebody, box.width), {1}, "px", "its width");
    visit.number("person_height_px", when(somebody, box.height), {1}, "px", "its height");
    visit.integer("faces", self.face_count, "", "faces in view");
  }

  static PersonState state_of(const person::PeopleInView& people);
};

/// Who is in view (chapter 6): faces are followed and named, face or marker of the person of interest and the shirt below it teach each other (Alg. 6.1).
///
/// Threads: one. OpenCV's cascade allocates.
class IdentifyStage {
 public:
  using Output = IdentifiedPeople;
  static constexpr std::string_view kName = "identify";
  static constexpr std::string_view kMeaning = "Who is in view, by face, marker and shirt (chapter 6).";
  static constexpr runtime::StageParameters kRow{1, 0, 100, 2, runtime::OnOverrun::kSkip};

  /// As person::Identifier's constructor.
  IdentifyStage(std::optional<person::FaceDetector> detector, std::unique_ptr<person::FaceRecognizer> recognizer,
                const person::IdentifierParameters& parameters)
      : identifier_(std::move(detector), std::move(recognizer), parameters) {}

  /// \param image  of the camera.  \param requests  of the last image: whose face counts where several are in view.
  Output update(WorkBudget& budget, const ImageView& image, const Requests& requests);

 private:
  person::Identifier identifier_;
  std::optional<person::Label> last_person_;
  PersonState last_state_ = PersonState::kNobody;
};

}  // namespace cgsr::stages
