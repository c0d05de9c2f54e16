#include "src/sinks/recorder.h"

#include <cstring>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "src/sinks/ros_image.h"

namespace cgsr::sinks {

struct Recorder::Envelope {
  std::int64_t stamp_ns = 0;
  std::uint32_t channel = 0;
  std::uint32_t sequence = 0;
  std::int32_t width_px = 0;
  std::int32_t height_px = 0;
  PixelFormat format = PixelFormat::kGrey8;
};

Recorder::Recorder(McapFile file, const RecorderOptions& options)
    : file_(std::move(file)), options_(options), queue_(options.queue_bytes), topics_(file_.channels().size()) {
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const McapChannel& channel = file_.channels()[i];
    topics_[i].name = channel.topic;
    if (channel.schema_name == "sensor_msgs/msg/Image") topics_[i].payload = Payload::kImage;
    if (channel.schema_name == "sensor_msgs/msg/CompressedImage") topics_[i].payload = Payload::kJpeg;
  }
}

Result<std::unique_ptr<Recorder>> Recorder::create(const std::filesystem::path& path, std::vector<McapChannel> channels,
                                                   const RecorderOptions& options) {
  auto file = McapFile::create(path, std::move(channels), options.file);
  if (!file) return tl::unexpected(file.error());
  return std::unique_ptr<Recorder>(new Recorder(std::move(*file), options));
}

std::uint8_t* Recorder::reserve(const Envelope& envelope, std::size_t bytes) noexcept {
  Topic& topic = topics_[envelope.channel];
  Envelope numbered = envelope;
  numbered.sequence = static_cast<std::uint32_t>(topic.posted.fetch_add(1, std::memory_order_relaxed));
  std::uint8_t* const place = queue_.reserve(sizeof(Envelope) + bytes);
  if (place == nullptr) {
    topic.lost.fetch_add(1, std::memory_order_relaxed);
    return nullptr;
  }
  std::memcpy(place, &numbered, sizeof(Envelope));
  return place + sizeof(Envelope);
}

bool Recorder::post(std::size_t channel, MonoTime stamp, std::string_view message) noexcept {
  Envelope envelope;
  envelope.stamp_ns = stamp.time_since_epoch().count();
  envelope.channel = static_cast<std::uint32_t>(channel);
  std::uint8_t* const place = reserve(envelope, message.size());
  if (place == nullptr) return false;
  if (!message.empty()) std::memcpy(place, message.data(), message.size());
  queue_.commit();
  return true;
}

bool Recorder::post(std::size_t channel, MonoTime stamp, const ImageView& image) noexcept {
  Envelope envelope;
  envelope.stamp_ns = stamp.time_since_epoch().count();
  envelope.channel = static_cast<std::uint32_t>(channel);
  envelope.width_px = image.width_px;
  envelope.height_px = image.height_px;
  envelope.format = image.format;
  const auto row_bytes = static_cast<std::size_t>(image.width_px * bytes_per_pixel(image.format));
  std::uint8_t* const place = reserve(envelope, row_bytes * static_cast<std::size_t>(image.height_px));
  if (place == nullptr) return false;
  for (int y = 0; y < image.height_px; ++y) {
    std::memcpy(place + row_bytes * static_cast<std::size_t>(y), image.row(y), row_bytes);
  }
  queue_.commit();
  return true;
}

Result<void> Recorder::step() {
  Result<void> outcome;
  for (Bytes message = queue_.front(); message.data() != nullptr; message = queue_.front()) {
    if (auto written = write(message); !written) outcome = std::move(written);
    queue_.pop();
  }
  return outcome;
}

Result<void> Recorder::write(Bytes message) {
  Envelope envelope;
  std::memcpy(&envelope, message.data(), sizeof(Envelope));
  Bytes data = message.subspan(sizeof(Envelope));
  Topic& topic = topics_[envelope.channel];
  const MonoTime stamp{Duration{envelope.stamp_ns}};
  if (topic.payload != Payload::kBytes) {
    const ImageView image{data.data(), envelope.width_px, envelope.height_px,
                          static_cast<std::ptrdiff_t>(envelope.width_px) * bytes_per_pixel(envelope.format),
                          envelope.format};
    if (topic.payload == Payload::kImage) {
      serialize_image(image, stamp, options_.camera_frame, encoded_);
    } else if (!serialize_jpeg(image, stamp, options_.camera_frame, options_.jpeg_quality, encoded_)) {
      topic.lost.fetch_add(1, std::memory_order_relaxed);
      return fail(fmt::format("{}: image {} cannot be encoded as JPEG", topic.name, envelope.sequence));
    }
    data = encoded_;
  }
  auto written = file_.write(envelope.channel, envelope.sequence, stamp, data);
  if (!written) {
    topic.lost.fetch_add(1, std::memory_order_relaxed);
    return written;
  }
  topic.written.fetch_add(1, std::memory_order_relaxed);
  topic.bytes.fetch_add(data.size(), std::memory_order_relaxed);
  return {};
}

Result<void> Recorder::close() {
  if (closed_) return file_.close();
  closed_ = true;
  auto outcome = step();
  std::map<std::string, std::string> counts;
  for (const TopicStatistics& topic : statistics()) {
    counts[topic.topic] = fmt::format("posted {}, lost {}", topic.posted, topic.lost);
  }
  if (auto written = file_.write_metadata("recorder", counts); outcome && !written) outcome = std::move(written);
  if (auto closed = file_.close(); outcome && !closed) outcome = std::move(closed);
  return outcome;
}

std::vector<TopicStatistics> Recorder::statistics() const {
  std::vector<TopicStatistics> all;
  all.reserve(topics_.size());
  for (const Topic& topic : topics_) {
    all.push_back({topic.name, topic.posted.load(std::memory_order_relaxed), topic.lost.load(std::memory_order_relaxed),
                   topic.written.load(std::memory_order_relaxed), topic.bytes.load(std::memory_order_relaxed)});
  }
  return all;
}

}  // namespace cgsr::sinks
