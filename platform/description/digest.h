#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "platform/description.h"

namespace cgsr {

/// Appends fields to a hash in a fixed binary order that knows no names, units or words: renaming and regrouping fields into
/// sections keeps the digest, a changed value or order changes it.
///
///   every value     one byte 1, then the value; when it is not there one byte 0, nothing else
///   number          8 bytes, IEEE 754 binary64, little endian; -0.0 is not 0.0
///   integer, choice 8 bytes, two's complement, little endian
///   flag            1 byte, 0 or 1
///   text            nothing, not even the first byte
///   section         its fields
///   list            8 bytes, the count, then the fields of its elements
///
/// \tparam Hash  has add(const void* bytes, std::size_t count), as config::Sha256. Nothing else is called or allocated.
template <class Hash>
class DigestReader {
 public:
  static constexpr bool kOfType = false;

  explicit DigestReader(Hash& hash) : hash_(hash) {}

  void field(const Field& field) {
    if (field.kind == Field::Kind::kText) return;
    add(field.present ? 1 : 0, 1);
    if (!field.present) return;
    if (field.kind == Field::Kind::kNumber) {
      add(std::bit_cast<std::uint64_t>(field.number), 8);
    } else {
      add(static_cast<std::uint64_t>(field.integer), field.kind == Field::Kind::kFlag ? 1 : 8);
    }
  }
  void begin_section(std::string_view, std::string_view, bool, bool) {}
  void end_section() {}
  void begin_list(std::string_view, std::string_view, std::size_t count) { add(count, 8); }
  void end_list() {}
  void begin_element() {}
  void end_element() {}

 private:
  void add(std::uint64_t value, std::size_t bytes) {
    unsigned char little_endian[8];
    for (std::size_t i = 0; i < bytes; ++i) little_endian[i] = static_cast<unsigned char>(value >> (8 * i));
    hash_.add(little_endian, bytes);
  }

  Hash& hash_;
};

template <class Hash, class Output>
void append_to_digest(Hash& hash, const Output& output) {
  DigestReader<Hash> reader(hash);
  read_fields(output, reader);
}

}  // namespace cgsr
