#include "pipeline/world/file_text.h"

#include <cstddef>
#include <fstream>
#include <ios>
#include <system_error>

#include <fmt/format.h>

namespace cgsr::world {

Result<std::string> read_text(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) return fail(fmt::format("{}: {}", path.string(), error.message()));
  if (bytes > kLargestBytes)
    return fail(fmt::format("{}: {} bytes are more than {} MB", path.string(), bytes, kLargestBytes >> 20U));
  std::ifstream file(path, std::ios::binary);
  std::string text(bytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(bytes));
  if (!file || static_cast<std::uintmax_t>(file.gcount()) != bytes)
    return fail(fmt::format("{}: cannot be read", path.string()));
  return text;
}

}  // namespace cgsr::world
