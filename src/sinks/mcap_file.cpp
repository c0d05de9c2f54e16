#include "src/sinks/mcap_file.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include <fmt/format.h>
#include <lz4frame.h>
#include <zlib.h>

#include "src/sinks/mcap_summary.h"

namespace cgsr::sinks {
namespace {

struct IndexEntry {
  std::uint64_t stamp = 0;
  std::uint64_t offset = 0;  // in the chunk, uncompressed
};

std::uint32_t add_to_crc(std::uint32_t crc, Bytes bytes) {
  return static_cast<std::uint32_t>(crc32_z(crc, bytes.data(), bytes.size()));
}

}  // namespace

std::string_view to_string(McapCompression compression) {
  switch (compression) {
    case McapCompression::kNone:
      return "";
    case McapCompression::kLz4:
      return "lz4";
  }
  return "";
}

McapChannel json_channel(std::string topic, std::string schema_name, std::string schema) {
  return {std::move(topic), "json", std::move(schema_name), "jsonschema", std::move(schema)};
}

struct McapFile::State {
  std::filesystem::path path;
  std::ofstream stream;
  McapOptions options;
  McapSummary summary;

  std::uint64_t offset = 0;  // bytes in the file
  std::uint32_t data_crc = 0;
  bool closed = false;

  McapRecords chunk;                           // the records of the chunk in work
  std::vector<std::vector<IndexEntry>> index;  // of the chunk in work, by channel
  std::uint64_t first_stamp = 0;
  std::uint64_t last_stamp = 0;
  McapRecords record;                    // in work
  std::vector<std::uint8_t> compressed;  // of the chunk in work

  [[nodiscard]] Result<void> state() const {
    if (stream.fail()) {
      return fail(fmt::format("{}: the recording cannot be written; is the disk full?", path.string()));
    }
    return {};
  }

  void put(Bytes bytes) {
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    offset += bytes.size();
    data_crc = add_to_crc(data_crc, bytes);
  }

  void add_header() {
    const bool all_cdr = std::all_of(summary.channels.begin(), summary.channels.end(),
                                     [](const McapChannel& channel) { return channel.message_encoding == "cdr"; });
    record.raw(bytes_of(kMcapMagic));
    record.begin(McapOpcode::kHeader);
    record.string(all_cdr && !summary.channels.empty() ? "ros2" : "");
    record.string(options.library);
    record.end();
    for (std::size_t i = 0; i < summary.channels.size(); ++i) {
      summary.append_schema(record, i);
      summary.append_channel(record, i);
    }
    put(record.bytes());
    record.clear();
    stream.flush();
  }

  /// \return the records of the chunk as they go into the file.
  Bytes stored_chunk() {
    if (options.compression == McapCompression::kNone) return chunk.bytes();
    LZ4F_preferences_t preferences{};
    preferences.frameInfo.contentSize = chunk.size();
    compressed.resize(LZ4F_compressFrameBound(chunk.size(), &preferences));
    const std::size_t size =
        LZ4F_compressFrame(compressed.data(), compressed.size(), chunk.bytes().data(), chunk.size(), &preferences);
    if (LZ4F_isError(size) != 0U) {  // cannot happen: the bound is the library's own
      stream.setstate(std::ios::failbit);
      return {};
    }
    return Bytes(compressed).first(size);
  }

  void write_chunk() {
    const Bytes stored = stored_chunk();
    McapSummary::Chunk entry;
    entry.first_stamp = first_stamp;
    entry.last_stamp = last_stamp;
    entry.offset = offset;
    entry.stored_bytes = stored.size();
    entry.bytes = chunk.size();
    record.begin(McapOpcode::kChunk);
    record.u64(first_stamp);
    record.u64(last_stamp);
    record.u64(chunk.size());
    record.u32(add_to_crc(0, chunk.bytes()));
    record.string(summary.compression);
    record.u64(stored.size());
    record.raw(stored);
    record.end();
    entry.length = record.size();
    for (std::size_t i = 0; i < index.size(); ++i) add_message_index(i, entry);
    entry.index_length = record.size() - entry.length;
    put(record.bytes());
    stream.flush();
    record.clear();
    chunk.clear();
    summary.chunks.push_back(std::move(entry));
  }

  void add_message_index(std::size_t channel, McapSummary::Chunk& entry) {
    if (index[channel].empty()) return;
    entry.index_offsets.emplace_back(McapSummary::number_of(channel), offset + record.size());
    record.begin(McapOpcode::kMessageIndex);
    record.u16(McapSummary::number_of(channel));
    record.begin_array();
    for (const IndexEntry& message : index[channel]) {
      record.u64(message.stamp);
      record.u64(message.offset);
    }
    record.end_array();
    record.end();
    index[channel].clear();
  }

  void write_end() {
    record.begin(McapOpcode::kDataEnd);
    record.u32(data_crc);
    record.end();
    put(record.bytes());
    record.clear();
    summary.append_end(record, offset);
    const Bytes covered = record.bytes().first(record.size() - 4);  // by the checksum that ends the footer
    const std::uint32_t crc = add_to_crc(0, covered);
    put(covered);
    record.clear();
    record.u32(crc);
    record.raw(bytes_of(kMcapMagic));
    put(record.bytes());
    record.clear();
  }
};

McapFile::McapFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
McapFile::McapFile(McapFile&&) noexcept = default;
McapFile& McapFile::operator=(McapFile&&) noexcept = default;

McapFile::~McapFile() {
  if (state_) static_cast<void>(close());
}

Result<McapFile> McapFile::create(const std::filesystem::path& path, std::vector<McapChannel> channels,
                                  const McapOptions& options) {
  if (channels.size() > 65535) {
    return fail(fmt::format("{}: {} channels, at most 65535", path.string(), channels.size()));
  }
  auto state = std::make_unique<State>();
  state->path = path;
  state->stream.open(path, std::ios::binary | std::ios::trunc);
  if (!state->stream) {
    return fail(
        fmt::format("{}: the recording cannot be created; check the folder and its permissions", path.string()));
  }
  state->index.resize(channels.size());
  state->options = options;
  state->summary.messages.resize(channels.size());
  state->summary.channels = std::move(channels);
  state->summary.compression = to_string(options.compression);
  state->add_header();
  if (auto written = state->state(); !written) return tl::unexpected(written.error());
  return McapFile(std::move(state));
}

Result<void> McapFile::write(std::size_t channel, std::uint32_t sequence, MonoTime stamp, Bytes data) {
  State& file = *state_;
  const auto time = static_cast<std::uint64_t>(std::max<std::int64_t>(stamp.time_since_epoch().count(), 0));
  const bool empty = file.chunk.size() == 0;
  file.first_stamp = empty ? time : std::min(file.first_stamp, time);
  file.last_stamp = empty ? time : std::max(file.last_stamp, time);
  McapSummary& summary = file.summary;
  summary.first_stamp = summary.message_count == 0 ? time : std::min(summary.first_stamp, time);
  summary.last_stamp = std::max(summary.last_stamp, time);
  ++summary.message_count;
  ++summary.messages[channel];
  file.index[channel].push_back({time, file.chunk.size()});
  file.chunk.begin(McapOpcode::kMessage);
  file.chunk.u16(McapSummary::number_of(channel));
  file.chunk.u32(sequence);
  file.chunk.u64(time);
  file.chunk.u64(time);
  file.chunk.raw(data);
  file.chunk.end();
  const auto span = static_cast<std::uint64_t>(file.options.chunk_span.count());
  if (file.chunk.size() >= file.options.chunk_bytes || file.last_stamp - file.first_stamp >= span) return flush();
  return file.state();
}

Result<void> McapFile::write_metadata(std::string_view name, const std::map<std::string, std::string>& entries) {
  if (auto flushed = flush(); !flushed) return flushed;
  State& file = *state_;
  file.record.begin(McapOpcode::kMetadata);
  file.record.string(name);
  file.record.begin_array();
  for (const auto& [key, value] : entries) {
    file.record.string(key);
    file.record.string(value);
  }
  file.record.end_array();
  file.record.end();
  file.summary.metadata.push_back({file.offset, file.record.size(), std::string(name)});
  file.put(file.record.bytes());
  file.record.clear();
  return file.state();
}

Result<void> McapFile::flush() {
  if (state_->chunk.size() > 0) state_->write_chunk();
  return state_->state();
}

Result<void> McapFile::close() {
  State& file = *state_;
  if (!file.closed) {
    file.closed = true;
    if (file.chunk.size() > 0) file.write_chunk();
    file.write_end();
    file.stream.close();
  }
  return file.state();
}

const std::vector<McapChannel>& McapFile::channels() const {
  return state_->summary.channels;
}

McapStatistics McapFile::statistics() const {
  return {state_->summary.message_count, state_->summary.chunks.size(), state_->offset};
}

}  // namespace cgsr::sinks
