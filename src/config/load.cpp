#include "src/config/load.h"

#include <utility>

#include "platform/config/reader.h"

namespace cgsr::config {
namespace {

enum class Scope { kRobot, kSections };

Result<Robot> load(const std::filesystem::path& file, Scope scope) {
  auto layers = Layers::load(file);
  if (!layers) return tl::unexpected(layers.error());
  Reader reader(std::move(*layers));
  Robot robot;
  auto outcome = scope == Scope::kRobot ? reader.read(robot) : reader.read_sections(robot);
  if (!outcome) return tl::unexpected(outcome.error());
  robot.provenance = reader.provenance();
  return robot;
}

}  // namespace

Result<Robot> load_robot(const std::filesystem::path& file) {
  return load(file, Scope::kRobot);
}

Result<Robot> load_sections(const std::filesystem::path& file) {
  return load(file, Scope::kSections);
}

Result<Color> load_color(const std::filesystem::path& file) {
  if (file.empty()) return Color{};
  const auto robot = load_sections(file);
  if (!robot) return tl::unexpected(robot.error());
  return robot->color;
}

Result<Localization> load_localization(const std::filesystem::path& file) {
  if (file.empty()) return six_free_numbers();
  const auto robot = load_sections(file);
  if (!robot) return tl::unexpected(robot.error());
  return Localization{robot->localization.prior, robot->localization.localizer, robot->localization.tracker};
}

Result<Light> load_light(const std::filesystem::path& file) {
  const auto robot = load_sections(file);
  if (!robot) return tl::unexpected(robot.error());
  return Light{robot->mount, robot->probes, robot->lamp, robot->localization.mount};
}

}  // namespace cgsr::config
