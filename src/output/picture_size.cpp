#include "src/output/picture_size.h"

#include <array>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string_view>

namespace cgsr::app {
namespace {

/// The bytes of a file by their place. Past the end they are zero, and ok() is false.
class Bytes {
 public:
  explicit Bytes(const std::string& file) : stream_(file, std::ios::binary) {}

  std::uint32_t at(std::int64_t place) {
    stream_.seekg(place);
    const int byte = stream_.get();
    return stream_ ? static_cast<std::uint32_t>(byte) : 0U;
  }
  std::uint32_t big16(std::int64_t place) { return at(place) << 8U | at(place + 1); }
  std::uint32_t big32(std::int64_t place) { return big16(place) << 16U | big16(place + 2); }
  std::uint32_t little32(std::int64_t place) {
    return at(place) | at(place + 1) << 8U | at(place + 2) << 16U | at(place + 3) << 24U;
  }
  bool begins_with(std::string_view magic) {
    for (std::size_t i = 0; i < magic.size(); ++i) {
      if (at(static_cast<std::int64_t>(i)) != static_cast<unsigned char>(magic[i])) return false;
    }
    return ok();
  }
  [[nodiscard]] bool ok() const { return static_cast<bool>(stream_); }
  std::ifstream& stream() { return stream_; }

 private:
  std::ifstream stream_;
};

std::optional<cv::Size> size_of(bool ok, std::int64_t width, std::int64_t height) {
  constexpr std::int64_t kMax = std::numeric_limits<int>::max();
  if (!ok || width < 1 || height < 1 || width > kMax || height > kMax) return std::nullopt;
  return cv::Size(static_cast<int>(width), static_cast<int>(height));
}

/// Segment after segment up to the one that begins a frame (ISO/IEC 10918-1, B.1.1 and B.2.2).
std::optional<cv::Size> size_of_jpeg(Bytes& bytes) {
  std::int64_t at = 2;
  while (bytes.at(at) == 0xFF && bytes.ok()) {
    const std::uint32_t marker = bytes.at(at + 1);
    if (marker == 0xFF) {  // fill
      ++at;
      continue;
    }
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) {
      const std::uint32_t height = bytes.big16(at + 5);
      const std::uint32_t width = bytes.big16(at + 7);
      return size_of(bytes.ok(), width, height);
    }
    const std::uint32_t length = bytes.big16(at + 2);
    if (length < 2) break;
    at += 2 + static_cast<std::int64_t>(length);
  }
  return std::nullopt;
}

/// "P6", then numbers as text, with comments up to their line's end between them.
std::optional<cv::Size> size_of_pnm(Bytes& bytes) {
  std::ifstream& stream = bytes.stream();
  stream.seekg(2);
  std::array<std::int64_t, 2> numbers{};
  for (std::int64_t& number : numbers) {
    while (stream >> std::ws && stream.peek() == '#') stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    stream >> number;
  }
  return size_of(bytes.ok(), numbers[0], numbers[1]);
}

}  // namespace

std::optional<cv::Size> size_in_header(const std::string& file) {
  Bytes bytes(file);
  if (bytes.begins_with("\x89PNG\r\n\x1A\n")) {
    const std::uint32_t width = bytes.big32(16);
    const std::uint32_t height = bytes.big32(20);
    return size_of(bytes.ok(), width, height);
  }
  bytes = Bytes(file);
  if (bytes.begins_with("\xFF\xD8\xFF")) return size_of_jpeg(bytes);
  bytes = Bytes(file);
  if (bytes.begins_with("BM")) {
    const std::uint32_t width = bytes.little32(18);
    const auto height = static_cast<std::int32_t>(bytes.little32(22));  // negative: from the top down
    return size_of(bytes.ok(), width, std::abs(static_cast<std::int64_t>(height)));
  }
  bytes = Bytes(file);
  if (bytes.begins_with("P") && bytes.at(1) >= '1' && bytes.at(1) <= '6') return size_of_pnm(bytes);
  return std::nullopt;
}

}  // namespace cgsr::app
