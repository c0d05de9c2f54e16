#include "src/sinks/mcap_records.h"

namespace cgsr::sinks {

Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

void McapRecords::begin(McapOpcode opcode) {
  u8(static_cast<std::uint8_t>(opcode));
  record_ = bytes_.size();
  u64(0);
}

void McapRecords::end() {
  put(record_, bytes_.size() - record_ - 8, 8);
}

void McapRecords::string(std::string_view text) {
  u32(static_cast<std::uint32_t>(text.size()));
  raw(bytes_of(text));
}

void McapRecords::raw(Bytes bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

void McapRecords::begin_array() {
  array_ = bytes_.size();
  u32(0);
}

void McapRecords::end_array() {
  put(array_, bytes_.size() - array_ - 4, 4);
}

void McapRecords::number(std::uint64_t value, int bytes) {
  const std::size_t at = bytes_.size();
  bytes_.resize(at + static_cast<std::size_t>(bytes));
  put(at, value, bytes);
}

void McapRecords::put(std::size_t at, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i)
    bytes_[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value >> (8 * i));
}

}  // namespace cgsr::sinks
