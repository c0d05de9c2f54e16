#include "hal/sim/people/body.h"

#include "hal/sim/scene/portable_math.h"
#include "hal/sim/scene/scene.h"
#include "hal/sim/scene/shapes.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector3d;

constexpr double kDrawnFor_m = 1.72;  // the height that the numbers below are for

enum JointIndex {
  kRoot,
  kPelvis,
  kTorso,
  kNeck,
  kHead,
  kThighL,
  kShinL,
  kThighR,
  kShinR,
  kArmL,
  kForearmL,
  kArmR,
  kForearmR
};

Joint joint(int parent, const Vector3d& p, JointDrive drive = JointDrive::kFixed, double amplitude = 0.0,
            double phase = 0.0, double bias = 0.0) {
  return {parent, p, drive, Vector3d::UnitY(), amplitude, phase, bias};
}

Mesh scaled_loft(std::vector<Station> stations, double k) {
  for (Station& s : stations) s = {s.z_m * k, s.half_width_m * k, s.half_depth_m * k, s.centre_x_m * k};
  return make_lofted(stations, 36);
}

// Stripes run around the body: the pattern's u is the height.
Mesh turned(Mesh mesh, double from_m) {
  for (Eigen::Vector2f& uv : mesh.uv) uv = Eigen::Vector2f(uv.y() - static_cast<float>(from_m), uv.x());
  return mesh;
}

Mesh limb(double length, double upper, double lower, double k) {
  const double middle = 0.45 * lower + 0.6 * upper;
  return scaled_loft({{-length - 0.5 * lower, 0.6 * lower, 0.6 * lower},
                      {-length, lower, lower},
                      {-0.6 * length, middle, middle},
                      {-0.2 * length, upper, upper},
                      {0.0, 0.96 * upper, 0.96 * upper},
                      {0.45 * upper, 0.84 * upper, 0.84 * upper},
                      {0.75 * upper, 0.58 * upper, 0.58 * upper},
                      {0.92 * upper, 0.25 * upper, 0.25 * upper}},
                     k);
}

Mesh ellipsoid_at(const Vector3d& axes, const Vector3d& p, double k) {
  Mesh mesh = make_ellipsoid(axes * k, 24, 16);
  mesh.transform(pose_at(p * k));
  return mesh;
}

}  // namespace

std::vector<Joint> body_joints(double height_m) {
  const double k = height_m / kDrawnFor_m;
  constexpr double kStep = 0.42;
  constexpr double kKnee = 0.75;
  std::vector<Joint> joints(kForearmR + 1);
  joints[kRoot] = joint(-1, Vector3d::Zero());
  joints[kPelvis] = joint(kRoot, Vector3d(0, 0, 0.93) * k);
  joints[kTorso] = joint(kPelvis, Vector3d(0, 0, 0.05) * k);
  joints[kNeck] = joint(kTorso, Vector3d(-0.01, 0, 0.50) * k, JointDrive::kHeadYaw);
  joints[kNeck].axis = Vector3d::UnitZ();
  joints[kHead] = joint(kNeck, Vector3d(0.015, 0, 0.12) * k, JointDrive::kHeadPitch);
  joints[kThighL] = joint(kPelvis, Vector3d(0, 0.092, -0.03) * k, JointDrive::kSwing, kStep, 0.0);
  joints[kShinL] = joint(kThighL, Vector3d(0, 0, -0.43) * k, JointDrive::kBend, kKnee, -kPi / 2, 0.03);
  joints[kThighR] = joint(kPelvis, Vector3d(0, -0.092, -0.03) * k, JointDrive::kSwing, kStep, kPi);
  joints[kShinR] = joint(kThighR, Vector3d(0, 0, -0.43) * k, JointDrive::kBend, kKnee, kPi / 2, 0.03);
  joints[kArmL] = joint(kTorso, Vector3d(-0.01, 0.186, 0.405) * k, JointDrive::kSwing, 0.35, kPi);
  joints[kForearmL] = joint(kArmL, Vector3d(0, 0.01, -0.28) * k, JointDrive::kFixed, 0, 0, -0.22);
  joints[kArmR] = joint(kTorso, Vector3d(-0.01, -0.186, 0.405) * k, JointDrive::kSwing, 0.35, 0.0);
  joints[kForearmR] = joint(kArmR, Vector3d(0, -0.01, -0.28) * k, JointDrive::kFixed, 0, 0, -0.22);
  return joints;
}

std::vector<BodyPart> body_parts(double height_m) {
  const double k = height_m / kDrawnFor_m;
  std::vector<BodyPart> parts;
  parts.push_back(
      {"trousers", kPelvis, Cover::kTrousers,
       scaled_loft({{-0.13, 0.10, 0.08}, {-0.10, 0.155, 0.11}, {0.0, 0.168, 0.112}, {0.08, 0.15, 0.10}}, k)});
  parts.push_back({"shirt", kTorso, Cover::kShirt,
                   turned(scaled_loft({{-0.05, 0.166, 0.115},
                                       {-0.04, 0.170, 0.118},
                                       {0.10, 0.157, 0.108},
                                       {0.25, 0.178, 0.120, 0.008},
                                       {0.36, 0.190, 0.118, 0.006},
                                       {0.42, 0.186, 0.105},
                                       {0.455, 0.150, 0.088, -0.005},
                                       {0.48, 0.085, 0.068, -0.008},
                                       {0.495, 0.062, 0.060, -0.010}},
                                      k),
                          -0.05 * k)});
  parts.push_back({"neck", kTorso, Cover::kSkin,
                   scaled_loft({{0.44, 0.062, 0.062, -0.012},
                                {0.50, 0.055, 0.058, -0.008},
                                {0.58, 0.052, 0.056, 0.0},
                                {0.62, 0.05, 0.05, 0.0}},
                               k)});
  for (const bool left : {true, false}) {
    parts.push_back({"thigh", left ? kThighL : kThighR, Cover::kTrousers, limb(0.43, 0.088, 0.062, k)});
    parts.push_back({"shin", left ? kShinL : kShinR, Cover::kTrousers, limb(0.40, 0.062, 0.050, k)});
    parts.push_back(
        {"shoe", left ? kShinL : kShinR, Cover::kShoe, ellipsoid_at({0.135, 0.047, 0.040}, {0.055, 0, -0.430}, k)});
    Mesh sleeve = turned(limb(0.24, 0.058, 0.049, k), -0.30 * k);
    parts.push_back({"sleeve", left ? kArmL : kArmR, Cover::kSleeve, std::move(sleeve)});
    parts.push_back({"elbow", left ? kArmL : kArmR, Cover::kSkin, limb(0.28, 0.040, 0.038, k)});
    parts.push_back({"forearm", left ? kForearmL : kForearmR, Cover::kSkin, limb(0.24, 0.039, 0.028, k)});
    parts.push_back(
        {"hand", left ? kForearmL : kForearmR, Cover::kSkin, ellipsoid_at({0.035, 0.018, 0.075}, {0.01, 0, -0.32}, k)});
  }
  return parts;
}

}  // namespace cgsr::sim
