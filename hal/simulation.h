#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/camera.h"
#include "hal/can_bus.h"
#include "hal/switches.h"
#include "platform/box.h"
#include "platform/error.h"
#include "platform/parameters.h"
#include "platform/time.h"

namespace cgsr::hal {

/// Grows whenever anything in this header or in the interfaces that it names changes: a plug-in of another version is
/// refused.
inline constexpr int kSimulationVersion = 4;

/// The section [sim] of a robot's file.
struct SimulationParameters {
  std::string scenario;
  std::string plug_in;
  int seed = 1;
  int threads = 2;
  int width_px = 640;
  int height_px = 480;
  bool cache = false;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.path("scenario", self.scenario,
               "The scenario file, which names the world and what happens in it (config/scenarios).");
    visit.path("plug_in", self.plug_in,
               "The simulator's shared library; when empty, cgsr-simulation.so beside the program is loaded.");
    visit.number("seed", self.seed, {0, 1000000000}, "",
                 "The seed of the random numbers for noise, wheel slip and small deviations of the actors' paths.");
    visit.number("threads", self.threads, {1, 64}, "",
                 "The number of threads that render images; the images do not depend on it.");
    visit.number("width_px", self.width_px, {16, 4096}, "px",
                 "The width of the simulated camera's images, which must be even.");
    visit.number("height_px", self.height_px, {16, 4096}, "px", "The height of the simulated camera's images.");
    visit.flag(
        "cache", self.cache,
        "Rendered images are kept in the user's cache folder, so that a repeated run does not render them again.");
  }
};

/// Position and heading on the floor, world frame.
struct FloorPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
};

/// What was really there in the middle of an image's exposure. For reports and pictures; the vision never sees it.
struct ImageTruth {
  MonoTime stamp{};  ///< of the image.
  FloorPose robot;
  std::array<double, 3> camera_m{};  ///< X_WC: its place,
  std::array<double, 4> camera_wxyz{1.0, 0.0, 0.0,
                                    0.0};  ///< and the unit quaternion that turns its axes into the world's.
  double robot_forward_mps = 0.0;          ///< over the ground.
  double robot_pitch_rad = 0.0;            ///< positive leans forward.
  bool there = false;                      ///< the object of the scenario exists at this moment.
  FloorPose object;
  double object_mps = 0.0;  ///< its speed.
  double distance_m = 0.0;  ///< along the floor, from the camera to the middle of the object.
  double nearing_mps =
      0.0;               ///< how fast the object alone, without the robot's motion, comes nearer; negative: goes away.
  bool in_view = false;  ///< at least one pixel of it.
  Box box;               ///< around the pixels of it that are seen.
  bool lamp_burns = false;         ///< some lamp does:
  std::array<double, 3> lamp_m{};  ///< the one that would light the camera most, world frame.
  double object_lit_share = 0.0;   ///< of the pixels of the object that are seen, those that see that lamp's centre.
};

/// A triangle of the world as it looks from above, for a plan.
struct PlanPiece {
  std::array<std::array<float, 2>, 3> corners_m{};
  std::array<float, 3> srgb{};
};

/// The world from above, lowest pieces first, without what hangs above a person's head.
struct Plan {
  double min_x_m = 0.0, max_x_m = 0.0, min_y_m = 0.0, max_y_m = 0.0;
  std::vector<PlanPiece> pieces;
  double view_angle_rad = 0.0;  ///< horizontal field of view of the camera.
};

/// A simulated home with a robot in it, behind the same interfaces as real devices. Time starts at 0 and is moved by
/// advance_to() alone: same scenario, seed and calls, same bytes.
///
/// Threads: advance_to, camera and bus may be used from different threads, the rest from one at a time. It must outlive
/// its devices.
class Simulation {
 public:
  virtual ~Simulation() = default;

  /// Each may be taken once.
  virtual std::unique_ptr<Camera> take_camera() = 0;
  virtual std::unique_ptr<CanBus> take_can_bus() = 0;
  virtual std::unique_ptr<Switches> take_switches() = 0;

  /// From the start of an exposure, which is the image's stamp, until the camera hands the image out.
  [[nodiscard]] virtual Duration image_delay() const = 0;

  /// Moves the world: the base obeys what it was told by then, scripts go on. An earlier time changes nothing. Images
  /// show the world at their own stamps: advance to an image's stamp and delay before asking for it, not further.
  virtual void advance_to(MonoTime time) = 0;

  /// \return the truth about the image of that stamp, when it is one of the last 64; else nothing.
  [[nodiscard]] virtual std::optional<ImageTruth> truth(MonoTime stamp) const = 0;

  [[nodiscard]] virtual const Plan& plan() const = 0;

  /// \return what a person should know about the scenario, a line each: world, robot, actors.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;
};

/// What a plug-in exports, with C linkage.
inline constexpr const char* kSimulationVersionSymbol = "cgsr_simulation_version";  ///< int().
inline constexpr const char* kMakeSimulationSymbol = "cgsr_make_simulation";        ///< MakeSimulation.
using SimulationVersion = int();

/// \param error  receives every problem of the scenario, a line each. \return the simulation, or null.
using MakeSimulation = Simulation*(const SimulationParameters* parameters, std::string* error);

}  // namespace cgsr::hal
