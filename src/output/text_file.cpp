#include "src/output/text_file.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/core.h>

namespace cgsr::app {
namespace {

std::string cause() {
  return errno != 0 ? std::strerror(errno) : "unknown cause";
}

}  // namespace

Result<TextFile> TextFile::create(const std::filesystem::path& path) {
  errno = 0;
  std::ofstream stream(path, std::ios::trunc);
  if (!stream) return fail(fmt::format("{}: cannot be written: {}", path.string(), cause()));
  return TextFile(path, std::move(stream));
}

Result<void> TextFile::add_line(std::string_view line) {
  errno = 0;
  stream_ << line << '\n' << std::flush;
  if (!stream_) return fail(fmt::format("{}: writing failed: {}", path_.string(), cause()));
  return {};
}

Result<void> write_file(const std::filesystem::path& path, std::string_view text) {
  auto beside = path;
  beside += ".part";
  errno = 0;
  {
    std::ofstream stream(beside, std::ios::trunc | std::ios::binary);
    stream << text << std::flush;
    if (!stream) {
      const std::string why = cause();
      std::error_code ignored;
      std::filesystem::remove(beside, ignored);
      return fail(fmt::format("{}: cannot be written: {}", path.string(), why));
    }
  }
  std::error_code error;
  std::filesystem::rename(beside, path, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    return fail(fmt::format("{}: cannot be put in place: {}", path.string(), error.message()));
  }
  return {};
}

}  // namespace cgsr::app
