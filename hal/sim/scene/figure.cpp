#include "hal/sim/scene/figure.h"

#include <algorithm>
#include <cmath>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

Eigen::Matrix3d rotation(const Eigen::Vector3d& axis, double angle_rad) {  // Rodrigues, with portable sines
  const Eigen::Vector3d a = axis.normalized();
  Eigen::Matrix3d cross;
  cross << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return Eigen::Matrix3d::Identity() + sine(angle_rad) * cross + (1.0 - cosine(angle_rad)) * cross * cross;
}

double angle_of(const Joint& joint, double gait_rad, double vigour, double walked_m, const HeadKey& head) {
  const double swing = sine(wrap_angle(gait_rad + joint.phase_rad));
  switch (joint.drive) {
    case JointDrive::kFixed:
      return joint.bias_rad;
    case JointDrive::kSwing:
      return joint.bias_rad + vigour * joint.amplitude_rad * swing;
    case JointDrive::kBend:
      return joint.bias_rad + vigour * joint.amplitude_rad * std::max(0.0, swing);
    case JointDrive::kRoll:
      return joint.bias_rad + joint.amplitude_rad * walked_m;
    case JointDrive::kHeadYaw:
      return joint.bias_rad + head.yaw_rad;
    case JointDrive::kHeadPitch:
      return joint.bias_rad + head.pitch_rad;
  }
  return 0.0;
}

double turned(double from_rad, double to_rad, double most_rad) {
  return from_rad + std::clamp(wrap_angle(to_rad - from_rad), -most_rad, most_rad);
}

}  // namespace

std::string_view to_string(FigureKind kind) {
  switch (kind) {
    case FigureKind::kBall:
      return "ball";
    case FigureKind::kObject:
      return "object";
    case FigureKind::kPerson:
      return "person";
    case FigureKind::kRobot:
      return "robot";
  }
  return "";
}

std::vector<Pose> pose_joints(const Figure& figure, const Pose& X_WF, double time_s, double walked_m,
                              double speed_mps) {
  const HeadKey head = head_at(figure.head, time_s);
  const double gait_rad = 2.0 * kPi * walked_m / figure.stride_m;
  const double vigour = std::clamp(speed_mps / 1.1, 0.0, 1.0);
  std::vector<Pose> poses;
  for (const Joint& joint : figure.joints) {
    Pose X_PJ = Pose::Identity();
    X_PJ.translation() = joint.p_PJ;
    X_PJ.linear() = rotation(joint.axis, angle_of(joint, gait_rad, vigour, walked_m, head));
    poses.push_back((joint.parent < 0 ? X_WF : poses[static_cast<std::size_t>(joint.parent)]) * X_PJ);
  }
  return poses;
}

Pose pose_on_path(const PathPoint& point) {
  Pose X_WF = Pose::Identity();
  X_WF.translation() = point.p_W;
  X_WF.linear() = rotation(Eigen::Vector3d::UnitZ(), point.heading_rad);
  return X_WF;
}

HeadKey head_at(const std::vector<HeadKey>& script, double time_s) {
  HeadKey now;
  for (std::size_t i = 0; i < script.size() && script[i].at_s <= time_s; ++i) {
    const double until = i + 1 < script.size() ? std::min(time_s, script[i + 1].at_s) : time_s;
    const double most = 2.0 * (until - script[i].at_s);
    now.at_s = script[i].at_s;
    now.yaw_rad = turned(now.yaw_rad, script[i].yaw_rad, most);
    now.pitch_rad = turned(now.pitch_rad, script[i].pitch_rad, most);
  }
  return now;
}

PresenceKey presence_at(const std::vector<PresenceKey>& script, double time_s) {
  PresenceKey now;
  for (const PresenceKey& key : script) {
    if (key.at_s <= time_s) now = key;
  }
  return now;
}

}  // namespace cgsr::sim
