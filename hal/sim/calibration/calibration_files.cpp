#include "hal/sim/calibration/calibration_files.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <toml++/toml.h>
#include <Eigen/Geometry>

#include "hal/sim/calibration/map_file.h"

namespace cgsr::sim {
namespace {

std::string matrix_as_yaml(std::string_view name, int rows, int columns, const std::string& data) {
  return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{}]\n", name, rows, columns, data);
}

toml::array triple(const Eigen::Vector3d& v) {
  return toml::array{v.x(), v.y(), v.z()};
}

/// Visits a parameter struct and notes its numbers.
struct NumbersInto {
  toml::table& table;
  void number(std::string_view name, const double& value, Range<double> /*range*/, std::string_view /*unit*/,
              std::string_view /*meaning*/) const {
    table.insert(name, value);
  }
};

toml::table board_table(const MeasuredBoard& board) {
  toml::array probes;
  for (const MeasuredProbe& probe : board.probes) {
    probes.push_back(toml::table{
        {"apex_m", triple(probe.p_RA)}, {"foot_m", triple(probe.p_RF)}, {"base_radius_m", probe.base_radius_m}});
  }
  return toml::table{{"position_m", triple(board.p_RB)},
                     {"width_m", board.width_m},
                     {"depth_m", board.depth_m},
                     {"probe", std::move(probes)}};
}

Result<void> write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) return fail(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
  return {};
}

}  // namespace

std::string camera_as_yaml(const CameraModel& c, const std::string& name) {
  const std::string K = fmt::format("{}, 0.0, {}, 0.0, {}, {}, 0.0, 0.0, 1.0", c.fx_px, c.cx_px, c.fy_px, c.cy_px);
  const std::string P =
      fmt::format("{}, 0.0, {}, 0.0, 0.0, {}, {}, 0.0, 0.0, 0.0, 1.0, 0.0", c.fx_px, c.cx_px, c.fy_px, c.cy_px);
  return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", c.width_px, c.height_px, name) +
         matrix_as_yaml("camera_matrix", 3, 3, K) + "distortion_model: plumb_bob\n" +
         matrix_as_yaml("distortion_coefficients", 1, 5,
                        fmt::format("{}, {}, {}, {}, {}", c.k1, c.k2, c.p1, c.p2, c.k3)) +
         matrix_as_yaml("rectification_matrix", 3, 3, "1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0") +
         matrix_as_yaml("projection_matrix", 3, 4, P);
}

std::string robot_as_toml(const CalibratedCopy& copy, const CalibrationErrors& errors) {
  const Eigen::Quaterniond q(copy.X_RC.linear());
  toml::table sigma;
  NumbersInto into{sigma};
  CalibrationErrors::describe(errors, into);
  toml::table robot{{"name", copy.robot},
                    {"mount", toml::table{{"position_m", triple(copy.X_RC.translation())},
                                          {"quaternion_wxyz", toml::array{q.w(), q.x(), q.y(), q.z()}}}},
                    {"sigma", sigma}};
  if (copy.has_board) robot.insert("board", board_table(copy.board));
  std::ostringstream text;
  text << "# The robot's frame: x forward, y left, z up, metres. The mount is the pose of the camera (x right, y down, "
          "z forward) in it.\n"
       << toml::toml_formatter(robot) << '\n';
  return text.str();
}

Result<void> write_calibration(const CalibratedCopy& copy, const CalibrationErrors& errors, std::uint32_t seed,
                               const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(fmt::format("{}: {}", folder.string(), error.message()));
  std::string camera_name;
  for (const char c : copy.robot) camera_name += c == ' ' ? '_' : c;
  if (auto written = write(folder / "camera.yaml", camera_as_yaml(copy.camera, camera_name)); !written) return written;
  if (auto written = write(folder / "robot.toml", robot_as_toml(copy, errors)); !written) return written;
  return write_map(copy.map, folder / "map.obj",
                   fmt::format("The world '{}' as it was measured, with errors of seed {}", copy.map.name, seed));
}

}  // namespace cgsr::sim
