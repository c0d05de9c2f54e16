#include "pipeline/world/glb_check.h"

#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

namespace cgsr::world {
namespace {

constexpr std::size_t kHeader = 12;
constexpr std::size_t kChunkHeader = 8;

/// Little-endian, as glTF is.
std::uint64_t number_at(std::string_view file, std::size_t at) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < 4; ++i)
    number |= static_cast<std::uint64_t>(static_cast<unsigned char>(file[at + i])) << (8U * i);
  return number;
}

}  // namespace

std::string glb_problem(std::string_view file) {
  if (file.size() < kHeader || !file.starts_with("glTF")) return {};
  const std::uint64_t claimed = number_at(file, 8);
  if (claimed > file.size()) return fmt::format("its header claims {} bytes, the file has {}", claimed, file.size());
  for (std::size_t at = kHeader; at + kChunkHeader <= file.size();) {
    const std::uint64_t length = number_at(file, at);
    const std::size_t left = file.size() - at - kChunkHeader;
    if (length > left) return fmt::format("a chunk claims {} bytes, {} are left in the file", length, left);
    at += kChunkHeader + static_cast<std::size_t>(length);
  }
  return {};
}

}  // namespace cgsr::world
