#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"
#include "platform/image_view.h"
#include "platform/time.h"
#include "src/sinks/mcap_file.h"
#include "src/sinks/message_queue.h"

namespace cgsr::sinks {

/// How a recording is made.
struct RecorderOptions {
  std::size_t queue_bytes = std::size_t{8} << 20;  ///< between post() and step(): 13 images of 640 x 480 YUYV.
  int jpeg_quality = 80;                           ///< 1..100, of compressed image topics.
  std::string camera_frame = "camera";             ///< frame_id of the images.
  McapOptions file;
};

struct TopicStatistics {
  std::string topic;
  std::uint64_t posted = 0;   ///< messages, the lost ones included.
  std::uint64_t lost = 0;     ///< found no room in the queue, or could not be written.
  std::uint64_t written = 0;  ///< are in the file, or in its chunk in work.
  std::uint64_t bytes = 0;    ///< of the written messages, before compression.
};

/// A recording in MCAP (mcap_file.h) written off the path of who has the messages: post() copies into a bounded queue and never waits,
/// step() does the slow work (JPEG, compression, disk). What finds no room is lost and counted by topic; a message's
/// sequence number counts the lost ones too, so that a reader sees the gap, and close() writes the counts into the file as the
/// metadata record `recorder`.
///
/// Threads: post() from one thread, step() and close() from one other or the same; statistics() from any.
class Recorder {
 public:
  /// Creates or overwrites the file. \param channels  their index is what post() takes: json_channel() for text,
  /// image_channel() and compressed_image_channel() (ros_image.h) for images.
  static Result<std::unique_ptr<Recorder>> create(const std::filesystem::path& path, std::vector<McapChannel> channels,
                                                  const RecorderOptions& options = {});

  /// Copies a message, already encoded as its channel says. \return false: it is lost and counted.
  bool post(std::size_t channel, MonoTime stamp, std::string_view message) noexcept;

  /// Copies an image to an image topic. \return false: it is lost and counted.
  bool post(std::size_t channel, MonoTime stamp, const ImageView& image) noexcept;

  /// Writes what lies in the queue. \return the first error of the file; the queue is emptied all the same.
  Result<void> step();

  /// step(), then the end of the file. Idempotent; nothing may be posted afterwards.
  Result<void> close();

  [[nodiscard]] std::vector<TopicStatistics> statistics() const;
  /// Of the thread that calls step().
  [[nodiscard]] McapStatistics file_statistics() const { return file_.statistics(); }

 private:
  enum class Payload : std::uint8_t { kBytes, kImage, kJpeg };

  struct Topic {
    std::string name;
    Payload payload = Payload::kBytes;
    std::atomic<std::uint64_t> posted{0};
    std::atomic<std::uint64_t> lost{0};
    std::atomic<std::uint64_t> written{0};
    std::atomic<std::uint64_t> bytes{0};
  };

  /// In front of every message in the queue.
  struct Envelope;

  Recorder(McapFile file, const RecorderOptions& options);
  std::uint8_t* reserve(const Envelope& envelope, std::size_t bytes) noexcept;
  Result<void> write(Bytes message);

  McapFile file_;
  RecorderOptions options_;
  MessageQueue queue_;
  std::vector<Topic> topics_;
  std::vector<std::uint8_t> encoded_;
  bool closed_ = false;
};

}  // namespace cgsr::sinks
