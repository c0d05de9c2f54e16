#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/behavior/drive_limits.h"
#include "pipeline/behavior/follow.h"
#include "pipeline/behavior/place.h"
#include "platform/error.h"
#include "platform/parameters.h"
#include "platform/time.h"

namespace cgsr::behavior {

/// Where to go, and how: the parameters of Route.
struct RouteParameters {
  std::string places_m;
  bool round = true;
  double reached_m = 0.15;
  double forward_mps = 0.35;
  double approach_per_s = 0.8;
  double turn_per_s = 1.2;
  double max_driving_bearing_rad = 0.4;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("places_m", self.places_m,
               "The places to visit in order, in world coordinates, as \"x, y; x, y; ...\"; when empty the robot stays "
               "where it is.");
    visit.flag("round", self.round,
               "After the last place the robot returns to the first one; otherwise it stops there.");
    visit.number("reached_m", self.reached_m, {0.02, 2.0}, "m", "A place counts as reached within this distance.");
    visit.number("forward_mps", self.forward_mps, {0.01, 1.5}, "m/s", "The speed on the way between places.");
    visit.number("approach_per_s", self.approach_per_s, {0.05, 5.0}, "1/s",
                 "The speed per metre of remaining distance, where this is less than forward_mps.");
    visit.number("turn_per_s", self.turn_per_s, {0.0, 5.0}, "1/s", "The turn rate per radian of bearing.");
    visit.number("max_driving_bearing_rad", self.max_driving_bearing_rad, {0.05, 3.2}, "rad",
                 "From this bearing on the robot only turns; at smaller bearings the speed grows linearly to its full "
                 "value at zero.");
  }
};

/// \return the places of a text like "1.5, 2; 3, 4.25"; or what is wrong with it: the piece, its number, what was expected.
Result<std::vector<Place>> parse_places(std::string_view text);

/// Where the robot believes to be on its floor: world frame, the heading from its x axis to the left.
struct PlanarPose {
  bool known = false;
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
};

enum class RouteState : std::uint8_t {
  kNowhere,  ///< its pose is not known: it stands.
  kDriving,  ///< on the way to a place.
  kArrived,  ///< at the last place.
};

std::string_view to_string(RouteState state);

/// What to do next. The goal is in the robot's frame.
struct RouteDecision {
  Velocity goal;
  bool halt = false;  ///< the pose is not known: no ramp.
  RouteState state = RouteState::kNowhere;
  int place = 0;  ///< that it is on the way to, from 0.
};

/// From place to place in the world, straight, by the pose that chapter 4 gives. It sees no obstacles: the way must be free.
/// Ours: the dissertation has no such task; the pose is that of Fig. 5.1.
///
/// Threads: one; decide allocates nothing.
class Route {
 public:
  Route(const RouteParameters& parameters, std::vector<Place> places, const DriveLimits& limits = {})
      : parameters_(parameters), limits_(limits), places_(std::move(places)) {}

  RouteDecision decide(const PlanarPose& here, Duration elapsed);

 private:
  void pass_places(const PlanarPose& here);
  [[nodiscard]] bool at_end() const { return next_ >= places_.size(); }
  [[nodiscard]] Velocity wanted(const PlanarPose& here) const;

  RouteParameters parameters_;
  DriveLimits limits_;
  std::vector<Place> places_;
  std::size_t next_ = 0;
  Velocity goal_;
};

}  // namespace cgsr::behavior
