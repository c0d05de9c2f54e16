#include "hal/sim/worlds/builder.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "hal/sim/people/person.h"
#include "hal/sim/scene/portable_math.h"
#include "hal/sim/scene/shapes.h"
#include "hal/sim/worlds/furniture.h"
#include "hal/sim/worlds/mesh_file.h"

namespace cgsr::sim {
namespace {

Eigen::Vector3d vector(const Triple& t) {
  return {t[0], t[1], t[2]};
}

Rgb linear(const Triple& t) {
  return Eigen::Vector3d(t[0], t[1], t[2]).cast<float>();
}

std::vector<LightKey> script_of(const std::vector<LightKeySpec>& specs) {
  std::vector<LightKey> script;
  script.reserve(specs.size());
  for (const LightKeySpec& key : specs) script.push_back({key.at_s, linear(key.factor)});
  return script;
}

CameraModel lens_of(const LensSpec& spec) {
  CameraModel camera;
  camera.fx_px = spec.fx_px;
  camera.fy_px = spec.fy_px;
  camera.cx_px = spec.cx_px;
  camera.cy_px = spec.cy_px;
  camera.k1 = spec.k1;
  camera.k2 = spec.k2;
  camera.p1 = spec.p1;
  camera.p2 = spec.p2;
  return camera;
}

Result<Path> path_of(const WalkSpec& walk) {
  std::vector<Waypoint> stops;
  for (const StopSpec& stop : walk.stop) {
    const bool turns = stop.heading_deg != StopSpec::kAsItCame;
    stops.push_back({vector(stop.at_m), stop.speed_mps, stop.wait_s, turns ? degrees(stop.heading_deg) : 0.0, turns});
  }
  if (stops.empty()) stops.emplace_back();
  return Path::make(std::move(stops), walk.start_s, degrees(walk.turn_degps), walk.loops);
}

}  // namespace

Pose pose_of(const ShapeSpec& spec, int copy) {
  Pose X = pose_at(vector(spec.position_m) + copy * vector(spec.step_m), degrees(spec.heading_deg));
  const double s = sine(degrees(spec.lean_deg));
  const double c = cosine(degrees(spec.lean_deg));
  Eigen::Matrix3d lean;  // about y: the top goes forward
  lean << c, 0, s, 0, 1, 0, -s, 0, c;
  X.linear() = X.linear() * lean;
  return X;
}

void WorldBuilder::add_materials(const std::vector<MaterialSpec>& specs) {
  for (const MaterialSpec& spec : specs) {
    Material material;
    material.name = spec.name;
    const bool srgb = spec.code == ColorCode::kSrgb;
    material.albedo = srgb ? from_srgb(spec.albedo) : linear(spec.albedo);
    material.second_albedo = srgb ? from_srgb(spec.second) : linear(spec.second);
    material.pattern = spec.pattern;
    material.size_m = static_cast<float>(spec.size_m);
    material.width = static_cast<float>(spec.width);
    material.roughness = static_cast<float>(spec.roughness);
    material.specular = static_cast<float>(spec.specular);
    material.emission_cd_m2 = linear(spec.glow_cd_m2);
    const bool fresh = materials_.emplace(spec.name, world_.scene.add_material(material)).second;
    if (!fresh) complain(spec.line, fmt::format("material '{}': there are two of that name", spec.name));
  }
}

int WorldBuilder::material(const std::string& name, int line, const std::string& who) {
  const auto found = materials_.find(name);
  if (found != materials_.end()) return found->second;
  complain(line, name.empty() ? fmt::format("{}: its material is missing", who)
                              : fmt::format("{}: there is no material '{}'", who, name));
  return 0;
}

void WorldBuilder::add_part(std::string name, Mesh mesh, int material, int figure, const ShapeSpec& spec,
                            bool casts_shadow) {
  size_.triangles += mesh.triangles.size();
  ++(figure < 0 ? size_.still_parts : size_.moving_parts);
  if (size_.triangles > kMost.triangles || size_.still_parts > kMost.still_parts ||
      size_.moving_parts > kMost.moving_parts) {
    return complain(spec.line,
                    fmt::format("'{}': the world has more than {} triangles, {} parts that stand still or {} that move",
                                name, kMost.triangles, kMost.still_parts, kMost.moving_parts));
  }
  Part part;
  part.name = std::move(name);
  part.mesh = std::move(mesh);
  part.material = material;
  part.figure = figure;
  part.casts_shadow = spec.casts_shadow && casts_shadow;
  part.in_map = spec.in_map && figure < 0;
  world_.scene.parts.push_back(std::move(part));
}

void WorldBuilder::add_mesh_parts(const ShapeSpec& spec, const Pose& X_FS, int figure) {
  const std::filesystem::path path = file_.parent_path() / spec.file;
  auto pieces = read_mesh_file(path, spec.scale);
  if (!pieces) return complain(spec.line, fmt::format("shape '{}': {}", spec.name, pieces.error().message));
  for (FilePiece& piece : *pieces) {
    const int own = spec.material.empty() ? world_.scene.add_material(std::move(piece.material))
                                          : material(spec.material, spec.line, fmt::format("shape '{}'", spec.name));
    piece.mesh.transform(X_FS);
    add_part(spec.name + "/" + piece.name, std::move(piece.mesh), own, figure, spec, true);
  }
}

void WorldBuilder::add_parts(const ShapeSpec& spec, const Pose& X_FS, int figure) {
  if (spec.kind == ShapeKind::kMesh) return add_mesh_parts(spec, X_FS, figure);
  const std::string who = fmt::format("shape '{}'", spec.name);
  const int first = material(spec.material, spec.line, who);
  const int second = spec.second_material.empty() ? first : material(spec.second_material, spec.line, who);
  for (Piece& piece : pieces_of(spec)) {
    piece.mesh.transform(X_FS);
    add_part(piece.name.empty() ? spec.name : spec.name + "/" + piece.name, std::move(piece.mesh),
             piece.second ? second : first, figure, spec, piece.casts_shadow);
    if (piece.detail) world_.scene.parts.back().in_map = false;
  }
}

// Stops at the first copy that is wrong: the others would be wrong in the same way.
void WorldBuilder::add_copies(const ShapeSpec& spec, int figure) {
  const std::size_t problems_before = problems_.size();
  for (int copy = 0; copy < spec.count && problems_.size() == problems_before; ++copy) {
    add_parts(spec, pose_of(spec, copy), figure);
  }
}

void WorldBuilder::add_shape(const ShapeSpec& spec) {
  add_copies(spec, -1);
}

void WorldBuilder::set_script(Figure& figure, const WalkSpec& walk, const std::vector<PresenceSpec>& presence,
                              int line) {
  auto path = path_of(walk);
  if (!path) return complain(line, fmt::format("{}: {}", figure.name, path.error().message));
  figure.path = std::move(*path);
  for (const PresenceSpec& key : presence) figure.presence.push_back({key.at_s, key.present, key.outfit});
}

void WorldBuilder::add_ball(const BallSpec& spec) {
  Figure figure;
  figure.name = spec.name;
  figure.kind = FigureKind::kBall;
  figure.joints[0].p_PJ = Eigen::Vector3d(0, 0, spec.radius_m);
  figure.joints[0].drive = JointDrive::kRoll;
  figure.joints[0].amplitude_rad = 1.0 / spec.radius_m;
  set_script(figure, spec.walk, spec.presence, spec.line);
  world_.scene.figures.push_back(figure);
  ShapeSpec shape;
  add_part(spec.name, make_sphere(spec.radius_m),
           material(spec.material, spec.line, fmt::format("ball '{}'", spec.name)),
           static_cast<int>(world_.scene.figures.size()) - 1, shape, true);
}

void WorldBuilder::add_object(const ObjectSpec& spec) {
  Figure figure;
  figure.name = spec.name;
  set_script(figure, spec.walk, spec.presence, spec.line);
  world_.scene.figures.push_back(figure);
  if (spec.shape.empty()) complain(spec.line, fmt::format("object '{}' has no shape", spec.name));
  for (const ShapeSpec& shape : spec.shape) add_copies(shape, static_cast<int>(world_.scene.figures.size()) - 1);
}

void WorldBuilder::add_person(const PersonSpec& spec) {
  Person person{spec.name, spec.identity, spec.height_m, {}};
  for (const OutfitSpec& outfit : spec.outfit) {
    person.outfits.push_back({outfit.shirt, from_srgb(outfit.color), from_srgb(outfit.second),
                              from_srgb(outfit.trousers), outfit.marker, outfit.back_marker});
  }
  const auto outfits = static_cast<int>(std::max<std::size_t>(1, person.outfits.size()));
  for (const PresenceSpec& key : spec.presence) {
    if (key.outfit >= outfits) {
      complain(spec.line, fmt::format("person '{}': outfit {} is worn, there are {}", spec.name, key.outfit, outfits));
    }
  }
  Figure& figure = world_.scene.figures[static_cast<std::size_t>(sim::add_person(world_.scene, person))];
  set_script(figure, spec.walk, spec.presence, spec.line);
  figure.watches_robot = spec.watches_robot;
  figure.makes_way_m = spec.makes_way_m;
  for (const HeadSpec& key : spec.head) figure.head.push_back({key.at_s, degrees(key.yaw_deg), degrees(key.pitch_deg)});
}

void WorldBuilder::add_robot(const RobotSpec& spec) {
  RobotBody robot;
  robot.name = spec.name;
  robot.camera = lens_of(spec.camera);
  robot.camera_height_m = spec.camera_height_m;
  robot.camera_forward_m = spec.camera_forward_m;
  robot.camera_down_rad = degrees(spec.camera_down_deg);
  robot.has_board = spec.has_board;
  robot.board.p_RB = vector(spec.board.position_m);
  robot.board.width_m = spec.board.width_m;
  robot.board.depth_m = spec.board.depth_m;
  robot.board.cone_height_m = spec.board.cone_height_m;
  robot.board.cone_radius_m = spec.board.cone_radius_m;
  robot.board.cones_m.clear();
  for (int i = 0; i < spec.board.cones; ++i) {
    robot.board.cones_m.emplace_back(spec.board.cone_forward_m, (i == 0 ? 1 : -1) * spec.board.cone_aside_m);
  }
  const int index = sim::add_robot(world_.scene, std::move(robot));
  figures_.emplace(spec.name, world_.scene.robots[static_cast<std::size_t>(index)].figure);
  world_.X_WR_start.push_back(pose_at(vector(spec.start_m), degrees(spec.start_heading_deg)));
  world_.robot_walks.emplace_back();
  if (spec.walk.stop.empty()) return;
  auto path = path_of(spec.walk);
  if (!path) return complain(spec.line, fmt::format("robot '{}': {}", spec.name, path.error().message));
  world_.X_WR_start.back() = pose_on_path(path->at(0.0));
  world_.robot_walks.back() = std::move(*path);
}

void WorldBuilder::add_lamp(const LampSpec& spec) {
  Lamp lamp;
  lamp.name = spec.name;
  lamp.p_WL = vector(spec.position_m);
  lamp.radius_m = spec.radius_m;
  lamp.color = linear(spec.color);
  lamp.lumens = spec.lumens;
  lamp.bounce = spec.bounce;
  lamp.visible = spec.visible;
  lamp.on = spec.on;
  lamp.switch_name = spec.switch_name;
  lamp.script = script_of(spec.script);
  if (!spec.carried_by.empty()) {
    const auto carrier = figures_.find(spec.carried_by);
    if (carrier == figures_.end()) {
      complain(spec.line, fmt::format("lamp '{}': there is no robot '{}' to carry it", spec.name, spec.carried_by));
    } else {
      lamp.carried_by = carrier->second;
    }
  }
  const double glass_m = lamp.radius_m > 0.0 ? lamp.radius_m : spec.globe_radius_m;
  if (lamp.visible && glass_m > 0.0) {
    Material glass;
    glass.name = spec.name + " glass";
    glass.albedo = Rgb::Constant(0.8F);
    Part part;
    part.name = spec.name;
    part.mesh = make_sphere(glass_m);
    part.mesh.transform(pose_at(lamp.p_WL));
    part.material = world_.scene.add_material(glass);
    part.figure = lamp.carried_by;
    part.casts_shadow = false;
    part.in_map = false;
    part.lamp = static_cast<int>(world_.scene.lamps.size());
    world_.scene.parts.push_back(std::move(part));
  }
  world_.scene.lamps.push_back(std::move(lamp));
}

void WorldBuilder::set_ambient(const AmbientSpec& spec) {
  world_.scene.ambient.illuminance_lux = linear(spec.illuminance_lux);
  world_.scene.ambient.from_below = spec.from_below;
  world_.scene.ambient.corner_reach_m = spec.corner_reach_m;
  world_.scene.ambient.script = script_of(spec.script);
}

void WorldBuilder::add_view(const ViewSpec& spec) {
  world_.views.push_back({spec.name, look_at(vector(spec.from_m), vector(spec.to_m)), spec.at_s});
}

Result<World> WorldBuilder::finish(const std::string& name) {
  world_.scene.name = name;
  if (problems_.empty()) return std::move(world_);
  std::stable_sort(problems_.begin(), problems_.end(),
                   [](const Problem& a, const Problem& b) { return a.line < b.line; });
  std::string message;
  for (const Problem& problem : problems_) {
    if (!message.empty()) message += '\n';
    message += problem.line > 0 ? fmt::format("{}:{}: {}", file_.string(), problem.line, problem.text)
                                : fmt::format("{}: {}", file_.string(), problem.text);
  }
  return fail(std::move(message));
}

}  // namespace cgsr::sim
