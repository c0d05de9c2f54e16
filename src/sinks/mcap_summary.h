#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "src/sinks/mcap_file.h"
#include "src/sinks/mcap_records.h"

namespace cgsr::sinks {

/// What the end of an MCAP file says of all that came before.
struct McapSummary {
  struct Chunk {
    std::uint64_t first_stamp = 0;
    std::uint64_t last_stamp = 0;
    std::uint64_t offset = 0;  ///< in the file.
    std::uint64_t length = 0;  ///< of the record.
    std::uint64_t stored_bytes = 0;
    std::uint64_t bytes = 0;                                             ///< before compression.
    std::uint64_t index_length = 0;                                      ///< of all its message indexes.
    std::vector<std::pair<std::uint16_t, std::uint64_t>> index_offsets;  ///< channel, offset in the file.
  };
  struct Metadata {
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
    std::string name;
  };

  std::vector<McapChannel> channels;
  std::vector<std::uint64_t> messages;  ///< by channel.
  std::uint64_t message_count = 0;
  std::uint64_t first_stamp = 0;
  std::uint64_t last_stamp = 0;
  std::string compression;  ///< of all chunks.
  std::vector<Chunk> chunks;
  std::vector<Metadata> metadata;

  /// The number of a channel, and of its schema, in the file: from 1, a schema's must not be zero.
  static std::uint16_t number_of(std::size_t channel) { return static_cast<std::uint16_t>(channel + 1); }

  void append_schema(McapRecords& records, std::size_t channel) const;
  void append_channel(McapRecords& records, std::size_t channel) const;

  /// Appends the summary, the summary offsets and the footer up to its checksum, whose four bytes are zero.
  /// \param records  empty. \param start  where they will lie in the file.
  void append_end(McapRecords& records, std::uint64_t start) const;

 private:
  void append_chunk(McapRecords& records, const Chunk& chunk) const;
  void append_statistics(McapRecords& records) const;
};

}  // namespace cgsr::sinks
