#include "pipeline/world/load.h"

#include <algorithm>
#include <cctype>
#include <string>

#include <fmt/format.h>

#include "pipeline/world/cao.h"
#include "pipeline/world/clean.h"
#include "pipeline/world/compact.h"
#include "pipeline/world/mesh_file.h"

namespace cgsr::world {
namespace {

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

Result<Soup> read_soup(const std::filesystem::path& path, const std::string& ending, const LoadOptions& options) {
  if (ending != ".cao") return read_mesh_file(path, options);
  auto soup = read_cao(path);
  if (!soup) return soup;
  for (Eigen::Vector3f& p : soup->points) {
    p *= static_cast<float>(options.scale);
    if (options.up == UpAxis::kY) p = Eigen::Vector3f(p.x(), -p.z(), p.y());
  }
  return soup;
}

}  // namespace

std::string_view to_string(UpAxis axis) {
  switch (axis) {
    case UpAxis::kByFormat:
      return "format";
    case UpAxis::kZ:
      return "z";
    case UpAxis::kY:
      return "y";
  }
  return "";
}

Result<Map> load_map(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string ending = ending_of(path);
  if (ending == kCompactExtension) return read_compact(path);
  if (ending != ".obj" && ending != ".gltf" && ending != ".glb" && ending != ".cao")
    return fail(
        fmt::format("{}: '{}' is no kind of map that is read: .obj, .gltf, .glb, .cao or {}; a ROS floor map (.yaml) "
                    "goes through cgsr map import with --wall-height",
                    path.string(), ending, kCompactExtension));
  auto soup = read_soup(path, ending, options);
  if (!soup) return tl::unexpected(soup.error());
  auto map = clean(*soup, options.weld_m, options.lies_on_m);
  if (!map) return fail(fmt::format("{}: {}", path.string(), map.error().message));
  return map;
}

}  // namespace cgsr::world
