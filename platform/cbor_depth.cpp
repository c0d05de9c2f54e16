#include "platform/cbor_depth.h"

#include <array>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

namespace cgsr {
namespace {

// Also a definite length of this value: the parser takes both for the same.
constexpr std::uint64_t kCborUntilBreak = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint8_t kCborBreak = 0xFF;

enum class CborMajor : std::uint8_t { kUnsigned, kNegative, kBytes, kText, kArray, kMap, kTag, kSimple };

/// The initial byte of an item and its argument.
struct CborHead {
  CborMajor major = CborMajor::kUnsigned;
  bool indefinite = false;
  std::uint64_t argument = 0;
};

/// Reads what stands at `at`, and moves it behind. \return nothing where it is cut short or reserved.
std::optional<CborHead> take_head(std::span<const std::uint8_t> bytes, std::size_t& at) {
  const std::uint8_t initial = bytes[at++];
  const unsigned info = initial & 0x1FU;
  CborHead head{static_cast<CborMajor>(initial >> 5U), info == 31, info};
  if (info < 24 || head.indefinite) return head;
  if (info > 27) return std::nullopt;
  const std::size_t size = std::size_t{1} << (info - 24);
  if (bytes.size() - at < size) return std::nullopt;
  head.argument = 0;
  for (std::size_t i = 0; i < size; ++i) head.argument = head.argument << 8U | bytes[at++];
  return head;
}

/// \return how many items the item holds; nothing: it holds none and is over with its head or its bytes.
std::optional<std::uint64_t> items_in(const CborHead& head) {
  switch (head.major) {
    case CborMajor::kBytes:
    case CborMajor::kText:
      return head.indefinite ? std::optional(kCborUntilBreak) : std::nullopt;
    case CborMajor::kArray:
      return head.indefinite ? kCborUntilBreak : head.argument;
    case CborMajor::kMap:
      if (head.indefinite || head.argument == kCborUntilBreak) return kCborUntilBreak;
      return head.argument > kCborUntilBreak / 2 ? kCborUntilBreak - 1 : 2 * head.argument;
    case CborMajor::kTag:
      return 1;
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<std::string> cbor_depth_problem(std::span<const std::uint8_t> bytes) {
  std::array<std::uint64_t, kMaxCborDepth> left{};  // of each level that is open, items that are to come
  std::size_t depth = 0;
  std::size_t at = 0;
  while (at < bytes.size()) {
    if (depth > 0 && bytes[at] == kCborBreak) {
      if (left[depth - 1] != kCborUntilBreak) return std::nullopt;
      ++at;
      --depth;
    } else {
      const std::size_t begin = at;
      const auto head = take_head(bytes, at);
      if (!head) return std::nullopt;
      if (depth > 0 && left[depth - 1] != kCborUntilBreak) --left[depth - 1];
      if (const auto items = items_in(*head)) {
        if (depth == left.size()) {
          return fmt::format("offset {}: an item that holds others is {} deep, expected at most {}", begin, depth + 1,
                             kMaxCborDepth);
        }
        left[depth++] = *items;
      } else if (head->major == CborMajor::kBytes || head->major == CborMajor::kText) {
        if (head->argument > bytes.size() - at) return std::nullopt;
        at += static_cast<std::size_t>(head->argument);
      }
    }
    while (depth > 0 && left[depth - 1] == 0) --depth;
    if (depth == 0) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace cgsr
