#include "tools/lab/mapping/wrong_map.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "hal/sim/calibration/calibrated_copy.h"
#include "hal/sim/calibration/map_file.h"
#include "pipeline/world/load.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {
namespace {

constexpr double kMoved_m = 0.5;
constexpr std::array<std::string_view, 7> kChairs{"chair", "armchair",      "stool", "ottoman",
                                                  "bench", "trestle_table", "table"};

std::string thing_of(const std::string& name) {
  return name.substr(0, name.find('/'));
}

// The first chair, or what is most like one.
std::string chair_in(const mapping::ObjMap& file) {
  for (const std::string_view kind : kChairs) {
    for (const std::string& name : file.parts) {
      const std::string thing = thing_of(name);
      if (thing == kind || thing.starts_with(std::string(kind) + "_")) return thing;
    }
  }
  return {};
}

std::set<std::uint32_t> points_of(const mapping::ObjMap& file, const std::string& thing) {
  std::set<std::uint32_t> points;
  for (const auto& face : file.faces) {
    if (thing_of(file.parts[face.part]) == thing) points.insert(face.corners.begin(), face.corners.end());
  }
  return points;
}

/// The map that the robot's loader makes of a file's text.
Result<world::Map> load(const sim::Scene& scene, const std::string& text) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("cgsr-lab-{}-map", getpid());
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  auto written = sim::write_map(scene, folder / "map.obj", "a measured copy");
  std::ofstream(folder / "map.obj") << text;
  auto map = written ? world::load_map(folder / "map.obj") : tl::unexpected(written.error());
  std::filesystem::remove_all(folder, ignored);
  return map;
}

// Corners at one place move together.
std::vector<Eigen::Vector3d> jolted(const mapping::ObjMap& file, double sigma_m, Random& random) {
  std::vector<Eigen::Vector3d> points = file.points;
  std::map<std::array<double, 3>, Eigen::Vector3d> by;
  for (Eigen::Vector3d& p : points) {
    const auto [known, is_new] = by.try_emplace({p.x(), p.y(), p.z()}, Eigen::Vector3d::Zero());
    if (is_new) known->second = sigma_m * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    p += known->second;
  }
  return points;
}

}  // namespace

double Line::distance_to(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d d = b - a;
  const double s = std::clamp((p - a).dot(d) / std::max(1e-12, d.squaredNorm()), 0.0, 1.0);
  return (a + s * d - p).norm();
}

Result<WrongMap> wrong_map(const Place& place, MapError error, double sigma_m, bool move_chair, std::uint32_t seed,
                           const mapping::RefineParameters& parameters) {
  const sim::Scene truth = sim::calibrated_copy(place.scene(), 0, sim::CalibrationErrors::none(), seed).map;
  auto file = mapping::parse_obj(sim::map_as_obj(truth, "map.mtl", "as it is"), "the true map");
  if (!file) return tl::unexpected(file.error());
  std::vector<Eigen::Vector3d> points = file->points;
  Random random = Random(seed).fork(0x3a9);
  if (error == MapError::kCorners) points = jolted(*file, sigma_m, random);
  if (error == MapError::kParts) {
    sim::CalibrationErrors errors = sim::CalibrationErrors::none();
    errors.map_part_m = sigma_m;
    const sim::Scene measured = sim::calibrated_copy(place.scene(), 0, errors, seed).map;
    const auto moved = mapping::parse_obj(sim::map_as_obj(measured, "map.mtl", "as measured"), "the measured map");
    if (!moved) return tl::unexpected(moved.error());
    if (moved->points.size() != points.size()) return fail("the measured map has other corners than the true one");
    points = moved->points;
  }
  const std::string chair = move_chair ? chair_in(*file) : std::string();
  const double heading = random.uniform(0.0, 2.0 * std::numbers::pi);
  const std::set<std::uint32_t> chair_points = points_of(*file, chair);
  for (const std::uint32_t i : chair_points) {
    points[i] += kMoved_m * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0);
  }
  const std::string text = mapping::obj_text(*file, points, {});
  auto wrong = mapping::parse_obj(text, "the wrong map");
  if (!wrong) return tl::unexpected(wrong.error());
  auto map = load(truth, text);
  if (!map) return tl::unexpected(map.error());
  auto elastic = mapping::ElasticMap::make(*wrong, std::move(*map), parameters);
  if (!elastic) return tl::unexpected(elastic.error());
  WrongMap made{std::move(*wrong), std::move(*elastic), {}, chair, {}, {}};
  made.true_corners.resize(made.elastic.measured().size());
  made.moved_corner.resize(made.true_corners.size(), false);
  for (std::size_t i = 0; i < file->points.size(); ++i) {
    const std::uint32_t corner = made.elastic.corner_of_point(static_cast<std::uint32_t>(i));
    made.true_corners[corner] = file->points[i];
    if (chair_points.contains(static_cast<std::uint32_t>(i))) made.moved_corner[corner] = true;
  }
  for (const auto& face : file->faces) {
    if (chair.empty() || thing_of(file->parts[face.part]) != chair) continue;
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      made.moved_edges.push_back(
          {file->points[face.corners[i]], file->points[face.corners[(i + 1) % face.corners.size()]]});
    }
  }
  return made;
}

std::vector<Line> outlines_of(const sim::Scene& scene) {
  std::vector<Line> lines;
  for (const sim::Part& part : scene.parts) {
    if (part.figure >= 0) continue;
    for (const auto& outline : part.mesh.polygons) {
      for (std::size_t i = 0; i < outline.size(); ++i) {
        lines.push_back({part.mesh.position_m[outline[i]].cast<double>(),
                         part.mesh.position_m[outline[(i + 1) % outline.size()]].cast<double>()});
      }
    }
  }
  return lines;
}

}  // namespace cgsr::lab
