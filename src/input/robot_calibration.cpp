#include "src/input/robot_calibration.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/core.h>
#include <toml++/toml.h>

#include "src/input/small_file.h"

namespace cgsr::app {
namespace {

constexpr std::size_t kMostBytes = 256 * 1024;
constexpr double kFarthest_m = 10.0;

template <std::size_t kCount>
Result<std::array<double, kCount>> numbers(const toml::table& mount, const std::string& file, const char* key,
                                           const char* section = "mount") {
  const toml::node* node = mount.get(key);
  const auto line = node != nullptr ? node->source().begin.line : mount.source().begin.line;
  const auto wrong = [&](const char* what) {
    return fail(fmt::format("{}:{}: {}.{} {}; expected {} numbers", file, line, section, key, what, kCount));
  };
  if (node == nullptr) return wrong("is missing");
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != kCount) return wrong("is no list of the right length");
  std::array<double, kCount> values{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto value = (*array)[i].value<double>();
    if (!value || !std::isfinite(*value)) return wrong("holds what is no finite number");
    values[i] = *value;
  }
  return values;
}

Result<toml::table> read_table(const std::filesystem::path& file) {
  const auto text = read_small_file(file, kMostBytes, "a robot's calibration");
  if (!text) return tl::unexpected(text.error());
  try {
    return toml::parse(*text, file.string());
  } catch (const toml::parse_error& error) {
    return fail(fmt::format("{}:{}: {}", file.string(), error.source().begin.line, error.description()));
  }
}

Result<double> length(const toml::table& table, const std::string& file, const char* section, const char* key) {
  const auto value = table[key].value<double>();
  if (!value || !(*value > 0.0) || *value > kFarthest_m) {
    const toml::node* node = table.get(key);
    const auto line = node != nullptr ? node->source().begin.line : table.source().begin.line;
    return fail(fmt::format("{}:{}: {}.{} is missing or no length; expected metres, more than 0 and at most {}", file,
                            line, section, key, kFarthest_m));
  }
  return *value;
}

}  // namespace

Result<geometry::Pose> read_mount(const std::filesystem::path& file) {
  const auto root = read_table(file);
  if (!root) return tl::unexpected(root.error());
  const toml::table* mount = (*root)["mount"].as_table();
  if (mount == nullptr) return fail(fmt::format("{}: has no section [mount], where the camera is", file.string()));
  const auto place = numbers<3>(*mount, file.string(), "position_m");
  if (!place) return tl::unexpected(place.error());
  const auto turn = numbers<4>(*mount, file.string(), "quaternion_wxyz");
  if (!turn) return tl::unexpected(turn.error());

  const Eigen::Vector3d position((*place)[0], (*place)[1], (*place)[2]);
  if (position.cwiseAbs().maxCoeff() > kFarthest_m) {
    return fail(fmt::format("{}: mount.position_m is {:.3g} m off; expected a camera on the robot, within {} m",
                            file.string(), position.norm(), kFarthest_m));
  }
  const Eigen::Quaterniond q((*turn)[0], (*turn)[1], (*turn)[2], (*turn)[3]);
  if (std::abs(q.norm() - 1.0) > 1e-3) {
    return fail(fmt::format("{}: mount.quaternion_wxyz has the length {:.6g}; expected 1", file.string(), q.norm()));
  }
  geometry::Pose X_RC = geometry::Pose::Identity();
  X_RC.linear() = q.normalized().toRotationMatrix();
  X_RC.translation() = position;
  return X_RC;
}

Result<std::optional<CalibratedBoard>> read_board(const std::filesystem::path& file) {
  const auto root = read_table(file);
  if (!root) return tl::unexpected(root.error());
  const toml::table* section = (*root)["board"].as_table();
  if (section == nullptr) return std::optional<CalibratedBoard>();
  const std::string name = file.string();
  CalibratedBoard board;
  const auto place = numbers<3>(*section, name, "position_m", "board");
  if (!place) return tl::unexpected(place.error());
  board.position_m = *place;
  if (section->contains("turn_deg")) {
    const auto turn = numbers<3>(*section, name, "turn_deg", "board");
    if (!turn) return tl::unexpected(turn.error());
    board.turn_deg = *turn;
  }
  const auto width = length(*section, name, "board", "width_m");
  if (!width) return tl::unexpected(width.error());
  const auto depth = length(*section, name, "board", "depth_m");
  if (!depth) return tl::unexpected(depth.error());
  board.width_m = *width;
  board.depth_m = *depth;
  const toml::array* probes = (*section)["probe"].as_array();
  if (probes == nullptr || probes->empty() || probes->size() > 2) {
    return fail(fmt::format("{}:{}: board.probe: expected one or two sections [[board.probe]]", name,
                            section->source().begin.line));
  }
  for (const toml::node& node : *probes) {
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      return fail(fmt::format("{}:{}: board.probe holds what is no section", name, node.source().begin.line));
    }
    const auto apex = numbers<3>(*table, name, "apex_m", "board.probe");
    if (!apex) return tl::unexpected(apex.error());
    const auto foot = numbers<3>(*table, name, "foot_m", "board.probe");
    if (!foot) return tl::unexpected(foot.error());
    const auto radius = length(*table, name, "board.probe", "base_radius_m");
    if (!radius) return tl::unexpected(radius.error());
    board.probe.push_back({*apex, *foot, *radius});
  }
  return std::optional<CalibratedBoard>(std::move(board));
}

}  // namespace cgsr::app
