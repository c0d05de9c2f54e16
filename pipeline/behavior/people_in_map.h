#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "pipeline/behavior/name_votes.h"
#include "pipeline/behavior/place.h"

namespace cgsr::behavior {

/// A face in an image, where its owner stands.
struct FaceInMap {
  Place place;
  bool compared = false;    ///< whether it is known whose it is.
  int number = 0;           ///< whose; 0: a stranger's.
  double confidence = 0.0;  ///< of that.
  double weight = 1.0;      ///< of this sighting among the others: a face that is seen from near says more.
};

/// Somebody who was met in the home.
struct PersonInMap {
  Place place;  ///< where the face was seen, the mean of all sightings.
  int sightings = 0;
  double waited_s = 0.0;  ///< that the robot stood before this person since it came to its lookout.
  bool told = false;      ///< was told of when the name was known.
  NameVotes votes{};
};

/// Who was met where (6.4.1.2): faces whose places in the map are near each other are one person's. Ours.
///
/// Threads: one. Allocates nothing.
class PeopleInMap {
 public:
  static constexpr std::size_t kMaxPeople = 16;  ///< further ones are not noticed.

  /// \param same_place_m  faces nearer to each other are one person's.
  explicit PeopleInMap(double same_place_m) : same_place_m_(same_place_m) {}

  /// One face of an image. \return whose it is; null: sixteen others were met before.
  PersonInMap* see(const FaceInMap& face);

  [[nodiscard]] std::span<PersonInMap> people() { return std::span(people_).first(count_); }
  [[nodiscard]] std::span<const PersonInMap> people() const { return std::span(people_).first(count_); }

  /// \return the number under which somebody is told of in the end: where two were taken for the same person, the less sure one is a stranger, 0.
  [[nodiscard]] int settled_number(const PersonInMap& person) const;

 private:
  double same_place_m_;
  std::array<PersonInMap, kMaxPeople> people_{};
  std::size_t count_ = 0;
};

}  // namespace cgsr::behavior
