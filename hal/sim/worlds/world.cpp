#include "hal/sim/worlds/world.h"

#include "hal/sim/worlds/builder.h"
#include "hal/sim/worlds/planar_world.h"

namespace cgsr::sim {

std::vector<Pose> scripted_robots(const World& world, double time_s) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < world.X_WR_start.size(); ++i) {
    const std::optional<Path>& walk = world.robot_walks[i];
    poses.push_back(walk ? pose_on_path(walk->at(time_s)) : world.X_WR_start[i]);
  }
  return poses;
}

Result<World> build_world(const WorldSpec& spec, const std::filesystem::path& file_name) {
  WorldBuilder builder(file_name);
  WorldSpec whole = spec;
  if (spec.planar.edges > 0) add_planar_world(spec.planar, whole);
  builder.add_materials(whole.material);
  for (const ShapeSpec& shape : whole.shape) builder.add_shape(shape);
  for (const BallSpec& ball : whole.ball) builder.add_ball(ball);
  for (const ObjectSpec& object : whole.object) builder.add_object(object);
  for (const PersonSpec& person : whole.person) builder.add_person(person);
  for (const RobotSpec& robot : whole.robot) builder.add_robot(robot);
  for (const LampSpec& lamp : whole.lamp) builder.add_lamp(lamp);
  builder.set_ambient(whole.ambient);
  for (const ViewSpec& view : whole.view) builder.add_view(view);
  builder.check(whole);
  auto world = builder.finish(spec.name);
  if (!world) return world;
  world->sensor.exposure_s = spec.exposure_s;
  world->sensor.gain = spec.gain;
  return world;
}

}  // namespace cgsr::sim
