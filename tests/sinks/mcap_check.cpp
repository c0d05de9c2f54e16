#include "tests/sinks/mcap_check.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>
#include <tuple>

#include <fmt/format.h>
#include <lz4frame.h>

namespace cgsr::test {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";

std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = ~0U;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0U ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

/// Takes fields from the front of a record.
class Fields {
 public:
  explicit Fields(std::string_view bytes) : rest_(bytes) {}

  std::uint64_t number(std::size_t bytes) {
    const std::string_view field = take(bytes);
    std::uint64_t value = 0;
    for (std::size_t i = field.size(); i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(field[i]);
    return value;
  }
  std::string_view text() { return take(number(4)); }
  std::string_view take(std::uint64_t bytes) {
    if (bytes > rest_.size()) {
      short_ = true;
      bytes = rest_.size();
    }
    const std::string_view field = rest_.substr(0, bytes);
    rest_.remove_prefix(bytes);
    return field;
  }
  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[nodiscard]] bool empty() const { return rest_.empty(); }
  [[nodiscard]] bool is_short() const { return short_; }

 private:
  std::string_view rest_;
  bool short_ = false;
};

std::string decompress(std::string_view bytes, std::size_t size) {
  std::string plain(size, '\0');
  LZ4F_dctx* context = nullptr;
  LZ4F_createDecompressionContext(&context, LZ4F_VERSION);
  std::size_t written = size;
  std::size_t read = bytes.size();
  const std::size_t left = LZ4F_decompress(context, plain.data(), &written, bytes.data(), &read, nullptr);
  LZ4F_freeDecompressionContext(context);
  return left == 0 && written == size ? plain : std::string();
}

class Checker {
 public:
  explicit Checker(std::string_view file) : file_(file) {}

  McapContents run() {
    if (file_.substr(0, kMagic.size()) != kMagic.substr(0, file_.size())) problem("no magic");
    std::size_t at = kMagic.size();
    while (at + 9 <= file_.size() && !footer_) {
      const auto opcode = static_cast<std::uint8_t>(file_[at]);
      const std::uint64_t length = Fields(file_.substr(at + 1)).number(8);
      if (length > file_.size() - at - 9) break;  // cut
      record(at, opcode, file_.substr(at + 9, length));
      at += 9 + length;
    }
    if (footer_) {
      contents_.whole = file_.substr(at) == kMagic;
      if (!contents_.whole && at + kMagic.size() <= file_.size()) problem("what follows the footer is not the magic");
    }
    return std::move(contents_);
  }

 private:
  void problem(const std::string& problem) { contents_.problems.push_back(problem); }

  void record(std::size_t at, std::uint8_t opcode, std::string_view body) {
    Fields fields(body);
    starts_[at] = opcode;
    if (data_end_ && summary_start_ == 0) summary_start_ = at;
    switch (opcode) {
      case 0x01:
        contents_.profile = fields.text();
        break;
      case 0x02:
        footer(at, fields);
        break;
      case 0x03:
        schema(fields);
        break;
      case 0x04:
        channel(fields);
        break;
      case 0x05:
        problem("a message outside of chunks");
        break;
      case 0x06:
        chunk(at, body.size() + 9, fields);
        break;
      case 0x07:
        message_index(fields);
        break;
      case 0x08:
        chunk_index(fields);
        break;
      case 0x0B:
        statistics(fields);
        break;
      case 0x0C:
        metadata(fields);
        break;
      case 0x0D:
        if (starts_.count(fields.number(8)) == 0) problem("an index of metadata points beside it");
        break;
      case 0x0E:
        summary_offset(fields);
        break;
      case 0x0F:
        data_end_ = true;
        if (fields.number(4) != crc32(file_.substr(0, at))) problem("checksum of the data section");
        break;
      default:
        problem(fmt::format("unknown opcode {:#x}", opcode));
    }
    if (fields.is_short()) problem(fmt::format("record {:#x} at {} is too short", opcode, at));
  }

  void schema(Fields& fields) {
    const std::uint64_t id = fields.number(2);
    if (id == 0) problem("a schema without number");
    const std::string name(fields.text());
    const std::string rest(fields.rest());
    const auto [known, is_new] = schemas_.try_emplace(id, name, rest);
    if (known->second != std::pair(name, rest)) problem("two schemas with the same number");
    if (is_new && data_end_) problem("the summary has a schema that the data have not");
  }

  void channel(Fields& fields) {
    const std::uint64_t id = fields.number(2);
    const std::uint64_t schema = fields.number(2);
    const std::string topic(fields.text());
    if (schemas_.count(schema) == 0) problem("channel " + topic + " names an unknown schema");
    contents_.schemas[topic] = schemas_[schema].first;
    channels_[id] = topic;
  }

  void chunk(std::size_t at, std::size_t length, Fields& fields) {
    const std::uint64_t first = fields.number(8);
    const std::uint64_t last = fields.number(8);
    const std::uint64_t size = fields.number(8);
    const auto crc = static_cast<std::uint32_t>(fields.number(4));
    const std::string compression(fields.text());
    const std::string_view stored = fields.take(fields.number(8));
    chunk_ = compression == "lz4" ? decompress(stored, size) : std::string(stored);
    if (chunk_.size() != size || crc32(chunk_) != crc) return problem(fmt::format("checksum of the chunk at {}", at));
    in_chunk_.clear();
    std::uint64_t lowest = ~std::uint64_t{0};
    std::uint64_t highest = 0;
    for (Fields records(chunk_); !records.empty();) {
      const std::uint64_t offset = chunk_.size() - records.rest().size();
      if (records.number(1) != 0x05) return problem("something else than a message in a chunk");
      const std::uint64_t stamp = message(records.take(records.number(8)), offset);
      lowest = std::min(lowest, stamp);
      highest = std::max(highest, stamp);
    }
    if (lowest != first || highest != last) problem("the times of a chunk are not those of its messages");
    chunks_[at] = {length, in_chunk_.size()};
    contents_.chunks.push_back({at + length, in_chunk_.size()});
  }

  std::uint64_t message(std::string_view body, std::uint64_t offset) {
    Fields fields(body);
    const std::uint64_t channel = fields.number(2);
    const auto sequence = static_cast<std::uint32_t>(fields.number(4));
    const std::uint64_t stamp = fields.number(8);
    if (fields.number(8) != stamp) problem("publish time differs from log time");
    if (channels_.count(channel) == 0) problem("a message of an unknown channel");
    ++counts_[channel];
    in_chunk_.insert({channel, stamp, offset});
    contents_.messages.push_back({channels_[channel], sequence, stamp, std::string(fields.rest())});
    return stamp;
  }

  void message_index(Fields& fields) {
    const std::uint64_t channel = fields.number(2);
    Fields entries(fields.text());
    while (!entries.empty()) {
      const std::uint64_t stamp = entries.number(8);
      const std::uint64_t offset = entries.number(8);
      if (in_chunk_.count({channel, stamp, offset}) == 0) problem("an index entry points at no message of its chunk");
    }
  }

  void chunk_index(Fields& fields) {
    fields.take(16);
    const std::uint64_t at = fields.number(8);
    const std::uint64_t length = fields.number(8);
    if (chunks_.count(at) == 0 || chunks_[at].first != length) problem("a chunk index points beside its chunk");
    ++chunk_indexes_;
    Fields offsets(fields.text());
    while (!offsets.empty()) {
      offsets.number(2);
      const std::uint64_t index = offsets.number(8);
      if (starts_.count(index) == 0 || starts_[index] != 0x07) problem("a chunk index points at no message index");
    }
  }

  void statistics(Fields& fields) {
    if (fields.number(8) != contents_.messages.size()) problem("statistics: messages");
    if (fields.number(2) != schemas_.size()) problem("statistics: schemas");
    if (fields.number(4) != channels_.size()) problem("statistics: channels");
    if (fields.number(4) != 0) problem("statistics: attachments");
    if (fields.number(4) != contents_.metadata.size()) problem("statistics: metadata");
    if (fields.number(4) != chunks_.size() || chunk_indexes_ != chunks_.size()) problem("statistics: chunks");
    fields.take(16);
    Fields counts(fields.text());
    while (!counts.empty()) {
      const std::uint64_t channel = counts.number(2);
      if (counts.number(8) != counts_[channel]) problem("statistics: messages of " + channels_[channel]);
    }
  }

  void metadata(Fields& fields) {
    auto& entries = contents_.metadata[std::string(fields.text())];
    for (Fields map(fields.text()); !map.empty();) {
      const std::string key(map.text());
      entries[key] = map.text();
    }
  }

  void summary_offset(Fields& fields) {
    if (offsets_start_ == 0) offsets_start_ = starts_.rbegin()->first;
    const auto opcode = static_cast<std::uint8_t>(fields.number(1));
    const std::uint64_t start = fields.number(8);
    const std::uint64_t end = start + fields.number(8);
    if (starts_.count(start) == 0 || starts_.count(end) == 0) return problem("a summary offset points between records");
    for (auto record = starts_.find(start); record->first < end; ++record) {
      if (record->second != opcode) problem("a summary group is mixed");
    }
  }

  void footer(std::size_t at, Fields& fields) {
    footer_ = true;
    if (fields.number(8) != summary_start_) problem("the footer misses the summary");
    if (fields.number(8) != offsets_start_) problem("the footer misses the summary offsets");
    if (fields.number(4) != crc32(file_.substr(summary_start_, at + 9 + 16 - summary_start_))) {
      problem("checksum of the summary");
    }
  }

  std::string_view file_;
  McapContents contents_;
  std::map<std::uint64_t, std::uint8_t> starts_;  // opcode by offset
  std::map<std::uint64_t, std::pair<std::string, std::string>> schemas_;
  std::map<std::uint64_t, std::string> channels_;
  std::map<std::uint64_t, std::uint64_t> counts_;
  std::map<std::uint64_t, std::pair<std::uint64_t, std::size_t>> chunks_;  // length, messages
  std::string chunk_;                                                      // the last, uncompressed
  std::set<std::tuple<std::uint64_t, std::uint64_t, std::uint64_t>> in_chunk_;
  std::size_t chunk_indexes_ = 0;
  std::uint64_t summary_start_ = 0;
  std::uint64_t offsets_start_ = 0;
  bool data_end_ = false;
  bool footer_ = false;
};

}  // namespace

McapContents check_mcap(const std::string& bytes) {
  return Checker(bytes).run();
}

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace cgsr::test
