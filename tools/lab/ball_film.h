#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/sim/cache.h"
#include "hal/sim/calibration/calibrated_copy.h"
#include "hal/sim/worlds/world.h"
#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/world/map.h"
#include "platform/box.h"
#include "platform/error.h"
#include "tools/lab/image.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

/// What happens in the film of section 5.4.3, in this order.
enum class BallScene : std::uint8_t {
  kAboveTable,  ///< the orange ball, lit.
  kOnTheWay,    ///< from one of the other places to the next.
  kInShadow,    ///< under the table, in its shadow.
  kUnderLit,    ///< under the table, in the strip that the lamp reaches.
  kReturned,    ///< above the table again, after it had left the image.
  kBrown,       ///< the orange one is gone; the brown one is above the table.
};
inline constexpr int kBallScenes = 6;
std::string_view to_string(BallScene scene);

/// What begins when [s].
using BallScenes = std::vector<std::pair<double, BallScene>>;

/// A stop of a ball's way, and what happens from there on. The ball is drawn a little beside it.
struct BallStop {
  std::array<double, 3> at_m;  ///< of the ball's lowest point.
  double speed_mps;
  double wait_s;
  BallScene then;
};

/// Out of the stops a walk; to `scenes` is added when which scene begins.
sim::WalkSpec ball_walk(const std::vector<BallStop>& stops, double start_s, Random& random, BallScenes& scenes);

/// A still camera's film of an orange ball (20 cm) and, later, a brown one.
///
/// With a seed alone it is that of section 5.4.3: the home's living room in the evening with a ball-shaped lamp, a still camera 5 m from the
/// table, the orange ball above the table, under it in shadow, under it lit, leaving and returning; then the brown one above the table. It
/// lasts one minute, as long as theirs (1,821 images), of which every sixth image is drawn. A seed is a take of its own: where the
/// camera stands and looks, the balls' ways, and the noise.
class BallFilm {
 public:
  static constexpr double kRate_hz = 5.0;
  static constexpr int kImages = 304;  ///< of the film of section 5.4.3.

  /// \return why the world's file cannot be used.
  static Result<std::unique_ptr<BallFilm>> make(std::uint64_t seed);

  /// A film in another world, which has one robot, that with the camera, and as many balls as are told here.
  struct Script {
    sim::WalkSpec orange, brown;
    std::vector<sim::PresenceSpec> orange_is_there, brown_is_there;
    BallScenes scenes;
    sim::CalibrationErrors errors;  ///< of map() and camera().
  };
  static Result<std::unique_ptr<BallFilm>> make(sim::WorldSpec world, const std::filesystem::path& name, Script script,
                                                std::uint64_t seed);

  struct Shot {
    Image image;
    BallScene scene = BallScene::kAboveTable;
    std::optional<Box> orange;  ///< around its visible pixels; nothing: hidden, or out of view.
    std::optional<Box> brown;
    double lit = 0.0;              ///< share of the orange ball's visible pixels that see the lamp.
    double orange_height_m = 0.0;  ///< of its lowest point above the floor.
  };

  /// Draws an image in any order.
  Shot shoot(int number);

  /// How the robot measured its surroundings; the film of section 5.4.3: as they are.
  [[nodiscard]] const world::Map& map() const { return map_; }
  [[nodiscard]] const geometry::Camera& camera() const { return camera_; }
  // What is true of the scene.
  [[nodiscard]] const geometry::Pose& X_WC() const { return X_WC_; }
  [[nodiscard]] const Eigen::Vector3d& p_WL() const { return world_.scene.lamps.front().p_WL; }

 private:
  BallFilm(sim::World world, std::uint64_t seed) : world_(std::move(world)), seed_(seed) {}

  sim::World world_;
  std::uint64_t seed_;
  world::Map map_;
  geometry::Camera camera_;
  geometry::Pose X_WC_ = geometry::Pose::Identity();
  BallScenes scenes_;
  std::unique_ptr<sim::CachedPhotographer> photographer_;
  int orange_ = -1;  // figures
  int brown_ = -1;
};

}  // namespace cgsr::lab
