#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"
#include "platform/time.h"
#include "src/sinks/mcap_records.h"

namespace cgsr::sinks {

/// A topic of a recording and how its messages are to be read.
struct McapChannel {
  std::string topic;             ///< "/track".
  std::string message_encoding;  ///< "json" or "cdr".
  std::string schema_name;       ///< "cgsr/Track", "sensor_msgs/msg/Image".
  std::string schema_encoding;   ///< "jsonschema" or "ros2msg".
  std::string schema;
};

/// \return a topic of JSON messages that obey `schema` (json_schema() of platform/description/json.h).
McapChannel json_channel(std::string topic, std::string schema_name, std::string schema);

enum class McapCompression : std::uint8_t { kNone, kLz4 };
/// \return the format's word: nothing for none.
std::string_view to_string(McapCompression compression);

struct McapOptions {
  McapCompression compression = McapCompression::kLz4;
  std::size_t chunk_bytes = std::size_t{1} << 20;  ///< a chunk is written once it holds this much,
  Duration chunk_span = seconds(0.5);              ///< or once its messages span this time.
  std::string library = "cgsr";                    ///< who wrote the file.
};

struct McapStatistics {
  std::uint64_t messages = 0;
  std::uint64_t chunks = 0;
  std::uint64_t bytes = 0;  ///< of the file.
};

/// Writes an MCAP recording (mcap.dev/spec), which Foxglove, PlotJuggler and the `mcap` tool open.
///
/// Schemas and channels stand at the start of the file, messages in chunks with CRC and index. Each chunk goes to the operating system
/// as one piece: a file cut anywhere can be read up to the last chunk before the cut (`mcap recover` makes it whole again), so
/// a killed program loses at most `chunk_bytes` or `chunk_span`. The profile is "ros2" when all channels are CDR, else empty, as that
/// profile allows nothing but CDR. Attachments are not written.
///
/// Memory: two chunks, and some 100 bytes for the index of every chunk written (1 MB after an hour).
/// Every call returns an error that names the file when it could not be written; after that every call fails.
/// Threads: one at a time. Not for the frame path.
class McapFile {
 public:
  /// Creates or overwrites the file. \param channels  at most 65535; their index is the number that write() takes.
  static Result<McapFile> create(const std::filesystem::path& path, std::vector<McapChannel> channels,
                                 const McapOptions& options = {});

  McapFile(McapFile&&) noexcept;
  McapFile& operator=(McapFile&&) noexcept;
  McapFile(const McapFile&) = delete;
  McapFile& operator=(const McapFile&) = delete;
  ~McapFile();  ///< closes; an error is lost then.

  /// Appends a message. \param channel  < channels(). \param sequence  counted by the sender: a gap shows a loss.
  /// \param stamp  log time and publish time of the message, >= 0.
  Result<void> write(std::size_t channel, std::uint32_t sequence, MonoTime stamp, Bytes data);

  /// Appends named text about the whole recording.
  Result<void> write_metadata(std::string_view name, const std::map<std::string, std::string>& entries);

  /// Writes the chunk in work, if it holds a message.
  Result<void> flush();

  /// Writes what is outstanding, the summary and the footer. Idempotent.
  Result<void> close();

  [[nodiscard]] const std::vector<McapChannel>& channels() const;
  [[nodiscard]] McapStatistics statistics() const;

 private:
  struct State;
  explicit McapFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace cgsr::sinks
