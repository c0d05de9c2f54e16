#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hal/sim/worlds/world.h"

namespace cgsr::sim {

/// Builds a world from its file's structs and collects what is wrong on the way: the work behind build_world().
class WorldBuilder {
 public:
  explicit WorldBuilder(std::filesystem::path file) : file_(std::move(file)) {}

  void add_materials(const std::vector<MaterialSpec>& specs);
  void add_shape(const ShapeSpec& spec);
  void add_ball(const BallSpec& spec);
  void add_object(const ObjectSpec& spec);
  void add_person(const PersonSpec& spec);
  void add_robot(const RobotSpec& spec);
  void add_lamp(const LampSpec& spec);  ///< after the robots: one of them may carry it.
  void set_ambient(const AmbientSpec& spec);
  void add_view(const ViewSpec& spec);

  /// What can only be judged about the whole.
  void check(const WorldSpec& spec);

  /// \return the world, or the problems sorted by line.
  Result<World> finish(const std::string& name);

 private:
  struct Problem {
    int line;
    std::string text;
  };
  /// More than any world needs, and less than fills a memory: a count that was meant for something else stops here.
  struct Size {
    std::size_t triangles = 0;
    std::size_t still_parts = 0;
    std::size_t moving_parts = 0;
  };
  static constexpr Size kMost{4'000'000, 100'000, 2'000};

  void complain(int line, std::string text) { problems_.push_back({line, std::move(text)}); }
  int material(const std::string& name, int line, const std::string& who);
  void add_copies(const ShapeSpec& spec, int figure);
  void add_parts(const ShapeSpec& spec, const Pose& X_FS, int figure);
  void add_mesh_parts(const ShapeSpec& spec, const Pose& X_FS, int figure);
  void add_part(std::string name, Mesh mesh, int material, int figure, const ShapeSpec& spec, bool casts_shadow);
  void set_script(Figure& figure, const WalkSpec& walk, const std::vector<PresenceSpec>& presence, int line);
  void check_names(const WorldSpec& spec);

  std::filesystem::path file_;
  World world_;
  std::map<std::string, int> materials_;
  std::map<std::string, int> figures_;
  std::vector<Problem> problems_;
  Size size_;
};

/// The shapes of a world, repeats written out, that are solid: what a lamp may not be inside of.
struct Solid {
  const ShapeSpec* shape;
  Pose X_WS;
};
std::vector<Solid> solids_of(const WorldSpec& spec);

/// Is the point inside the solid, by more than a millimetre?
bool is_inside(const Solid& solid, const Eigen::Vector3d& p_W);

/// The pose of the n-th copy of a shape.
Pose pose_of(const ShapeSpec& spec, int copy);

}  // namespace cgsr::sim
