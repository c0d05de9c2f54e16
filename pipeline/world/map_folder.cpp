#include "pipeline/world/map_folder.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

namespace cgsr::world {
namespace {

namespace fs = std::filesystem;

fs::path without_links(const fs::path& path) {
  std::error_code error;
  fs::path absolute = fs::absolute(path, error);
  fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

bool is_below(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

MapFolder::MapFolder(const fs::path& map)
    : map_(map), folder_(without_links(map.has_parent_path() ? map.parent_path() : fs::path("."))) {}

Result<fs::path> MapFolder::find(const fs::path& part) const {
  fs::path found = without_links(part);
  if (!is_below(found, folder_)) {
    return fail(fmt::format("'{}' lies outside of the map's folder: expected it in {} or below", part.string(),
                            folder_.string()));
  }
  std::error_code error;
  const fs::file_status status = fs::status(found, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return fail(fmt::format("'{}' is no file that can be read", part.string()));
  }
  return found;
}

}  // namespace cgsr::world
