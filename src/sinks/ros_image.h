#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "platform/image_view.h"
#include "platform/time.h"
#include "src/sinks/mcap_file.h"

namespace cgsr::sinks {

/// \return a topic of images as they came: ROS 2's sensor_msgs/msg/Image in CDR.
McapChannel image_channel(std::string topic);

/// \return a topic of JPEG images: ROS 2's sensor_msgs/msg/CompressedImage in CDR.
McapChannel compressed_image_channel(std::string topic);

/// Serializes an image as sensor_msgs/msg/Image: YUYV as "yuv422_yuy2", grey as "mono8", BGR as "bgr8"; rows without gaps.
/// \param stamp  >= 0. \param frame_id  the camera's frame (docs/frames.md). \param message  replaced; keeps its memory.
void serialize_image(const ImageView& image, MonoTime stamp, std::string_view frame_id,
                     std::vector<std::uint8_t>& message);

/// Serializes an image as sensor_msgs/msg/CompressedImage, format "jpeg".
/// \param quality  1..100. \return false: the image cannot be encoded (it is empty); `message` is empty then.
bool serialize_jpeg(const ImageView& image, MonoTime stamp, std::string_view frame_id, int quality,
                    std::vector<std::uint8_t>& message);

}  // namespace cgsr::sinks
