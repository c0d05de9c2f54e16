#include "src/input/small_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

namespace cgsr::app {

Result<std::string> read_small_file(const std::filesystem::path& file, std::size_t most_bytes, std::string_view what) {
  std::error_code none;
  if (std::filesystem::is_directory(file, none)) {
    return fail(fmt::format("{}: is a folder: expected {}", file.string(), what));
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return fail(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
  std::string text(most_bytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) return fail(fmt::format("{}: cannot be read to its end", file.string()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > most_bytes) {
    return fail(fmt::format("{}: is larger than {} bytes: expected {}", file.string(), most_bytes, what));
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

}  // namespace cgsr::app
