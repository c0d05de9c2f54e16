#include "src/sinks/ros_image.h"

#include <utility>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace cgsr::sinks {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

// ROS 2's definitions with what they depend on, as recordings hold them (MCAP's registry, ros2msg).
constexpr std::string_view kImageFields =
    "std_msgs/Header header\n"
    "uint32 height\n"
    "uint32 width\n"
    "string encoding\n"
    "uint8 is_bigendian\n"
    "uint32 step\n"
    "uint8[] data\n";
constexpr std::string_view kCompressedImageFields =
    "std_msgs/Header header\n"
    "string format\n"
    "uint8[] data\n";
constexpr std::string_view kHeaderDefinition =
    "================================================================================\n"
    "MSG: std_msgs/Header\n"
    "builtin_interfaces/Time stamp\n"
    "string frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\n"
    "int32 sec\n"
    "uint32 nanosec\n";

McapChannel ros_channel(std::string topic, std::string type, std::string_view fields) {
  return {std::move(topic), "cdr", std::move(type), "ros2msg", std::string(fields) + std::string(kHeaderDefinition)};
}

const char* encoding_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::kYuyv:
      return "yuv422_yuy2";
    case PixelFormat::kGrey8:
      return "mono8";
    case PixelFormat::kBgr24:
      return "bgr8";
  }
  return "";
}

/// Little-endian CDR with its encapsulation, into `message`, which has to be large enough.
class Serializer {
 public:
  explicit Serializer(std::vector<std::uint8_t>& message)
      : message_(message),
        buffer_(reinterpret_cast<char*>(message.data()), message.size()),
        cdr_(buffer_, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR) {
    cdr_.serialize_encapsulation();
  }

  void header(MonoTime stamp, std::string_view frame_id) {
    const std::int64_t ns = stamp.time_since_epoch().count();
    cdr_ << static_cast<std::int32_t>(ns / 1'000'000'000) << static_cast<std::uint32_t>(ns % 1'000'000'000)
         << std::string(frame_id);
  }

  Cdr& cdr() { return cdr_; }

  void finish() { message_.resize(cdr_.getSerializedDataLength()); }

 private:
  std::vector<std::uint8_t>& message_;
  FastBuffer buffer_;
  Cdr cdr_;
};

constexpr std::size_t kMaxHeaderBytes = 256;  // all fields before the data, apart from frame_id

cv::Mat matrix_of(const ImageView& image, int type) {
  // OpenCV has no view of constant pixels; nothing writes through this one.
  return {image.height_px, image.width_px, type, const_cast<std::uint8_t*>(image.data),
          static_cast<std::size_t>(image.stride_bytes)};
}

}  // namespace

McapChannel image_channel(std::string topic) {
  return ros_channel(std::move(topic), "sensor_msgs/msg/Image", kImageFields);
}

McapChannel compressed_image_channel(std::string topic) {
  return ros_channel(std::move(topic), "sensor_msgs/msg/CompressedImage", kCompressedImageFields);
}

void serialize_image(const ImageView& image, MonoTime stamp, std::string_view frame_id,
                     std::vector<std::uint8_t>& message) {
  const auto step = static_cast<std::uint32_t>(image.width_px * bytes_per_pixel(image.format));
  const auto height = static_cast<std::uint32_t>(image.height_px);
  message.resize(kMaxHeaderBytes + frame_id.size() + std::size_t{step} * height);
  Serializer serializer(message);
  serializer.header(stamp, frame_id);
  Cdr& cdr = serializer.cdr();
  cdr << height << static_cast<std::uint32_t>(image.width_px) << std::string(encoding_of(image.format))
      << std::uint8_t{0} << step << static_cast<std::uint32_t>(step * height);
  for (int y = 0; y < image.height_px; ++y) cdr.serializeArray(image.row(y), step);
  serializer.finish();
}

bool serialize_jpeg(const ImageView& image, MonoTime stamp, std::string_view frame_id, int quality,
                    std::vector<std::uint8_t>& message) {
  message.clear();
  if (image.empty()) return false;
  cv::Mat pixels;
  if (image.format == PixelFormat::kYuyv) {
    cv::cvtColor(matrix_of(image, CV_8UC2), pixels, cv::COLOR_YUV2BGR_YUYV);
  } else {
    pixels = matrix_of(image, image.format == PixelFormat::kGrey8 ? CV_8UC1 : CV_8UC3);
  }
  std::vector<std::uint8_t> jpeg;
  if (!cv::imencode(".jpg", pixels, jpeg, {cv::IMWRITE_JPEG_QUALITY, quality})) return false;
  message.resize(kMaxHeaderBytes + frame_id.size() + jpeg.size());
  Serializer serializer(message);
  serializer.header(stamp, frame_id);
  serializer.cdr() << std::string("jpeg") << static_cast<std::uint32_t>(jpeg.size());
  serializer.cdr().serializeArray(jpeg.data(), jpeg.size());
  serializer.finish();
  return true;
}

}  // namespace cgsr::sinks
