#include "tests/mapping/furnished_room.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <stdexcept>

#include <fmt/format.h>
#include <unistd.h>

#include "pipeline/render/depth_raster.h"
#include "pipeline/world/load.h"

namespace cgsr::mapping::testing {
namespace {

using Eigen::Vector3d;

class Writer {
 public:
  void object(const std::string& name) { text_ += fmt::format("o {}\n", name); }

  void face(const std::array<Vector3d, 4>& corners) {
    for (const Vector3d& p : corners) text_ += fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x(), p.y(), p.z());
    text_ += fmt::format("f {} {} {} {}\n", count_ + 1, count_ + 2, count_ + 3, count_ + 4);
    count_ += 4;
  }

  void box(const std::string& name, const Vector3d& low, const Vector3d& size) {
    object(name);
    const auto at = [&](int x, int y, int z) { return Vector3d(low + Vector3d(x, y, z).cwiseProduct(size)); };
    face({at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)});
    face({at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)});
    face({at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)});
    face({at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1)});
    face({at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1)});
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_ = "# a room\nusemtl none\n";
  int count_ = 0;
};

void add_room(Writer& writer) {
  const auto at = [&](double x, double y, double z) { return Vector3d(5.0 * x, 4.0 * y, 2.5 * z); };
  writer.object("room");
  writer.face({at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0)});
  writer.face({at(0, 0, 0), at(0, 0, 1), at(1, 0, 1), at(1, 0, 0)});
  writer.face({at(1, 0, 0), at(1, 0, 1), at(1, 1, 1), at(1, 1, 0)});
  writer.face({at(1, 1, 0), at(1, 1, 1), at(0, 1, 1), at(0, 1, 0)});
  writer.face({at(0, 1, 0), at(0, 1, 1), at(0, 0, 1), at(0, 0, 0)});
}

std::string room(double sigma_m, std::uint32_t seed, bool with_chair) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  const auto off = [&](bool x, bool y, bool z) {
    const Vector3d drawn(normal(random), normal(random), normal(random));
    return Vector3d(sigma_m * drawn.cwiseProduct(Vector3d(x ? 1 : 0, y ? 1 : 0, z ? 1 : 0)));
  };
  Writer writer;
  add_room(writer);
  writer.box("chest", Vector3d(0.3, 0.3, 0) + off(true, true, false), {0.8, 0.5, 0.9});
  writer.box("box/large", Vector3d(4.2, 0.4, 0) + off(true, true, false), {0.5, 0.9, 0.6});
  writer.box("shelf", Vector3d(0.2, 3.0, 0) + off(true, true, false), {0.4, 0.8, 1.3});
  writer.box("bench", Vector3d(3.6, 3.4, 0) + off(true, true, false), {1.1, 0.4, 0.5});
  const Vector3d p = Vector3d(4.998, 1.8, 1.0) + off(false, true, true);
  writer.object("sheet");
  writer.face({p, p + Vector3d(0, 0, 0.7), p + Vector3d(0, 0.6, 0.7), p + Vector3d(0, 0.6, 0)});
  const Vector3d q = Vector3d(2.0, 3.998, 1.1) + off(true, false, true);
  writer.object("sheet_2");
  writer.face({q, q + Vector3d(0, 0, 0.6), q + Vector3d(0.8, 0, 0.6), q + Vector3d(0.8, 0, 0)});
  if (with_chair) writer.box("chair", {2.2, 1.8, 0}, {0.4, 0.4, 0.45});
  return writer.text();
}

world::Map loaded(const std::string& text) {
  const auto file = std::filesystem::temp_directory_path() / fmt::format("cgsr-mapping-test-{}.obj", getpid());
  std::ofstream(file) << text;
  auto map = world::load_map(file);
  std::filesystem::remove(file);
  if (!map) throw std::runtime_error(map.error().message);
  return *map;
}

geometry::Pose camera_on_ring(int i, int count) {
  const double turn = 2.0 * std::numbers::pi * i / count;
  const double heading = turn + (i % 2 == 0 ? 0.3 : 3.3);
  geometry::Pose X_RC = geometry::Pose::Identity();
  X_RC.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  X_RC.linear() = X_RC.linear() * geometry::rotation_of({-0.15, 0.0, 0.0});
  X_RC.translation().z() = 1.0;
  return geometry::pose_on_floor(2.5 + 1.2 * std::cos(turn), 2.0 + 0.9 * std::sin(turn), heading) * X_RC;
}

}  // namespace

std::string room_as_obj() {
  return room(0.0, 0, false);
}
std::string moved_room_as_obj(double sigma_m, std::uint32_t seed) {
  return room(sigma_m, seed, false);
}
std::string chair_as_obj() {
  return room(0.0, 0, true);
}

ElasticMap elastic(const ObjMap& file, const std::string& text, const RefineParameters& parameters) {
  auto made = ElasticMap::make(file, loaded(text), parameters);
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

geometry::Camera small_camera() {
  return {.width_px = 320, .height_px = 240, .fx_px = 250.0, .fy_px = 250.0, .cx_px = 159.5, .cy_px = 119.5};
}

std::vector<View> views_of(const std::string& text, double noise_px, double pose_error, int count, std::uint32_t seed,
                           std::vector<geometry::Pose>* true_poses) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  const world::Map map = loaded(text);
  render::DepthRaster raster(map, {});
  std::vector<render::VisiblePiece> pieces;
  std::vector<View> views;
  geometry::Pose before = geometry::Pose::Identity();
  for (int i = 0; i < count; ++i) {
    const geometry::Pose X_WC = camera_on_ring(i, count);
    View view;
    view.number = i;
    geometry::Vector6d off;
    for (double& value : off) value = pose_error * normal(random);
    off = off.cwiseProduct((geometry::Vector6d() << 0.05, 0.05, 0.01, 0.005, 0.005, 0.0175).finished());
    view.given = localization::prior_at(
        geometry::moved(X_WC, off), {.x_m = 0.05, .y_m = 0.05, .z_m = 0.01, .heading_rad = 0.0175, .tilt_rad = 0.005});
    view.X_WC = view.given.X_WC;
    if (i > 0) view.X_CB = before.inverse() * X_WC;
    before = X_WC;
    raster.look(X_WC, small_camera(), pieces);
    view.edges = localization::SegmentTable(1000);
    for (const render::VisiblePiece& piece : pieces) {
      const Eigen::Vector2f d = piece.p1 - piece.p0;
      localization::PerceivedEdge edge;
      edge.direction = d.normalized();
      edge.half_length = 0.5F * d.norm();
      edge.middle = 0.5F * (piece.p0 + piece.p1) + static_cast<float>(noise_px * normal(random)) * edge.normal();
      edge.contrast = 60.0F;
      view.edges.add(edge);
    }
    view.edges.finish();
    views.push_back(std::move(view));
    if (true_poses != nullptr) true_poses->push_back(X_WC);
  }
  return views;
}

}  // namespace cgsr::mapping::testing
