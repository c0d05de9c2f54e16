#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "pipeline/behavior/drive_limits.h"
#include "pipeline/behavior/floor_way.h"
#include "pipeline/behavior/people_in_map.h"
#include "pipeline/behavior/route.h"
#include "pipeline/behavior/search_people_parameters.h"
#include "pipeline/behavior/velocity.h"
#include "platform/time.h"

namespace cgsr::behavior {

enum class SearchPeopleState : std::uint8_t {
  kNowhere,   ///< its pose is not known: it stands, and turns on the spot when that lasts.
  kPlanning,  ///< works out the way to a lookout.
  kDriving,   ///< on the way there.
  kTurning,   ///< turns once round there.
  kStanding,  ///< before a face that is not named yet.
  kTelling,   ///< tells where who is, one in an image.
  kDone,
};
std::string_view to_string(SearchPeopleState state);

/// Who stands where, as the robot says it.
struct PersonTold {
  int number = 0;           ///< 0: a stranger.
  double confidence = 0.0;  ///< the share of the images in which it was that person, weighted by confidence.
  Place place;
  bool in_the_end = false;  ///< told among all; else when the person was named.
};

struct SearchPeopleDecision {
  Velocity goal;
  bool halt = false;  ///< the pose is not known any more: no ramp.
  SearchPeopleState state = SearchPeopleState::kNowhere;
  std::optional<PersonTold> told = std::nullopt;  ///< who is told of in this image.
};

/// Who Is Who spread through a home (6.4.1.2): drives from lookout to lookout on the free floor, turns once round at each, stands before each face until
/// it is named often enough, and tells where that person stands. When every lookout was visited, or time is up, it tells of all. Everybody is once: a
/// second face near the same place is the same person's, and where two were taken for the same person the less sure one is a stranger.
/// Ours: the dissertation says what is to be told, not how the robot finds people.
///
/// Threads: one. Allocates nothing after construction; a way is worked out over several images, 0.5 million instructions in each.
class SearchPeople {
 public:
  /// \param floor  where the robot may drive.  \param lookouts  to be visited in this order (plan_lookouts).
  SearchPeople(const SearchPeopleParameters& parameters, const FreeFloor& floor, std::vector<Place> lookouts,
               const DriveLimits& limits);

  /// \param faces  of this image that are near enough to be named.  \param elapsed  since the last image.
  SearchPeopleDecision decide(const PlanarPose& here, std::span<const FaceInMap> faces, Duration elapsed);

  /// \return who was met so far.
  [[nodiscard]] const PeopleInMap& people() const { return people_; }

 private:
  bool note(std::span<const FaceInMap> faces, double elapsed_s);
  std::optional<PersonTold> name_somebody();
  Velocity plan(const PlanarPose& here);
  Velocity drive(const PlanarPose& here);
  Velocity turn(const PlanarPose& here);
  void leave_lookout();
  void end();
  SearchPeopleDecision tell();
  SearchPeopleDecision wait_for_pose(double elapsed_s);
  void follow(const Velocity& target, double elapsed_s);

  SearchPeopleParameters parameters_;
  DriveLimits limits_;
  FloorWay way_;
  std::vector<Place> lookouts_;
  PeopleInMap people_;
  SearchPeopleState state_ = SearchPeopleState::kPlanning;  // what it does where it does not stand before somebody
  std::size_t next_ = 0;                                    // lookout
  bool has_begun_ = false;                                  // with the way to that
  double duration_s_ = 0.0;                                 // since the pose was known first
  bool knew_pose_ = false;
  double without_pose_s_ = 0.0;
  double turned_rad_ = 0.0;
  double last_heading_rad_ = 0.0;
  Velocity goal_;
  std::size_t told_ = 0;  // in the end
};

}  // namespace cgsr::behavior
