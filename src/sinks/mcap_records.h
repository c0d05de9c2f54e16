#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace cgsr::sinks {

using Bytes = std::span<const std::uint8_t>;

/// \return the bytes of a text.
Bytes bytes_of(std::string_view text);

/// The first byte of a record of MCAP (mcap.dev/spec).
enum class McapOpcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// First and last bytes of a file.
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

/// Records of MCAP in memory: an opcode, the length of the content in 8 bytes, the content; integers little endian, strings and maps with
/// their length in bytes in front (4 bytes).
class McapRecords {
 public:
  void clear() { bytes_.clear(); }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] Bytes bytes() const { return bytes_; }

  /// Opens a record; its length is filled in by end(). Records do not nest.
  void begin(McapOpcode opcode);
  void end();

  void u8(std::uint8_t value) { number(value, 1); }
  void u16(std::uint16_t value) { number(value, 2); }
  void u32(std::uint32_t value) { number(value, 4); }
  void u64(std::uint64_t value) { number(value, 8); }
  void string(std::string_view text);
  void raw(Bytes bytes);

  /// Opens an array or map, whose length in bytes is filled in by end_array().
  void begin_array();
  void end_array();

 private:
  void number(std::uint64_t value, int bytes);
  void put(std::size_t at, std::uint64_t value, int bytes);

  std::vector<std::uint8_t> bytes_;
  std::size_t record_ = 0;  // where the open record's length lies
  std::size_t array_ = 0;   // where the open array's length lies
};

}  // namespace cgsr::sinks
