#include "pipeline/world/map_io.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "pipeline/world/file_text.h"

namespace cgsr::world {

bool MapIo::may_open(const char* file) const {
  if (folder_.map() == std::filesystem::path(file)) return true;
  const auto found = folder_.find(file);
  std::string problem = found ? "" : found.error().message;
  if (found) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(*found, error);
    if (!error && bytes > kLargestBytes)
      problem = fmt::format("'{}': {} bytes are more than {} MB", file, bytes, kLargestBytes >> 20U);
  }
  if (refused_.empty()) refused_ = problem;
  return problem.empty();
}

bool MapIo::Exists(const char* file) const {
  return may_open(file) && DefaultIOSystem::Exists(file);
}

Assimp::IOStream* MapIo::Open(const char* file, const char* mode) {
  return mode[0] == 'r' && may_open(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
}

}  // namespace cgsr::world
