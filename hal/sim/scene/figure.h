#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "hal/sim/scene/mesh.h"
#include "hal/sim/scene/path.h"

namespace cgsr::sim {

/// What turns a joint.
enum class JointDrive : std::uint8_t {
  kFixed,
  kSwing,      ///< walking: amplitude * sin(gait + phase), both ways.
  kBend,       ///< walking: amplitude * max(0, sin(gait + phase)): knees and elbows go one way only.
  kRoll,       ///< rolling: walked distance * amplitude (1 / radius).
  kHeadYaw,    ///< the head's script.
  kHeadPitch,  ///< the head's script.
};

/// One joint of a tree. Its frame is its parent's, moved by p_PJ and turned about `axis`.
struct Joint {
  int parent = -1;  ///< -1: the figure itself, standing on its path and facing +x.
  Eigen::Vector3d p_PJ = Eigen::Vector3d::Zero();
  JointDrive drive = JointDrive::kFixed;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  double amplitude_rad = 0.0;
  double phase_rad = 0.0;
  double bias_rad = 0.0;  ///< always there, walking or not.
};

enum class FigureKind : std::uint8_t { kBall, kObject, kPerson, kRobot };
std::string_view to_string(FigureKind kind);

/// From `at_s` on the head looks there, reached by a steady turn of at most 2 rad/s.
struct HeadKey {
  double at_s = 0.0;
  double yaw_rad = 0.0;    ///< to the left of where the body faces.
  double pitch_rad = 0.0;  ///< positive looks down.
};

/// From `at_s` on: is it there at all, and in which clothes.
struct PresenceKey {
  double at_s = 0.0;
  bool present = true;
  int outfit = 0;
};

/// Something that moves: its joints carry the parts of the scene that name them. Robots have no path, their pose comes from their base.
struct Figure {
  std::string name;
  FigureKind kind = FigureKind::kObject;
  std::vector<Joint> joints{Joint{}};
  Path path;
  double stride_m = 1.3;  ///< of two steps: one period of the gait.
  std::vector<HeadKey> head;
  std::vector<PresenceKey> presence;
  /// Faces the robot that drives wherever it stands; its path says where, not the heading.
  bool watches_robot = false;
  double makes_way_m = 0.0;  ///< steps aside where it would be nearer to the robot that drives; 0: does not.
};

/// The poses of all joints in the world, X_WJ, for a body that stands at X_WF and has walked `walked_m` at `speed_mps` by `time_s`.
std::vector<Pose> pose_joints(const Figure& figure, const Pose& X_WF, double time_s, double walked_m, double speed_mps);

/// The pose of a figure on its path: origin on the path, x axis along its heading, z up.
Pose pose_on_path(const PathPoint& point);

/// Where the head looks at a time.
HeadKey head_at(const std::vector<HeadKey>& script, double time_s);

/// Presence and outfit at a time; present in outfit 0 where the script says nothing yet.
PresenceKey presence_at(const std::vector<PresenceKey>& script, double time_s);

}  // namespace cgsr::sim
