#include "pipeline/stages/identify_stage.h"

namespace cgsr::stages {

std::string_view to_string(PersonState state) {
  switch (state) {
    case PersonState::kNobody:
      return "nobody";
    case PersonState::kEnrolled:
      return "enrolled";
    case PersonState::kStranger:
      return "stranger";
  }
  return "";
}

PersonState IdentifiedPeople::state_of(const person::PersonSighting& sighting) {
  if (!sighting.person) return PersonState::kNobody;
  return *sighting.person == person::kStranger ? PersonState::kStranger : PersonState::kEnrolled;
}

IdentifiedPeople IdentifyStage::update(WorkBudget& budget, const ImageView& image, const Requests& requests) {
  IdentifiedPeople people{identifier_.identify(image, requests.person, budget)};
  const person::PersonSighting& sighting = people.person;
  if (sighting.person != last_person_) {
    Event event{"person", to_string(IdentifiedPeople::state_of(sighting)),
                sighting.person ? to_string(sighting.source) : std::string_view{}};
    if (sighting.person) event.numbers[event.number_count++] = {"number", static_cast<double>(*sighting.person), ""};
    people.events.add(event);
    last_person_ = sighting.person;
  }
  return people;
}

}  // namespace cgsr::stages
