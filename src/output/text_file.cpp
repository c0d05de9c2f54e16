#include "src/output/text_file.h"

#include <cerrno>
#include <cstring>

#include <fmt/core.h>

#include "platform/replace_file.h"

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
  return replace_file(path, {text});
}

}  // namespace cgsr::app
