#include "pipeline/behavior/people_in_map.h"

#include <algorithm>

namespace cgsr::behavior {
namespace {

constexpr int kMaxWeight = 30;  // sightings after which a new one still counts that much

}  // namespace

PersonInMap* PeopleInMap::see(const FaceInMap& face) {
  PersonInMap* nearest = nullptr;
  for (PersonInMap& person : people()) {
    const double off_m = distance_m(person.place, face.place);
    if (off_m > same_place_m_) continue;
    if (nearest == nullptr || off_m < distance_m(nearest->place, face.place)) nearest = &person;
  }
  if (nearest == nullptr) {
    if (count_ == kMaxPeople) return nullptr;
    people_[count_] = {face.place, 0, 0.0, false, {}};
    nearest = &people_[count_++];
  }
  const double share = 1.0 / std::min(++nearest->sightings, kMaxWeight);
  nearest->place.x_m += share * (face.place.x_m - nearest->place.x_m);
  nearest->place.y_m += share * (face.place.y_m - nearest->place.y_m);
  if (face.compared) nearest->votes.count(face.number, face.confidence, face.weight);
  return nearest;
}

int PeopleInMap::settled_number(const PersonInMap& person) const {
  const int number = person.votes.number();
  const auto surer = [&](const PersonInMap& other) {
    return &other != &person && other.votes.images() > 0 && other.votes.number() == number &&
           other.votes.confidence() > person.votes.confidence();
  };
  return number != 0 && std::ranges::any_of(people(), surer) ? 0 : number;
}

}  // namespace cgsr::behavior
