#include "hal/sim/calibration/calibrated_copy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>

#include <Eigen/Geometry>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kLongestFurniture_m = 2.5;
constexpr float kFlat_m = 1e-3F;
constexpr float kTouching_m = 0.02F;

// Normal numbers that are the same on every machine: twelve uniform ones, whose sum has the variance 1.
class Errors {
 public:
  explicit Errors(std::uint32_t seed) : seed_(seed) {}

  double normal(double sigma) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(unit(mix(seed_, ++drawn_)));
    return sigma * sum;
  }
  Vector3d vector(double sigma) {
    const double x = normal(sigma);
    const double y = normal(sigma);
    return {x, y, normal(sigma)};
  }

 private:
  std::uint32_t seed_;
  std::uint32_t drawn_ = 0;
};

CameraModel measured(const CameraModel& truth, const CalibrationErrors& sigma, Errors& errors) {
  CameraModel camera = truth;
  camera.fx_px *= 1.0 + errors.normal(sigma.focal);
  camera.fy_px *= 1.0 + errors.normal(sigma.focal);
  camera.cx_px += errors.normal(sigma.centre_px);
  camera.cy_px += errors.normal(sigma.centre_px);
  for (double* coefficient : {&camera.k1, &camera.k2, &camera.p1, &camera.p2, &camera.k3}) {
    *coefficient *= 1.0 + errors.normal(sigma.distortion);
  }
  return camera;
}

Pose measured(const Pose& truth, const CalibrationErrors& sigma, Errors& errors) {
  Pose X = truth;
  X.translation() += errors.vector(sigma.mount_m);
  const Vector3d turn = errors.vector(degrees(sigma.mount_deg));
  // A small turn, by its half angles: no library function that differs between machines.
  Eigen::Quaterniond q(1.0, turn.x() / 2.0, turn.y() / 2.0, turn.z() / 2.0);
  X.linear() = X.linear() * q.normalized().toRotationMatrix();
  return X;
}

MeasuredBoard measured(const ProbeBoard& truth, const CalibrationErrors& sigma, Errors& errors) {
  MeasuredBoard board;
  board.p_RB = truth.p_RB;
  board.p_RB.z() += errors.normal(sigma.probe_m);
  board.width_m = truth.width_m;
  board.depth_m = truth.depth_m;
  for (const Eigen::Vector2d& foot : truth.cones_m) {
    MeasuredProbe probe;
    probe.p_RF = board.p_RB + Vector3d(foot.x(), foot.y(), 0.0);
    probe.p_RA = truth.p_RB + Vector3d(foot.x(), foot.y(), truth.cone_height_m) + errors.vector(sigma.probe_m);
    probe.base_radius_m = truth.cone_radius_m;
    board.probes.push_back(probe);
  }
  return board;
}

std::string thing_of(const Part& part) {
  return part.name.substr(0, part.name.find('/'));
}

// Where a thing is, and, if all of it lies in one plane, that plane's normal.
struct Extent {
  Eigen::AlignedBox3f box;
  Vector3f normal = Vector3f::Zero();
  float least = 0.0F;
  float most = 0.0F;

  void add(const Mesh& mesh) {
    if (mesh.triangles.empty()) return;
    if (normal.isZero()) {
      const auto& corner = mesh.triangles[0].corner;
      const Vector3f& a = mesh.position_m[corner[0]];
      normal = (mesh.position_m[corner[1]] - a).cross(mesh.position_m[corner[2]] - a).normalized();
      least = most = normal.dot(a);
    }
    for (const Vector3f& p : mesh.position_m) {
      box.extend(p);
      least = std::min(least, normal.dot(p));
      most = std::max(most, normal.dot(p));
    }
  }
  [[nodiscard]] bool flat() const { return most - least < kFlat_m; }
};

// How far a piece of furniture is from where the map has it.
struct Misplacement {
  Vector3d centre = Vector3d::Zero();
  Vector3d shift = Vector3d::Zero();
  double turn_rad = 0.0;

  /// `by` more.
  void move(const Vector3d& by) { shift += by; }

  void apply(Mesh& mesh) const {
    Pose X = Pose::Identity();
    X.linear() << cosine(turn_rad), -sine(turn_rad), 0, sine(turn_rad), cosine(turn_rad), 0, 0, 0, 1;
    X.translation() = centre + shift - X.linear() * centre;
    mesh.transform(X);
  }
};

Misplacement misplacement(const Extent& extent, const CalibrationErrors& sigma, Errors& errors) {
  Misplacement wrong;
  const double x = errors.normal(sigma.map_place_m);
  const double y = errors.normal(sigma.map_place_m);
  const double turn = errors.normal(degrees(sigma.map_heading_deg));
  if (static_cast<double>(extent.box.sizes().maxCoeff()) > kLongestFurniture_m) return wrong;
  wrong.centre = extent.box.center().cast<double>();
  wrong.shift = {x, y, 0.0};
  const Vector3d n = extent.normal.cast<double>();
  const bool upright = extent.flat() && std::abs(n.z()) < 0.9;
  if (upright) {
    wrong.shift -= wrong.shift.dot(n) * n;
  } else {
    wrong.turn_rad = turn;
  }
  return wrong;
}

// What lies flat on something: tape, paint, paper.
bool lies_flat(const Scene& scene, const std::string& thing, const Extent& extent) {
  return extent.flat() && std::ranges::none_of(scene.parts, [&](const Part& part) {
           return part.figure < 0 && part.in_map && part.casts_shadow && thing_of(part) == thing;
         });
}

// The thing that `extent` lies on: one with a face in the same plane, or nearly, at that place. Empty: none.
std::string carrier_of(const Scene& scene, const std::map<std::string, Extent>& extents, const std::string& thing) {
  const Extent& own = extents.at(thing);
  const Vector3f centre = own.box.center();
  for (const Part& part : scene.parts) {
    std::string other = thing_of(part);
    if (part.figure >= 0 || !part.in_map || !part.casts_shadow || other == thing) continue;
    const Extent& extent = extents.at(other);
    if (extent.box.squaredExteriorDistance(centre) > kTouching_m * kTouching_m) continue;
    const Mesh& mesh = part.mesh;
    for (const Mesh::Triangle& triangle : mesh.triangles) {
      const Vector3f& a = mesh.position_m[triangle.corner[0]];
      const Vector3f n =
          (mesh.position_m[triangle.corner[1]] - a).cross(mesh.position_m[triangle.corner[2]] - a).normalized();
      if (std::abs(n.dot(own.normal)) > 0.999F && std::abs(n.dot(centre - a)) < kTouching_m) return other;
    }
  }
  return {};
}

// How far each rigid part is from where the map has it.
std::map<std::string, Vector3d> part_moves(const Scene& scene, const std::map<std::string, Extent>& extents,
                                           double sigma_m, Errors& errors) {
  std::map<std::string, Vector3d> moves;
  for (const auto& [thing, extent] : extents) {
    Vector3d by = errors.vector(sigma_m);
    if (extent.box.min().z() < kTouching_m) by.z() = 0.0;
    moves[thing] = by;
  }
  for (const auto& [thing, extent] : extents) {
    if (!lies_flat(scene, thing, extent)) continue;
    const Vector3d n = extent.normal.cast<double>();
    const std::string carrier = carrier_of(scene, extents, thing);
    const double with_it = carrier.empty() ? 0.0 : moves.at(carrier).dot(n);
    Vector3d& by = moves.at(thing);
    by += (with_it - by.dot(n)) * n;
  }
  return moves;
}

Scene measured_map(const Scene& truth, const CalibrationErrors& sigma, Errors& errors) {
  Scene map;
  map.name = truth.name;
  map.materials = truth.materials;
  for (Material& material : map.materials) {
    for (Rgb* color : {&material.albedo, &material.second_albedo}) {
      for (int channel = 0; channel < 3; ++channel) {
        const double encoded = srgb_encode(static_cast<double>((*color)[channel])) + errors.normal(sigma.map_color);
        if (sigma.map_color > 0.0) (*color)[channel] = static_cast<float>(srgb_decode(std::clamp(encoded, 0.0, 1.0)));
      }
    }
  }
  std::map<std::string, Extent> extents;
  for (const Part& part : truth.parts) {
    if (part.figure < 0 && part.in_map) extents[thing_of(part)].add(part.mesh);
  }
  std::map<std::string, Vector3d> moves;
  if (sigma.map_part_m > 0.0) moves = part_moves(truth, extents, sigma.map_part_m, errors);
  const Vector3d stretch = Vector3d::Ones() + errors.vector(sigma.map_scale);
  std::map<std::string, Misplacement> wrong;
  for (const auto& [thing, extent] : extents) wrong[thing] = misplacement(extent, sigma, errors);
  for (const auto& [thing, by] : moves) wrong[thing].move(by);
  for (const Part& part : truth.parts) {
    if (part.figure >= 0 || !part.in_map) continue;
    map.parts.push_back(part);
    Mesh& mesh = map.parts.back().mesh;
    wrong[thing_of(part)].apply(mesh);
    for (Vector3f& p : mesh.position_m) p = p.cast<double>().cwiseProduct(stretch).cast<float>();
  }
  return map;
}

}  // namespace

CalibrationErrors CalibrationErrors::none() {
  return CalibrationErrors{}.times(0.0);
}

CalibrationErrors CalibrationErrors::chapter_4() {
  CalibrationErrors errors = none();
  errors.focal = 0.002;
  errors.centre_px = 0.5;
  errors.distortion = 0.002;
  errors.mount_deg = 0.3;
  errors.map_part_m = 0.005;
  return errors;
}

CalibrationErrors CalibrationErrors::times(double factor) const {
  CalibrationErrors scaled = *this;
  for (double* sigma :
       {&scaled.focal, &scaled.centre_px, &scaled.distortion, &scaled.mount_m, &scaled.mount_deg, &scaled.probe_m,
        &scaled.map_scale, &scaled.map_place_m, &scaled.map_heading_deg, &scaled.map_part_m, &scaled.map_color}) {
    *sigma *= factor;
  }
  return scaled;
}

CalibratedCopy calibrated_copy(const Scene& scene, int robot, const CalibrationErrors& errors, std::uint32_t seed) {
  const RobotBody& body = scene.robots[static_cast<std::size_t>(robot)];
  // A sequence of its own for each: one more material does not change the camera.
  Errors of_camera(mix(seed, 1));
  Errors of_mount(mix(seed, 2));
  Errors of_board(mix(seed, 3));
  Errors of_map(mix(seed, 4));
  CalibratedCopy copy;
  copy.robot = body.name;
  copy.camera = measured(body.camera, errors, of_camera);
  copy.X_RC = measured(mount_of(body), errors, of_mount);
  copy.has_board = body.has_board;
  if (body.has_board) copy.board = measured(body.board, errors, of_board);
  copy.map = measured_map(scene, errors, of_map);
  return copy;
}

}  // namespace cgsr::sim
