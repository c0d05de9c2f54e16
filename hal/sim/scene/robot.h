#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "hal/sim/scene/camera_model.h"
#include "hal/sim/scene/mesh.h"

namespace cgsr::sim {

struct Scene;

/// A white board in front of the camera with matt cones standing on it: what makes a lamp's direction visible.
/// Defaults: with the camera 0.30 m above the board and tilted 20 degrees down, board and cones fill the image's lower third and the
/// cones stand near its left and right edges.
struct ProbeBoard {
  Eigen::Vector3d p_RB{0.44, 0.0, 0.90};  ///< centre of the board's upper face, robot frame.
  double width_m = 0.74;                  ///< across.
  double depth_m = 0.34;
  double thickness_m = 0.008;
  double cone_height_m = 0.10;
  double cone_radius_m = 0.02;  ///< of the base.
  std::vector<Eigen::Vector2d> cones_m{{0.01, 0.20},
                                       {0.01, -0.20}};  ///< on the board, from its centre; x forward, y left.
};

/// A robot as the simulator draws it and looks out of it.
struct RobotBody {
  std::string name = "robot";
  CameraModel camera;
  double camera_height_m = 1.20;
  double camera_forward_m = 0.0;
  double camera_down_rad = 0.0;  ///< tilt below the horizon.
  bool has_board = false;
  ProbeBoard board;
  int figure = -1;  ///< of the scene, once added.
};

/// The camera's mount: the pose of C (x right, y down, z forward) in R.
Pose mount_of(const RobotBody& robot);

/// Adds the robot's figure and parts (chassis, wheels, mast, camera; board and cones) to the scene. \return its index in `scene.robots`.
int add_robot(Scene& scene, RobotBody robot);

}  // namespace cgsr::sim
