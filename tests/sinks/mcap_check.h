#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace cgsr::test {

/// A message of a recording with its topic.
struct McapMessage {
  std::string topic;
  std::uint32_t sequence = 0;
  std::uint64_t stamp_ns = 0;
  std::string data;
};

/// What a recording holds.
struct McapContents {
  std::string profile;
  std::map<std::string, std::string> schemas;  ///< name of the schema by topic.
  std::vector<McapMessage> messages;
  std::map<std::string, std::map<std::string, std::string>> metadata;
  struct Chunk {
    std::size_t end = 0;       ///< offset of the byte behind it.
    std::size_t messages = 0;  ///< in it.
  };
  std::vector<Chunk> chunks;
  bool whole = false;                 ///< ends with summary, footer and magic.
  std::vector<std::string> problems;  ///< empty: as the specification wants it.
};

/// Reads an MCAP file by the specification, sharing no code with its writer. Problems are: wrong checksums; an index that points elsewhere; a
/// message whose channel is not known yet; a summary that contradicts the data; a file that is not whole without having
/// been cut. \param bytes  the file, or its part before a cut: an incomplete record at its end is ignored.
McapContents check_mcap(const std::string& bytes);

std::string read_bytes(const std::filesystem::path& path);

}  // namespace cgsr::test
