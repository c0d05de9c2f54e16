// What makes a world unfit, beyond what one table can say about itself.
#include <cmath>
#include <cstddef>
#include <set>

#include <fmt/format.h>

#include "hal/sim/worlds/builder.h"

namespace cgsr::sim {
namespace {

constexpr double kSmallest_m = 1e-3;
constexpr double kLargest_m = 1000.0;

bool is_solid(ShapeKind kind) {
  return kind == ShapeKind::kBox || kind == ShapeKind::kCylinder || kind == ShapeKind::kCone ||
         kind == ShapeKind::kSphere;
}

int zero_sides(const Triple& size) {
  int count = 0;
  for (const double side : size) count += side == 0.0 ? 1 : 0;
  return count;
}

template <class Specs>
void check_unique(const Specs& specs, const char* what, std::set<std::string>& seen,
                  std::vector<std::pair<int, std::string>>& problems) {
  for (const auto& spec : specs) {
    if (spec.name.empty()) {
      problems.emplace_back(spec.line, fmt::format("a {} without a name", what));
    } else if (!seen.insert(spec.name).second) {
      problems.emplace_back(spec.line, fmt::format("{} '{}': there is something else of that name", what, spec.name));
    }
  }
}

}  // namespace

std::string ShapeSpec::inconsistency() const {
  if (name.empty()) return "a shape needs a name";
  if (kind == ShapeKind::kMesh) return file.empty() ? "a mesh needs its file" : "";
  if (!file.empty()) return "file belongs to a mesh only";
  const int zeros = zero_sides(size_m);
  if (kind == ShapeKind::kRectangle || kind == ShapeKind::kCheckerboard) {
    if (zeros != 1)
      return fmt::format("size_m = [{}, {}, {}]: a flat shape has exactly one side of 0", size_m[0], size_m[1],
                         size_m[2]);
  } else if (kind == ShapeKind::kDisc) {
    if (size_m[0] == 0.0 || size_m[2] != 0.0) return "size_m: a disc is [diameter, diameter, 0]";
  } else if (zeros != 0) {
    return fmt::format("size_m = [{}, {}, {}]: every side of a solid is above 0", size_m[0], size_m[1], size_m[2]);
  }
  for (const double side : size_m) {
    if (side != 0.0 && side < kSmallest_m) return fmt::format("size_m: {} m is below 1 mm; is it in metres?", side);
  }
  const bool round = kind == ShapeKind::kDisc || kind == ShapeKind::kCylinder || kind == ShapeKind::kCone;
  if (round && size_m[1] != size_m[0]) return "size_m: the first two are the diameter, so they are equal";
  return "";
}

std::vector<Solid> solids_of(const WorldSpec& spec) {
  std::vector<Solid> solids;
  for (const ShapeSpec& shape : spec.shape) {
    if (!is_solid(shape.kind)) continue;
    for (int copy = 0; copy < shape.count; ++copy) solids.push_back({&shape, pose_of(shape, copy)});
  }
  return solids;
}

bool is_inside(const Solid& solid, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p = solid.X_WS.inverse() * p_W;
  const Triple& s = solid.shape->size_m;
  if (p.z() < kSmallest_m || p.z() > s[2] - kSmallest_m) return false;
  const double x = 2.0 * p.x() / s[0];
  const double y = 2.0 * p.y() / s[1];
  const double z = p.z() / s[2];
  switch (solid.shape->kind) {
    case ShapeKind::kBox:
      return std::abs(x) < 1.0 && std::abs(y) < 1.0;
    case ShapeKind::kCylinder:
      return x * x + y * y < 1.0;
    case ShapeKind::kCone:
      return x * x + y * y < (1.0 - z) * (1.0 - z);
    case ShapeKind::kSphere:
      return x * x + y * y + (2.0 * z - 1.0) * (2.0 * z - 1.0) < 1.0;
    default:
      return false;
  }
}

void WorldBuilder::check_names(const WorldSpec& spec) {
  std::vector<std::pair<int, std::string>> problems;
  std::set<std::string> moving;  // truth tells them apart by name
  check_unique(spec.ball, "ball", moving, problems);
  check_unique(spec.object, "object", moving, problems);
  check_unique(spec.person, "person", moving, problems);
  check_unique(spec.robot, "robot", moving, problems);
  std::set<std::string> lamps;
  check_unique(spec.lamp, "lamp", lamps, problems);
  for (auto& [line, text] : problems) complain(line, std::move(text));
}

void WorldBuilder::check(const WorldSpec& spec) {
  check_names(spec);
  if (spec.robot.empty()) complain(0, "there is no [[robot]], and so no camera");
  if (world_.scene.parts.empty()) complain(0, "there is nothing to see: no [[shape]]");
  for (const Part& part : world_.scene.parts) {
    const Eigen::AlignedBox3f box = bounds(part.mesh);
    if (part.mesh.triangles.empty()) continue;
    if (!box.min().allFinite() || !box.max().allFinite()) {
      complain(0, fmt::format("'{}' has a corner that is not finite", part.name));
    } else if (static_cast<double>(box.sizes().maxCoeff()) < kSmallest_m) {
      complain(0, fmt::format("'{}' is smaller than 1 mm; is its scale right?", part.name));
    } else if (static_cast<double>(std::max(box.max().cwiseAbs().maxCoeff(), box.min().cwiseAbs().maxCoeff())) >
               kLargest_m) {
      complain(0, fmt::format("'{}' reaches beyond 1 km; is its scale right?", part.name));
    }
  }
  const std::vector<Solid> solids = solids_of(spec);
  for (const LampSpec& lamp : spec.lamp) {
    if (!lamp.carried_by.empty()) continue;
    const Eigen::Vector3d p_WL(lamp.position_m[0], lamp.position_m[1], lamp.position_m[2]);
    for (const Solid& solid : solids) {
      if (!solid.shape->casts_shadow || !is_inside(solid, p_WL)) continue;
      complain(lamp.line, fmt::format("lamp '{}' is inside '{}' (line {}): it would light nothing", lamp.name,
                                      solid.shape->name, solid.shape->line));
      break;
    }
  }
}

}  // namespace cgsr::sim
