// Setting a camera up: its format, rate, controls and buffers, and starting the stream. What streams is in v4l2_camera.cpp.
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/v4l2/formats.h"
#include "hal/v4l2/v4l2_camera.h"

namespace cgsr::hal::v4l2 {
namespace {

std::string list_of(const std::vector<OfferedFormat>& formats) {
  std::string text;
  for (const auto& format : formats) {
    text += fmt::format("{}{}:", text.empty() ? "" : "; ", fourcc_text(format.fourcc));
    for (const auto& size : format.sizes) text += " " + to_string(size);
  }
  return text.empty() ? "nothing" : text;
}

}  // namespace

Result<CameraMode> V4l2Camera::open_device() {
  unmap_what_came_back();
  const auto path = locate_(parameters_.device);
  if (!path) {
    return fail(fmt::format("{} is not there: `cgsr devices` lists the cameras of this computer", name()));
  }
  auto mode = set_up(*path);
  if (!mode) close_device();
  return mode;
}

Result<CameraMode> V4l2Camera::set_up(const std::string& path) {
  if (const int error = device_->open(path); error != 0) {
    const char* hint = error == EACCES ? ": the user has to be in the group video" : "";
    return fail(fmt::format("{} ({}): {}{}", name(), path, error_words(error), hint));
  }
  const auto facts = facts_of(*device_);
  if (!facts) return fail(fmt::format("{} ({}): {}", name(), path, facts.error().message));
  if (!facts->captures) {
    return fail(
        fmt::format("{}: {} ({}) does not deliver images by streaming; a camera often has a second node for "
                    "metadata: `cgsr devices` lists those that do",
                    name(), path, facts->card));
  }
  auto mode = set_format();
  if (!mode) return mode;
  const auto period = set_rate();
  if (!period) return tl::unexpected(period.error());
  mode->frame_period = *period;
  for (auto& refused : apply_controls(*device_, wishes_)) notes_.push_back(fmt::format("{}: {}", name(), refused));
  if (auto made = make_buffers(); !made) return tl::unexpected(made.error());
  if (auto streams = stream_on(); !streams) return tl::unexpected(streams.error());
  images_since_open_ = 0;
  return mode;
}

Result<CameraMode> V4l2Camera::set_format() {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<std::uint32_t>(parameters_.width_px);
  format.fmt.pix.height = static_cast<std::uint32_t>(parameters_.height_px);
  format.fmt.pix.pixelformat = fourcc_of(parameters_.format);
  format.fmt.pix.field = V4L2_FIELD_NONE;
  if (const int error = device_->control(VIDIOC_S_FMT, &format); error != 0) {
    return fail(
        fmt::format("{}: setting the format failed ({}){}", name(), error_words(error), error == EBUSY ? user() : ""));
  }
  const auto& got = format.fmt.pix;
  if (got.pixelformat != fourcc_of(parameters_.format) || static_cast<int>(got.width) != parameters_.width_px ||
      static_cast<int>(got.height) != parameters_.height_px) {
    return fail(fmt::format("{}: {} {}x{} was requested, the camera gives {} {}x{}; it offers {}", name(),
                            fourcc_text(fourcc_of(parameters_.format)), parameters_.width_px, parameters_.height_px,
                            fourcc_text(got.pixelformat), got.width, got.height, list_of(offered_formats(*device_))));
  }
  const std::ptrdiff_t row = 2 * std::ptrdiff_t{parameters_.width_px};
  stride_bytes_ = parameters_.format == StreamFormat::kYuyv ? std::max<std::ptrdiff_t>(row, got.bytesperline) : row;
  image_bytes_ = static_cast<std::size_t>(stride_bytes_) * static_cast<std::size_t>(parameters_.height_px - 1) +
                 static_cast<std::size_t>(row);
  return CameraMode{.width_px = parameters_.width_px, .height_px = parameters_.height_px};
}

Result<Duration> V4l2Camera::set_rate() {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  auto& capture = parameters.parm.capture;
  capture.timeperframe = {1000, static_cast<std::uint32_t>(std::lround(parameters_.rate_hz * 1000.0))};
  const int error = device_->control(VIDIOC_S_PARM, &parameters);
  const bool said = error == 0 && capture.timeperframe.numerator != 0 && capture.timeperframe.denominator != 0;
  if (!said) {
    notes_.push_back(fmt::format("{} does not say its rate: {} Hz is assumed", name(), parameters_.rate_hz));
    return Duration{std::llround(1e9 / parameters_.rate_hz)};
  }
  const double period_s = static_cast<double>(capture.timeperframe.numerator) / capture.timeperframe.denominator;
  if (!(period_s >= 0.001 && period_s <= 10.0)) {
    return fail(fmt::format("{}: an impossible time per image, {} s", name(), period_s));
  }
  if (std::abs(period_s * parameters_.rate_hz - 1.0) > 0.01) {
    notes_.push_back(
        fmt::format("{}: {} Hz was requested, {:.3g} Hz took effect", name(), parameters_.rate_hz, 1.0 / period_s));
  }
  return Duration{std::llround(period_s * 1e9)};
}

Result<void> V4l2Camera::make_buffers() {
  v4l2_requestbuffers request{};
  request.count = static_cast<std::uint32_t>(parameters_.buffers);
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (const int error = device_->control(VIDIOC_REQBUFS, &request); error != 0) {
    return fail(fmt::format("{}: no buffers ({}){}", name(), error_words(error), error == EBUSY ? user() : ""));
  }
  if (request.count < 2 || request.count > 32) {
    return fail(
        fmt::format("{}: {} buffers were requested, the driver gives {}", name(), parameters_.buffers, request.count));
  }
  buffers_ = std::make_unique<Buffers>(*device_);
  for (int i = 0; i < static_cast<int>(request.count); ++i) {
    v4l2_buffer buffer = capture_buffer(i);
    Mapping mapping;
    int error = device_->control(VIDIOC_QUERYBUF, &buffer);
    if (error == 0) error = device_->map(buffer.length, buffer.m.offset, mapping.at);
    if (error != 0) return fail(fmt::format("{}: buffer {} cannot be mapped ({})", name(), i, error_words(error)));
    mapping.bytes = buffer.length;
    buffers_->mapped.push_back(mapping);
    if (parameters_.format == StreamFormat::kYuyv && mapping.bytes < image_bytes_) {
      return fail(fmt::format("{}: a buffer has {} bytes, an image {}", name(), mapping.bytes, image_bytes_));
    }
  }
  if (parameters_.format == StreamFormat::kMjpeg) {
    buffers_->decoded.assign(request.count, std::vector<std::uint8_t>(image_bytes_));
    buffers_->free_decoded = static_cast<std::uint32_t>((std::uint64_t{1} << request.count) - 1);
  }
  return {};
}

/// Queues every buffer that no reader has, and starts.
Result<void> V4l2Camera::stream_on() {
  queued_ = 0;
  const bool mapped_are_lent = parameters_.format == StreamFormat::kYuyv;
  const std::uint32_t back = buffers_->slots.take_returned();
  if (!mapped_are_lent) buffers_->free_decoded |= back;
  for (int i = 0; i < static_cast<int>(buffers_->mapped.size()); ++i) {
    if (mapped_are_lent && buffers_->slots.on_lease(i)) continue;
    if (const int error = queue(i); error != 0) {
      return fail(fmt::format("{}: buffer {} cannot be queued ({})", name(), i, error_words(error)));
    }
  }
  v4l2_event_subscription changes{};
  changes.type = V4L2_EVENT_SOURCE_CHANGE;
  (void)device_->control(VIDIOC_SUBSCRIBE_EVENT, &changes);  // few cameras have it
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (const int error = device_->control(VIDIOC_STREAMON, &type); error != 0) {
    return fail(fmt::format("{}: the stream does not start ({}){}", name(), error_words(error),
                            error == ENOSPC ? ": the USB bus has no bandwidth left" : ""));
  }
  fresh_stream_ = true;
  alive_at_ = device_->now();
  return {};
}

void V4l2Camera::stream_off() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  (void)device_->control(VIDIOC_STREAMOFF, &type);
}

}  // namespace cgsr::hal::v4l2
