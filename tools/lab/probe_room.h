#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "hal/sim/calibration/calibrated_copy.h"
#include "hal/sim/generator/home.h"
#include "hal/sim/render/photographer.h"
#include "hal/sim/render/truth_images.h"
#include "hal/sim/worlds/world.h"
#include "pipeline/illumination/probe_observation.h"
#include "platform/error.h"
#include "platform/image_view.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

/// What a lamp of the room is like, beside what its world says.
struct ProbeRoomLight {
  double radius_m = 0.05;
  double lumens = 600.0;
  bool on = true;
  std::optional<Eigen::Vector3d> p_WL;         ///< where the lamp hangs; nothing: where the world says.
  std::optional<Eigen::Vector3d> second_p_WL;  ///< a second lamp of the same kind.
  double ambient = 1.0;                        ///< of the world's ambient light.
};

/// A lit home with the lamp robot and its probe board: chapter 5's shadows with their truth.
class ProbeRoom {
 public:
  /// The living room of config/worlds/home.toml with a ball-shaped lamp.
  static Result<std::unique_ptr<ProbeRoom>> make(const ProbeRoomLight& light);

  /// A home that was drawn, as it is by day or night, with one of its lamps (home.lights.lamps) switched on and the others off.
  static Result<std::unique_ptr<ProbeRoom>> make(const sim::GeneratedHome& home, std::size_t lamp);

  /// The image of a robot that stands at X_WR. Valid until the next one.
  ImageView shoot(const sim::Pose& X_WR, std::uint32_t seed, std::uint64_t number);

  /// Where the shadows of the tips truly fall.
  std::vector<sim::ProbeShadow> truth(const sim::Pose& X_WR, int lamp = 0);

  /// Writes what a copy of this robot and room that was measured with the stated errors says: sim::write_calibration().
  [[nodiscard]] Result<void> write_copy(std::uint32_t seed, const std::filesystem::path& folder) const;

  /// Is there nothing but floor under the robot and its board, and nothing beside them that reaches to its camera or less? By rays.
  [[nodiscard]] bool is_free(const sim::Pose& X_WR);

  /// A standpoint at which the light comes to the middle of the board at this angle from the vertical, from anywhere around.
  [[nodiscard]] std::optional<sim::Pose> standpoint(double angle_rad, Random& random);

  /// A standpoint at which the light comes from between these angles, and from which the shadow of at least one tip can be seen, as the truth says.
  [[nodiscard]] std::optional<sim::Pose> lit_standpoint(double least_rad, double most_rad, Random& random);

  [[nodiscard]] Eigen::Vector3d p_WL(int lamp = 0) const {
    return world_.scene.lamps[static_cast<std::size_t>(lamp)].p_WL;
  }
  void move_lamp(int lamp, const Eigen::Vector3d& p_WL) { moved_[static_cast<std::size_t>(lamp)] = p_WL; }
  void switch_lamp(int lamp, bool on) { on_[static_cast<std::size_t>(lamp)] = on; }
  void scale_light(double factor) { factor_ = factor * base_; }
  /// What scale_light() multiplies.
  void set_base_light(double factor) { factor_ = base_ = factor; }

 private:
  explicit ProbeRoom(sim::World world) : world_(std::move(world)) {}
  static Result<std::unique_ptr<ProbeRoom>> of(const sim::WorldSpec& spec, const std::filesystem::path& file);
  [[nodiscard]] sim::SceneState state(const sim::Pose& X_WR) const;
  [[nodiscard]] bool is_clear(const Eigen::Vector3d& middle, double radius_m) const;

  sim::World world_;
  std::unique_ptr<sim::Photographer> photographer_;
  std::vector<std::uint8_t> yuyv_;
  bool robot_is_elsewhere_ = false;  ///< as the tracer has it: for questions about the room alone.
  std::array<std::optional<Eigen::Vector3d>, 2> moved_;
  std::array<bool, 2> on_{true, true};
  double factor_ = 1.0;
  double base_ = 1.0;

  friend struct RobotCopy;
};

/// What the vision is told of the robot: measured with the stated errors.
struct RobotCopy {
  illumination::BoardParameters board;
  sim::Pose X_RC = sim::Pose::Identity();
  geometry::Camera camera;

  /// The same with the accuracy that the shipped board is stated with.
  static RobotCopy measured(const ProbeRoom& room, std::uint32_t seed, const illumination::BoardParameters& shipped,
                            double factor = 1.0) {
    RobotCopy copy = measured(room, seed, factor);
    copy.board.place_sigma_m = shipped.place_sigma_m;
    return copy;
  }

  /// Board and probes off by N(0, 0.5 mm) and 0.2 degrees, intrinsics by 0.2 %, the mount by 0.3 degrees about each axis; all times `factor`.
  static RobotCopy measured(const ProbeRoom& room, std::uint32_t seed, double factor = 1.0);
};

}  // namespace cgsr::lab
