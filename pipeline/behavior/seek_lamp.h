#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "pipeline/behavior/drive_limits.h"
#include "pipeline/behavior/free_floor.h"
#include "pipeline/behavior/route.h"
#include "pipeline/behavior/velocity.h"
#include "pipeline/illumination/active_check.h"
#include "platform/parameters.h"
#include "platform/time.h"

namespace cgsr::behavior {

/// Section [task.lamp]: Algorithm 5.2.
struct SeekLampParameters {
  double explore_turn_radps = 0.5;
  double explore_step_m = 1.2;
  int max_explore_places = 5;
  double max_locate_angle_deg = 42.0;
  double min_distance_m = 0.6;
  double min_locate_s = 3.0;
  double max_locate_s = 10.0;
  double locate_turn_deg = 25.0;
  double max_located_sigma_m = 0.05;
  double back_off_m = 5.0;
  double max_back_off_turn_deg = 50.0;
  double max_shade_wait_s = 4.0;
  double forward_mps = 0.35;
  double approach_per_s = 0.8;
  double turn_per_s = 1.2;
  double max_driving_bearing_rad = 0.35;
  double reached_m = 0.10;
  double facing_deg = 2.0;
  double max_pose_loss_s = 2.0;
  double max_probes_loss_s = 4.0;
  FreeFloorParameters floor;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("explore_turn_radps", self.explore_turn_radps, {0.05, 2.0}, "rad/s",
                 "The turn rate while the robot looks for shadows; it turns once around at every place.");
    visit.number("explore_step_m", self.explore_step_m, {0.1, 10.0}, "m",
                 "The distance from one exploration place to the next.");
    visit.number("max_explore_places", self.max_explore_places, {1, 100}, "",
                 "After this many places without a shadow, only ambient light is assumed.");
    visit.number("max_locate_angle_deg", self.max_locate_angle_deg, {5.0, 80.0}, "deg",
                 "The robot approaches a lamp that is further from the vertical than this before it measures it.");
    visit.number("min_distance_m", self.min_distance_m, {0.0, 10.0}, "m",
                 "The robot does not approach the lamp closer than this distance along the floor.");
    visit.number("min_locate_s", self.min_locate_s, {0.0, 60.0}, "s",
                 "The shortest time for which the lamp is measured.");
    visit.number("max_locate_s", self.max_locate_s, {0.1, 120.0}, "s",
                 "The longest time for which the lamp is measured.");
    visit.number("locate_turn_deg", self.locate_turn_deg, {0.0, 90.0}, "deg",
                 "The angle by which the robot turns to each side while measuring; turning separates the lamp's "
                 "position from errors of the board.");
    visit.number("max_located_sigma_m", self.max_located_sigma_m, {0.001, 1.0}, "m",
                 "The lamp is located when the standard deviation of its position is at most this.");
    visit.number("back_off_m", self.back_off_m, {0.0, 50.0}, "m",
                 "The distance by which the robot backs off from the lamp, as far as the way is free.");
    visit.number("max_back_off_turn_deg", self.max_back_off_turn_deg, {0.0, 180.0}, "deg",
                 "The largest deviation from the direction straight away from the lamp, used when another direction is "
                 "free for longer.");
    visit.number("max_shade_wait_s", self.max_shade_wait_s, {0.1, 60.0}, "s",
                 "The longest time for which the robot waits for shadow masks.");
    visit.number("forward_mps", self.forward_mps, {0.01, 1.5}, "m/s", "The speed on the way between places.");
    visit.number("approach_per_s", self.approach_per_s, {0.05, 5.0}, "1/s",
                 "The speed per metre of remaining distance, where this is less than forward_mps.");
    visit.number("turn_per_s", self.turn_per_s, {0.0, 5.0}, "1/s", "The turn rate per radian of bearing.");
    visit.number("max_driving_bearing_rad", self.max_driving_bearing_rad, {0.05, 3.2}, "rad",
                 "From this bearing on the robot only turns; at smaller bearings the speed grows linearly to its full "
                 "value at zero.");
    visit.number("reached_m", self.reached_m, {0.01, 1.0}, "m", "A place counts as reached within this distance.");
    visit.number("facing_deg", self.facing_deg, {0.1, 30.0}, "deg", "A heading counts as reached within this angle.");
    visit.number("max_pose_loss_s", self.max_pose_loss_s, {0.1, 60.0}, "s",
                 "The robot stops on its way when its pose has been unknown for this time.");
    visit.number("max_probes_loss_s", self.max_probes_loss_s, {0.1, 60.0}, "s",
                 "When the board has been unreadable for this time, only ambient light is assumed.");
    visit.section("floor", self.floor, "The part of the floor that is free according to the map");
  }
};

/// What chapter 5's stages say about the lamp, as the behaviour sees it: world frame, metres.
struct LampBelief {
  bool has_board = false;
  bool readable = false;  ///< the board is where it should be: an image without a shadow then means something.
  bool seen = false;      ///< this image shows a shadow that gives a lamp.
  bool known = false;     ///< many images agree on a lamp, in the world:
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double sigma_m = 0.0;  ///< of its place, the root of the covariance's trace.
  bool masked = false;   ///< there are masks of what lies in its shadow.
  illumination::CheckState probes_check = illumination::CheckState::kNotThere;  ///< the probes, by their own lamp.
  illumination::CheckState lamp_proof = illumination::CheckState::kNotThere;    ///< the shadows, by the room's.
};

/// The probes' place on the robot: ahead of the robot's origin, and above the floor.
struct BoardPlace {
  double forward_m = 0.44;
  double height_m = 0.90;
};

/// The rectangle that the robot may not leave, seen from where and whither it looked at the start.
struct KeptArea {
  bool enabled = false;
  double min_x_m = 0.0;
  double max_x_m = 0.0;
  double min_y_m = 0.0;
  double max_y_m = 0.0;
};

/// Where in Alg. 5.2 the robot is; lines are those of the algorithm.
enum class SeekState : std::uint8_t {
  kWaiting,      ///< robot pose unknown yet: stands.
  kChecking,     ///< stands while the probes' own lamp is switched: are they as calibrated?
  kExploring,    ///< turns and moves until the probes throw a shadow (line 3).
  kApproaching,  ///< goes nearer to a lamp that stands low: a small angle measures better.
  kLocating,     ///< measures the lamp (line 6).
  kProving,      ///< stands while the room's lamp is switched: are the shadows its shadows?
  kBackingOff,   ///< turns away, drives, turns back: it is blind backwards (line 10).
  kShading,      ///< stands until there are masks (line 11).
  kTracking,     ///< stands and tracks (lines 12 to 14).
  kAmbient,      ///< no shadow was found: stands and tracks without a mask.
  kStopped,      ///< a fault ended it; stands.
};
std::string_view to_string(SeekState state);

enum class SeekReason : std::uint8_t {
  kBegun,
  kPoseKnown,
  kShadowSeen,
  kSteepEnough,
  kNoWayNearer,
  kLampKnown,
  kTimeIsUp,
  kLampGone,
  kFarEnough,
  kNoWayFarther,
  kMasked,
  kNoMask,
  kNoShadow,
  kNoBoard,
  kBoardUnreadable,
  kPoseLost,
  kNoPose,
  kProbesAgree,
  kProbesDoubted,
  kLampProven,
  kOtherShadow,
  kSwitchFault,
  kNoCheck,
};
std::string_view to_string(SeekReason reason);

/// What to do next. The goal is in the robot's frame.
struct SeekDecision {
  Velocity goal;
  bool halt = false;  ///< no ramp.
  SeekState state = SeekState::kWaiting;
  SeekReason reason = SeekReason::kBegun;              ///< of the last change of state.
  int places = 0;                                      ///< looked around at, while exploring.
  std::optional<illumination::CheckedLamp> make_sure;  ///< the lamp that it wants switched now.
};

/// Algorithm 5.2: explore until the probes throw a shadow, locate the lamp, back off, find the shaded regions, track. It sees no obstacles: its
/// ways keep clear of what the map holds, and inside of the area that it is kept in.
///
/// Threads: one; decide allocates nothing.
class SeekLamp {
 public:
  /// \param floor  may be null: then there is no map, and no way is free.
  SeekLamp(const SeekLampParameters& parameters, std::shared_ptr<const FreeFloor> floor, const BoardPlace& board,
           const KeptArea& area, const DriveLimits& limits = {})
      : parameters_(parameters), limits_(limits), floor_(std::move(floor)), board_(board), area_(area) {}

  SeekDecision decide(const PlanarPose& here, const LampBelief& lamp, Duration elapsed);

  /// Is it where the object is looked for?
  [[nodiscard]] bool tracks() const { return state_ == SeekState::kTracking || state_ == SeekState::kAmbient; }

 private:
  static constexpr int kMostVisited = 16;

  void go_on(SeekState state, SeekReason reason);
  [[nodiscard]] Velocity wanted(const PlanarPose& here, const LampBelief& lamp);
  Velocity explore(const PlanarPose& here, const LampBelief& lamp);
  Velocity approach(const PlanarPose& here, const LampBelief& lamp);
  Velocity locate(const PlanarPose& here, const LampBelief& lamp);
  Velocity back_off(const PlanarPose& here, const LampBelief& lamp);
  Velocity shade(const LampBelief& lamp);
  void begin(const PlanarPose& here, const LampBelief& lamp);
  void check(illumination::CheckState state);
  void prove(const LampBelief& lamp);
  void measured(const LampBelief& lamp, SeekReason reason);
  void choose_next_place(const PlanarPose& here);
  void choose_way_back(const PlanarPose& here);
  [[nodiscard]] double way_m(const PlanarPose& here, double heading_rad, double longest_m) const;
  [[nodiscard]] bool in_area(double x_m, double y_m) const;
  [[nodiscard]] Velocity towards(const PlanarPose& here, const Place& place) const;
  [[nodiscard]] Velocity facing(const PlanarPose& here, double heading_rad, bool& done) const;
  [[nodiscard]] double board_to_lamp_m(const PlanarPose& here) const;

  SeekLampParameters parameters_;
  DriveLimits limits_;
  std::shared_ptr<const FreeFloor> floor_;
  BoardPlace board_;
  KeptArea area_;

  SeekState state_ = SeekState::kWaiting;
  SeekReason reason_ = SeekReason::kBegun;
  double in_state_s_ = 0.0;
  double without_pose_s_ = 0.0;
  double unreadable_s_ = 0.0;
  double unknown_s_ = 0.0;  // since the lamp was known
  double elapsed_s_ = 0.0;
  PlanarPose start_;
  Place lamp_;  // where it was last known
  double lamp_z_m_ = 0.0;
  Velocity goal_;

  // Exploring.
  double last_heading_rad_ = 0.0;
  double turned_rad_ = 0.0;
  double held_s_ = 0.0;   // standing still for a shadow that is not sure yet
  double tired_s_ = 0.0;  // of shadows that did not become sure
  bool on_the_way_ = false;
  std::array<Place, kMostVisited> visited_{};
  int visits_ = 0;
  // Approaching, exploring, backing off.
  Place next_;
  // Locating.
  double middle_rad_ = 0.0;
  bool to_the_left_ = true;
  // Backing off.
  enum class Leg : std::uint8_t { kChoose, kTurnAway, kDrive, kTurnBack } leg_ = Leg::kChoose;
  double away_rad_ = 0.0;
  bool far_enough_ = false;
};

}  // namespace cgsr::behavior
