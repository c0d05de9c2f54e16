#include "platform/config/document.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "platform/config/tree.h"

namespace cgsr::config {

namespace {

/// toml++ quotes the bytes that it stumbled over as they are: control characters and broken UTF-8 too.
std::string printable(std::string_view description) {
  std::string text;
  for (const char c : description) {
    const bool plain = c >= ' ' && c <= '~';
    text += plain ? std::string(1, c) : fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
  }
  return text;
}

}  // namespace

std::string one_line(const toml::node& value) {
  std::ostringstream out;
  out << toml::toml_formatter(value, toml::format_flags::none);
  return out.str();
}

Result<Document> Document::load(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code trouble;
  if (std::filesystem::is_directory(file, trouble)) return fail(name + ": is a folder; a TOML file is wanted");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return fail(fmt::format("{}: cannot be opened: {}", name, std::strerror(errno)));

  // One byte more than allowed is read, so that a device without end is refused like a large file.
  std::string toml(kLargestBytes + 1, '\0');
  stream.read(toml.data(), static_cast<std::streamsize>(toml.size()));
  if (stream.bad()) return fail(name + ": cannot be read to its end");
  toml.resize(static_cast<std::size_t>(stream.gcount()));
  return parse(toml, name);
}

Result<Document> Document::parse(std::string_view toml, std::string name) {
  if (toml.size() > kLargestBytes) {
    return fail(fmt::format("{}: is larger than {} bytes; no configuration is", name, kLargestBytes));
  }
  if (std::count(toml.begin(), toml.end(), '.') > kMostDots) {
    return fail(fmt::format("{}: holds more than {} dots; keys are nested too deeply", name, kMostDots));
  }
  try {
    auto tree = std::make_shared<Tree>(Tree{toml::parse(toml, std::string_view(name))});
    return Document(std::move(name), std::move(tree));
  } catch (const toml::parse_error& error) {
    return fail(fmt::format("{}:{}: is not TOML: {}", name, error.source().begin.line, printable(error.description())));
  } catch (const std::exception& error) {
    return fail(fmt::format("{}: cannot be parsed: {}", name, error.what()));
  }
}

std::filesystem::path path_beside(const std::filesystem::path& config_file, std::string_view path) {
  if (path.empty()) return {};
  return (config_file.parent_path() / path).lexically_normal();
}

}  // namespace cgsr::config
