#include "hal/sim/worlds/furniture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hal/sim/scene/portable_math.h"
#include "hal/sim/scene/scene.h"
#include "hal/sim/scene/shapes.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector3d;
using Pieces = std::vector<Piece>;

// A box by its middle and size.
void add_box(Pieces& pieces, const char* name, const Vector3d& middle, const Vector3d& size, bool second = false,
             bool detail = false) {
  Mesh mesh = make_box(size);
  mesh.transform(pose_at(middle));
  pieces.push_back({name, std::move(mesh), second, true, detail});
}

// Four legs under a plate of the given height.
void add_legs(Pieces& pieces, const Vector3d& size, double height, double thick, double inset, bool detail) {
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      add_box(pieces, "leg",
              {sx * (size.x() / 2 - inset - thick / 2), sy * (size.y() / 2 - inset - thick / 2), height / 2},
              {thick, thick, height}, true, detail);
    }
  }
}

Pieces table(const Vector3d& s) {
  Pieces pieces;
  constexpr double kTop = 0.03;
  add_box(pieces, "top", {0, 0, s.z() - kTop / 2}, {s.x(), s.y(), kTop});
  add_legs(pieces, s, s.z() - kTop, 0.05, 0.04, false);
  return pieces;
}

Pieces chair(const Vector3d& s) {
  Pieces pieces;
  const double seat = 0.5 * s.z();
  add_box(pieces, "seat", {0, 0, seat - 0.02}, {s.x(), s.y(), 0.04});
  add_box(pieces, "back", {-s.x() / 2 + 0.015, 0, 0.82 * s.z()}, {0.03, s.y(), 0.36 * s.z()});
  add_box(pieces, "post", {-s.x() / 2 + 0.015, s.y() / 2 - 0.03, seat + 0.075 * s.z()}, {0.025, 0.03, 0.15 * s.z()},
          true, true);
  add_box(pieces, "post", {-s.x() / 2 + 0.015, -s.y() / 2 + 0.03, seat + 0.075 * s.z()}, {0.025, 0.03, 0.15 * s.z()},
          true, true);
  add_legs(pieces, s, seat - 0.04, 0.035, 0.01, true);
  return pieces;
}

Pieces shelf(const Vector3d& s) {
  Pieces pieces;
  constexpr double kBoard = 0.025;
  for (const double side : {-1.0, 1.0}) {
    add_box(pieces, "side", {0, side * (s.y() - kBoard) / 2, s.z() / 2}, {s.x(), kBoard, s.z()});
  }
  add_box(pieces, "rear", {-s.x() / 2 + 0.005, 0, s.z() / 2}, {0.01, s.y() - 2 * kBoard, s.z()});
  const int boards = std::max(2, static_cast<int>(std::lround(s.z() / 0.36)) + 1);
  const double gap = (s.z() - kBoard) / (boards - 1);
  for (int i = 0; i < boards; ++i) {
    add_box(pieces, "board", {0.005, 0, kBoard / 2 + i * gap}, {s.x() - 0.01, s.y() - 2 * kBoard, kBoard});
    if (i + 1 == boards) continue;
    // A row of books that leaves some room.
    const double filled =
        (0.45 + 0.5 * static_cast<double>(unit(mix(static_cast<std::uint32_t>(i), 7U)))) * (s.y() - 2 * kBoard);
    const double high = (0.6 + 0.2 * static_cast<double>(unit(mix(static_cast<std::uint32_t>(i), 8U)))) * gap;
    const double from = (i % 2 == 0 ? -1.0 : 1.0) * ((s.y() - 2 * kBoard) - filled) / 2;
    add_box(pieces, "books", {-0.01, from, kBoard + i * gap + high / 2 + 0.0005}, {0.8 * s.x(), filled, high}, true,
            true);
  }
  return pieces;
}

Pieces cabinet(const Vector3d& s) {
  Pieces pieces;
  constexpr double kDoor = 0.018;
  add_box(pieces, "body", {-kDoor / 2, 0, s.z() / 2}, {s.x() - kDoor, s.y(), s.z()});
  const int doors = std::max(1, static_cast<int>(std::lround(s.y() / 0.6)));
  const double wide = s.y() / doors;
  for (int i = 0; i < doors; ++i) {
    const double y = -s.y() / 2 + (i + 0.5) * wide;
    add_box(pieces, "door", {s.x() / 2 - kDoor / 2, y, s.z() / 2}, {kDoor, wide - 0.008, s.z() - 0.05});
    add_box(pieces, "handle", {s.x() / 2 + 0.01, y + (i % 2 == 0 ? 1 : -1) * (wide / 2 - 0.05), 0.6 * s.z()},
            {0.02, 0.015, 0.12}, true, true);
  }
  return pieces;
}

Pieces sofa(const Vector3d& s) {
  Pieces pieces;
  const double arm = 0.16;
  const double seat = 0.5 * s.z();
  add_box(pieces, "base", {0, 0, 0.3 * s.z()}, {s.x() - 0.02, s.y() - 0.02, 0.45 * s.z()});
  add_box(pieces, "back", {-s.x() / 2 + 0.1, 0, 0.64 * s.z()}, {0.2, s.y() - 0.03, 0.72 * s.z()});
  for (const double side : {-1.0, 1.0}) {
    add_box(pieces, "arm", {0.02, side * (s.y() - arm) / 2, 0.42 * s.z()}, {s.x() - 0.04, arm, 0.58 * s.z()});
  }
  const int cushions = std::max(1, static_cast<int>(std::lround((s.y() - 2 * arm) / 0.7)));
  const double wide = (s.y() - 2 * arm) / cushions;
  for (int i = 0; i < cushions; ++i) {
    const double y = -s.y() / 2 + arm + (i + 0.5) * wide;
    add_box(pieces, "cushion", {0.1, y, seat + 0.05}, {s.x() - 0.2, wide - 0.01, 0.1}, true);
  }
  add_legs(pieces, s, 0.08 * s.z(), 0.05, 0.05, true);
  return pieces;
}

Pieces bed(const Vector3d& s) {
  Pieces pieces;
  const double frame = 0.55 * s.z();
  add_box(pieces, "frame", {0, 0, 0.5 * frame + 0.08}, {s.x(), s.y(), frame - 0.16});
  add_box(pieces, "mattress", {0, 0, frame + 0.09}, {s.x() - 0.06, s.y() - 0.06, 0.18}, true);
  add_box(pieces, "head", {-s.x() / 2 - 0.02, 0, s.z() / 2 + 0.1}, {0.04, s.y(), s.z() + 0.2});
  add_box(pieces, "pillow", {-s.x() / 2 + 0.3, 0, frame + 0.22}, {0.4, 0.8 * s.y(), 0.1}, true);
  add_legs(pieces, s, 0.08, 0.06, 0.02, true);
  return pieces;
}

Pieces plant(const Vector3d& s) {
  Pieces pieces;
  const double pot = 0.28 * s.z();
  Mesh pot_mesh = make_cone(0.2 * s.x(), pot, 0.27 * s.x());
  pieces.push_back({"pot", std::move(pot_mesh), true, true, true});
  for (int i = 0; i < 22; ++i) {
    const auto seed = static_cast<std::uint32_t>(i);
    const double around = 2.399963 * i;
    const double share = (i + 0.5) / 22;
    const double length = s.z() * (0.22 + 0.12 * static_cast<double>(unit(mix(seed, 1U))));
    Mesh leaf = make_ellipsoid({0.004, 0.22 * length, length / 2}, 12, 10);
    Pose X = Pose::Identity();
    X.linear() << cosine(around), -sine(around), 0, sine(around), cosine(around), 0, 0, 0, 1;
    Pose bend = Pose::Identity();
    const double lean = degrees(12 + 60 * (1 - share));
    bend.linear() << cosine(lean), 0, sine(lean), 0, 1, 0, -sine(lean), 0, cosine(lean);
    Pose up = Pose::Identity();
    up.translation() = Vector3d(0, 0, length / 2 + 0.1 * s.z());
    Pose foot = Pose::Identity();
    foot.translation() = Vector3d(0, 0, pot + 0.3 * share * (s.z() - pot));
    leaf.transform(foot * X * bend * up);
    pieces.push_back({"leaf", std::move(leaf), false, true, true});
  }
  return pieces;
}

Pieces picture(const Vector3d& s) {
  Pieces pieces;
  add_box(pieces, "frame", {0, 0, s.z() / 2}, {std::max(0.02, s.x()), s.y(), s.z()});
  Mesh sheet = make_rectangle(s.y() - 0.06, s.z() - 0.06);
  Pose X = Pose::Identity();
  X.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // its x to the left, its y up, facing forward
  X.translation() = Vector3d(std::max(0.02, s.x()) / 2 + 0.001, 0, s.z() / 2);
  sheet.transform(X);
  pieces.push_back({"sheet", std::move(sheet), true, false, false});
  return pieces;
}

Mesh rectangle(const Vector3d& s) {
  Pose X = Pose::Identity();
  if (s.z() == 0.0) return make_rectangle(s.x(), s.y());
  X.translation().z() = s.z() / 2;
  if (s.x() == 0.0) {
    X.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  } else {
    X.linear() << -1, 0, 0, 0, 0, 1, 0, 1, 0;
  }
  Mesh mesh = make_rectangle(s.x() == 0.0 ? s.y() : s.x(), s.z());
  mesh.transform(X);
  return mesh;
}

// The squares of a flat board; those of one colour are one piece, each square a polygon of its own.
Pieces checkerboard(const ShapeSpec& spec) {
  const Vector3d s(spec.size_m[0], spec.size_m[1], spec.size_m[2]);
  const Mesh whole = rectangle(s);
  const Eigen::Vector3f origin = whole.position_m[0];
  const Eigen::Vector3f right = (whole.position_m[1] - origin) / static_cast<float>(spec.columns);
  const Eigen::Vector3f up = (whole.position_m[3] - origin) / static_cast<float>(spec.rows);
  Pieces pieces{{"squares", {}, false, true, false}, {"squares", {}, true, true, false}};
  for (int row = 0; row < spec.rows; ++row) {
    for (int column = 0; column < spec.columns; ++column) {
      const auto corner = [&](int c, int r) {
        return Eigen::Vector3f(origin + static_cast<float>(column + c) * right + static_cast<float>(row + r) * up);
      };
      const float w = right.norm();
      const float h = up.norm();
      pieces[static_cast<std::size_t>((row + column) % 2)].mesh.add_polygon(
          {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)}, {{0, 0}, {w, 0}, {w, h}, {0, h}});
    }
  }
  return pieces;
}

}  // namespace

std::vector<Piece> pieces_of(const ShapeSpec& spec) {
  const Vector3d s(spec.size_m[0], spec.size_m[1], spec.size_m[2]);
  const auto one = [](Mesh mesh, double lift_m = 0.0) {
    mesh.transform(pose_at({0, 0, lift_m}));
    return Pieces{{"", std::move(mesh), false, true, false}};
  };
  switch (spec.kind) {
    case ShapeKind::kBox:
      return one(make_box(s), s.z() / 2);
    case ShapeKind::kRectangle:
      return one(rectangle(s));
    case ShapeKind::kDisc:
      return one(make_disc(s.x() / 2));
    case ShapeKind::kCylinder:
      return one(make_cylinder(s.x() / 2, s.z()));
    case ShapeKind::kCone:
      return one(make_cone(s.x() / 2, s.z()));
    case ShapeKind::kSphere:
      return one(make_ellipsoid(s / 2, 128, 64), s.z() / 2);
    case ShapeKind::kCheckerboard:
      return checkerboard(spec);
    case ShapeKind::kTable:
      return table(s);
    case ShapeKind::kChair:
      return chair(s);
    case ShapeKind::kShelf:
      return shelf(s);
    case ShapeKind::kCabinet:
      return cabinet(s);
    case ShapeKind::kSofa:
      return sofa(s);
    case ShapeKind::kBed:
      return bed(s);
    case ShapeKind::kPlant:
      return plant(s);
    case ShapeKind::kPicture:
      return picture(s);
    case ShapeKind::kMesh:
      return {};
  }
  return {};
}

}  // namespace cgsr::sim
