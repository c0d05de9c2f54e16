#include "hal/sim/scene/robot.h"

#include <cstddef>

#include "hal/sim/scene/portable_math.h"
#include "hal/sim/scene/scene.h"
#include "hal/sim/scene/shapes.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector3d;

void add_piece(Scene& scene, int figure, const char* name, Mesh mesh, int material, const Pose& X_RP) {
  mesh.transform(X_RP);
  Part part;
  part.name = scene.figures[static_cast<std::size_t>(figure)].name + "/" + name;
  part.mesh = std::move(mesh);
  part.material = material;
  part.figure = figure;
  part.in_map = false;
  scene.parts.push_back(std::move(part));
}

int paint(Scene& scene, const char* name, const std::array<double, 3>& srgb, float roughness, float specular) {
  Material material;
  material.name = name;
  material.albedo = from_srgb(srgb);
  material.roughness = roughness;
  material.specular = specular;
  return scene.add_material(material);
}

Pose wheel_pose(double y_m) {  // axis along y
  Pose X_RP = Pose::Identity();
  X_RP.translation() = Vector3d(0.0, y_m, 0.24);
  X_RP.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return X_RP;
}

void add_board(Scene& scene, int figure, const ProbeBoard& board, int white, int grey) {
  const Vector3d middle = board.p_RB - Vector3d(0.0, 0.0, board.thickness_m / 2);
  add_piece(scene, figure, "board", make_box({board.depth_m, board.width_m, board.thickness_m}), white,
            pose_at(middle));
  for (const Eigen::Vector2d& foot : board.cones_m) {
    add_piece(scene, figure, "probe", make_cone(board.cone_radius_m, board.cone_height_m), grey,
              pose_at(board.p_RB + Vector3d(foot.x(), foot.y(), 0.0)));
  }
}

}  // namespace

Pose mount_of(const RobotBody& robot) {
  const double s = sine(robot.camera_down_rad);
  const double c = cosine(robot.camera_down_rad);
  Pose X_RC = Pose::Identity();
  X_RC.translation() = Vector3d(robot.camera_forward_m, 0.0, robot.camera_height_m);
  X_RC.linear().col(0) = Vector3d(0.0, -1.0, 0.0);
  X_RC.linear().col(1) = Vector3d(-s, 0.0, -c);
  X_RC.linear().col(2) = Vector3d(c, 0.0, -s);
  return X_RC;
}

int add_robot(Scene& scene, RobotBody robot) {
  Figure figure;
  figure.name = robot.name;
  figure.kind = FigureKind::kRobot;
  scene.figures.push_back(figure);
  robot.figure = static_cast<int>(scene.figures.size()) - 1;

  const int black = paint(scene, "robot black", {0.13, 0.13, 0.14}, 0.4F, 0.04F);
  const int grey = paint(scene, "robot grey", {0.55, 0.56, 0.58}, 0.35F, 0.05F);
  add_piece(scene, robot.figure, "chassis", make_box({0.36, 0.40, 0.18}), grey, pose_at({0.0, 0.0, 0.30}));
  add_piece(scene, robot.figure, "left wheel", make_cylinder(0.24, 0.07), black, wheel_pose(0.24));
  add_piece(scene, robot.figure, "right wheel", make_cylinder(0.24, 0.07), black, wheel_pose(-0.31));
  const double mast_m = robot.camera_height_m - 0.44;
  const double back_m = robot.camera_forward_m - 0.06;
  add_piece(scene, robot.figure, "mast", make_cylinder(0.02, mast_m), grey, pose_at({back_m, 0.0, 0.39}));
  if (robot.has_board) {
    const int white = paint(scene, "probe board", {0.93, 0.93, 0.92}, 1.0F, 0.0F);
    const int matt_grey = paint(scene, "probe cone", {0.80, 0.80, 0.80}, 1.0F, 0.0F);
    add_board(scene, robot.figure, robot.board, white, matt_grey);
  }
  scene.robots.push_back(std::move(robot));
  return static_cast<int>(scene.robots.size()) - 1;
}

}  // namespace cgsr::sim
