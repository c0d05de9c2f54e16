#include "tools/lab/tracking/run_cache.h"

#include <cstdlib>

#include <fmt/format.h>

#include "src/output/text_file.h"

namespace cgsr::lab {

namespace fs = std::filesystem;

fs::path run_cache_folder() {
  const char* xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg != nullptr && fs::path(xdg).is_absolute()) return fs::path(xdg) / "cgsr/tracking";
  const char* home = std::getenv("HOME");
  if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / ".cache/cgsr/tracking";
  return {};
}

std::optional<Boxes> RunCache::find(const std::string& key, std::size_t images) const {
  if (folder_.empty() || !fs::exists(path_of(key))) return std::nullopt;
  const auto boxes = read_truth(path_of(key));
  if (!boxes || boxes->size() != images) return std::nullopt;
  return *boxes;
}

void RunCache::keep(const std::string& key, const Boxes& boxes) const {
  if (folder_.empty()) return;
  std::string text;
  for (const auto& box : boxes) {
    text += box ? fmt::format("{:.6f},{:.6f},{:.6f},{:.6f}\n", box->x, box->y, box->width, box->height)
                : "nan,nan,nan,nan\n";
  }
  std::error_code ignored;
  fs::create_directories(folder_, ignored);
  static_cast<void>(app::write_file(path_of(key), text));  // what cannot be kept is measured again
}

}  // namespace cgsr::lab
