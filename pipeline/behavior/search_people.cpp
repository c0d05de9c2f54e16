#include "pipeline/behavior/search_people.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "pipeline/behavior/ramp.h"

namespace cgsr::behavior {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kCellsAtOnce = 1000;
constexpr double kKeepFromPeople_m = 0.55;
constexpr double kLookAhead_m = 0.9;
constexpr double kWholeTurn_rad = 330.0 * kDegree;  // the image is wider than the rest
constexpr double kPatienceWithoutPose_s = 5.0;      // then another wall may show more edges
constexpr double kTurn_per_s = 1.2, kApproach_per_s = 0.8, kMaxDrivingBearing_rad = 0.5;

}  // namespace

std::string_view to_string(SearchPeopleState state) {
  switch (state) {
    case SearchPeopleState::kNowhere:
      return "pose not known";
    case SearchPeopleState::kPlanning:
      return "working out the way to a lookout";
    case SearchPeopleState::kDriving:
      return "on the way to a lookout";
    case SearchPeopleState::kTurning:
      return "looking round";
    case SearchPeopleState::kStanding:
      return "looking at somebody";
    case SearchPeopleState::kTelling:
      return "telling where who is";
    case SearchPeopleState::kDone:
      return "has told where who is";
  }
  return "unknown";
}

SearchPeople::SearchPeople(const SearchPeopleParameters& parameters, const FreeFloor& floor,
                           std::vector<Place> lookouts, const DriveLimits& limits)
    : parameters_(parameters),
      limits_(limits),
      way_(floor),
      lookouts_(std::move(lookouts)),
      people_(parameters.same_place_m) {}

// \return whether somebody in view is to be looked at longer.
bool SearchPeople::note(std::span<const FaceInMap> faces, double elapsed_s) {
  bool stay = false;
  for (const FaceInMap& face : faces) {
    PersonInMap* const person = people_.see(face);
    if (person == nullptr || person->votes.images() >= parameters_.images_to_name) continue;
    if (person->waited_s >= parameters_.patience_s) continue;
    person->waited_s += elapsed_s;
    stay = true;
  }
  return stay;
}

// Whoever is known to stand somewhere is an obstacle from then on.
std::optional<PersonTold> SearchPeople::name_somebody() {
  for (PersonInMap& person : people_.people()) {
    if (person.told || person.votes.images() < parameters_.images_to_name) continue;
    person.told = true;
    way_.block(person.place, kKeepFromPeople_m);
    if (state_ == SearchPeopleState::kDriving) state_ = SearchPeopleState::kPlanning;
    has_begun_ = false;
    return PersonTold{person.votes.number(), person.votes.confidence(), person.place, false};
  }
  return std::nullopt;
}

void SearchPeople::leave_lookout() {
  ++next_;
  has_begun_ = false;
  state_ = SearchPeopleState::kPlanning;
  for (PersonInMap& person : people_.people()) person.waited_s = 0.0;
}

void SearchPeople::end() {
  state_ = SearchPeopleState::kTelling;
  goal_ = {};
}

Velocity SearchPeople::plan(const PlanarPose& here) {
  if (next_ >= lookouts_.size()) {
    end();
    return {};
  }
  if (!has_begun_) {
    has_begun_ = way_.begin(lookouts_[next_]);
    if (!has_begun_) ++next_;
    return {};
  }
  if (!way_.advance(kCellsAtOnce)) return {};
  if (way_.way_m({here.x_m, here.y_m}) < FloorWay::kInfinite_m) {
    state_ = SearchPeopleState::kDriving;
  } else {
    leave_lookout();
  }
  return {};
}

Velocity SearchPeople::drive(const PlanarPose& here) {
  const Place place{here.x_m, here.y_m};
  const double way_m = way_.way_m(place);
  const auto ahead = way_.ahead(place, kLookAhead_m);
  if (!ahead || way_m <= parameters_.reached_m) {
    state_ = SearchPeopleState::kTurning;
    turned_rad_ = 0.0;
    last_heading_rad_ = here.heading_rad;
    return {};
  }
  const double bearing = std::remainder(std::atan2(ahead->y_m - here.y_m, ahead->x_m - here.x_m) - here.heading_rad,
                                        2.0 * std::numbers::pi);
  const double facing = std::max(0.0, 1.0 - std::abs(bearing) / kMaxDrivingBearing_rad);
  return {std::min({parameters_.forward_mps, limits_.max_forward_mps, kApproach_per_s * way_m}) * facing,
          std::clamp(kTurn_per_s * bearing, -limits_.max_turn_radps, limits_.max_turn_radps)};
}

Velocity SearchPeople::turn(const PlanarPose& here) {
  turned_rad_ += std::remainder(here.heading_rad - last_heading_rad_, 2.0 * std::numbers::pi);
  last_heading_rad_ = here.heading_rad;
  if (turned_rad_ >= kWholeTurn_rad) {
    leave_lookout();
    return {};
  }
  return {0.0, std::min(parameters_.turn_degps * kDegree, limits_.max_turn_radps)};
}

void SearchPeople::follow(const Velocity& target, double elapsed_s) {
  goal_.forward_mps = ramp(goal_.forward_mps, target.forward_mps, limits_.max_acceleration_mps2,
                           limits_.max_deceleration_mps2, elapsed_s);
  goal_.left_radps = ramp(goal_.left_radps, target.left_radps, limits_.max_turn_acceleration_radps2,
                          limits_.max_turn_acceleration_radps2, elapsed_s);
}

// Somebody who was seen in too few images to be named is told of all the same where it was half as many.
SearchPeopleDecision SearchPeople::tell() {
  const auto people = std::as_const(people_).people();
  while (told_ < people.size()) {
    const PersonInMap& person = people[told_++];
    if (2 * person.votes.images() < parameters_.images_to_name) continue;
    return {
        {}, false, state_, PersonTold{people_.settled_number(person), person.votes.confidence(), person.place, true}};
  }
  state_ = SearchPeopleState::kDone;
  return {{}, false, state_, std::nullopt};
}

// On the spot nothing is run into. Before the pose was known first the robot stands: its search begins where it looks.
SearchPeopleDecision SearchPeople::wait_for_pose(double elapsed_s) {
  without_pose_s_ += elapsed_s;
  if (!knew_pose_ || without_pose_s_ < kPatienceWithoutPose_s) {
    goal_ = {};
    return {{}, true, SearchPeopleState::kNowhere, std::nullopt};
  }
  follow({0.0, std::min(0.5 * parameters_.turn_degps * kDegree, limits_.max_turn_radps)}, std::min(elapsed_s, 0.2));
  return {goal_, false, SearchPeopleState::kNowhere, std::nullopt};
}

SearchPeopleDecision SearchPeople::decide(const PlanarPose& here, std::span<const FaceInMap> faces, Duration elapsed) {
  if (state_ == SearchPeopleState::kDone) return {{}, false, state_, std::nullopt};
  if (state_ == SearchPeopleState::kTelling) return tell();
  const double elapsed_s = to_seconds(elapsed);
  knew_pose_ = knew_pose_ || here.known;
  if (knew_pose_) duration_s_ += elapsed_s;
  if (duration_s_ >= parameters_.max_duration_s) end();
  if (state_ == SearchPeopleState::kTelling) return tell();
  if (!here.known) return wait_for_pose(elapsed_s);
  without_pose_s_ = 0.0;
  const bool stay = note(faces, elapsed_s);
  SearchPeopleDecision decision;
  decision.told = name_somebody();
  Velocity target;
  if (!stay && state_ == SearchPeopleState::kPlanning) {
    target = plan(here);
  } else if (!stay && state_ == SearchPeopleState::kDriving) {
    target = drive(here);
  } else if (!stay && state_ == SearchPeopleState::kTurning) {
    target = turn(here);
  }
  follow(target, std::min(elapsed_s, 0.2));
  decision.goal = goal_;
  decision.state = stay ? SearchPeopleState::kStanding : state_;
  return decision;
}

}  // namespace cgsr::behavior
