#include "src/sinks/mcap_summary.h"

namespace cgsr::sinks {

void McapSummary::append_schema(McapRecords& records, std::size_t channel) const {
  records.begin(McapOpcode::kSchema);
  records.u16(number_of(channel));
  records.string(channels[channel].schema_name);
  records.string(channels[channel].schema_encoding);
  records.string(channels[channel].schema);
  records.end();
}

void McapSummary::append_channel(McapRecords& records, std::size_t channel) const {
  records.begin(McapOpcode::kChannel);
  records.u16(number_of(channel));
  records.u16(number_of(channel));
  records.string(channels[channel].topic);
  records.string(channels[channel].message_encoding);
  records.begin_array();
  if (channels[channel].message_encoding == "cdr") {  // ROS 2's profile wants it
    records.string("offered_qos_profiles");
    records.string("");
  }
  records.end_array();
  records.end();
}

void McapSummary::append_chunk(McapRecords& records, const Chunk& chunk) const {
  records.begin(McapOpcode::kChunkIndex);
  records.u64(chunk.first_stamp);
  records.u64(chunk.last_stamp);
  records.u64(chunk.offset);
  records.u64(chunk.length);
  records.begin_array();
  for (const auto& [channel, offset] : chunk.index_offsets) {
    records.u16(channel);
    records.u64(offset);
  }
  records.end_array();
  records.u64(chunk.index_length);
  records.string(compression);
  records.u64(chunk.stored_bytes);
  records.u64(chunk.bytes);
  records.end();
}

void McapSummary::append_statistics(McapRecords& records) const {
  records.begin(McapOpcode::kStatistics);
  records.u64(message_count);
  records.u16(static_cast<std::uint16_t>(channels.size()));  // schemas
  records.u32(static_cast<std::uint32_t>(channels.size()));
  records.u32(0);  // attachments
  records.u32(static_cast<std::uint32_t>(metadata.size()));
  records.u32(static_cast<std::uint32_t>(chunks.size()));
  records.u64(first_stamp);
  records.u64(last_stamp);
  records.begin_array();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    records.u16(number_of(i));
    records.u64(messages[i]);
  }
  records.end_array();
  records.end();
}

void McapSummary::append_end(McapRecords& records, std::uint64_t start) const {
  struct Group {
    McapOpcode opcode;
    std::uint64_t begin;
    std::uint64_t end;
  };
  std::vector<Group> groups;
  // Records of one opcode stand together; each group that is not empty gets a record of its place.
  const auto group = [&](McapOpcode opcode, std::size_t count, const auto& append) {
    const std::uint64_t begin = start + records.size();
    for (std::size_t i = 0; i < count; ++i) append(i);
    if (count > 0) groups.push_back({opcode, begin, start + records.size()});
  };
  group(McapOpcode::kSchema, channels.size(), [&](std::size_t i) { append_schema(records, i); });
  group(McapOpcode::kChannel, channels.size(), [&](std::size_t i) { append_channel(records, i); });
  group(McapOpcode::kChunkIndex, chunks.size(), [&](std::size_t i) { append_chunk(records, chunks[i]); });
  group(McapOpcode::kMetadataIndex, metadata.size(), [&](std::size_t i) {
    records.begin(McapOpcode::kMetadataIndex);
    records.u64(metadata[i].offset);
    records.u64(metadata[i].length);
    records.string(metadata[i].name);
    records.end();
  });
  group(McapOpcode::kStatistics, 1, [&](std::size_t) { append_statistics(records); });
  const std::uint64_t offsets_start = start + records.size();
  for (const Group& place : groups) {
    records.begin(McapOpcode::kSummaryOffset);
    records.u8(static_cast<std::uint8_t>(place.opcode));
    records.u64(place.begin);
    records.u64(place.end - place.begin);
    records.end();
  }
  records.begin(McapOpcode::kFooter);
  records.u64(start);
  records.u64(offsets_start);
  records.u32(0);
  records.end();
}

}  // namespace cgsr::sinks
