#include "src/input/robot_calibration.h"

#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/core.h>
#include <toml++/toml.h>

#include "src/input/small_file.h"

namespace cgsr::app {
namespace {

constexpr std::size_t kMostBytes = 256 * 1024;
constexpr double kFarthest_m = 10.0;

template <std::size_t kCount>
Result<std::array<double, kCount>> numbers(const toml::table& mount, const std::string& file, const char* key) {
  const toml::node* node = mount.get(key);
  const auto line = node != nullptr ? node->source().begin.line : mount.source().begin.line;
  const auto wrong = [&](const char* what) {
    return fail(fmt::format("{}:{}: mount.{} {}; expected {} numbers", file, line, key, what, kCount));
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

}  // namespace

Result<geometry::Pose> read_mount(const std::filesystem::path& file) {
  const auto text = read_small_file(file, kMostBytes, "a robot's calibration");
  if (!text) return tl::unexpected(text.error());
  toml::table root;
  try {
    root = toml::parse(*text, file.string());
  } catch (const toml::parse_error& error) {
    return fail(fmt::format("{}:{}: {}", file.string(), error.source().begin.line, error.description()));
  }
  const toml::table* mount = root["mount"].as_table();
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

}  // namespace cgsr::app
