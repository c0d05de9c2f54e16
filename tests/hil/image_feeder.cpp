#include "tests/hil/image_feeder.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace cgsr::hil {
namespace {

constexpr int kWaitForBuffer_ms = 20;

v4l2_buffer buffer_of(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

}  // namespace

tl::unexpected<Error> ImageFeeder::failed(const std::string& what) {
  return fail(fmt::format("{}: {}: {}", feed_.device, what, std::strerror(errno)));
}

Result<void> ImageFeeder::load(bool whole) {
  if (data_ == nullptr) {
    const int file = ::open(feed_.file.c_str(), O_RDONLY | O_CLOEXEC);
    const off_t size = file < 0 ? -1 : lseek(file, 0, SEEK_END);  // of a memory module too
    if (size < 0) return fail(fmt::format("{}: {}", feed_.file, std::strerror(errno)));
    images_ = static_cast<std::size_t>(size) / feed_.bytes();
    if (feed_.count > 0) images_ = std::min(images_, feed_.count);
    void* const mapped = mmap(nullptr, images_ * feed_.bytes(), PROT_READ, MAP_SHARED, file, 0);
    ::close(file);
    if (mapped == MAP_FAILED) return fail(fmt::format("{}: {}", feed_.file, std::strerror(errno)));
    data_ = static_cast<const std::uint8_t*>(mapped);
  }
  if (!whole) return {};
  // MADV_POPULATE_READ reads every page and maps it: no fault later.
  if (madvise(const_cast<std::uint8_t*>(data_), images_ * feed_.bytes(), MADV_POPULATE_READ) != 0) {
    return fail(fmt::format("reading {}: {}", feed_.file, std::strerror(errno)));
  }
  return {};
}

Result<void> ImageFeeder::open() {
  fd_ = ::open(feed_.device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fd_ < 0) return failed("opening");
  auto ready = set_format();
  if (ready) ready = make_buffers();
  if (!ready) close();
  return ready;
}

/// Leaves a format that is right as it is: setting it counts as a change of the source at the other end.
Result<void> ImageFeeder::set_format() {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  const auto& now = format.fmt.pix;
  if (ioctl(fd_, VIDIOC_G_FMT, &format) == 0 && now.pixelformat == V4L2_PIX_FMT_YUYV &&
      now.sizeimage == feed_.bytes() && static_cast<int>(now.width) == feed_.width_px) {
    return {};
  }
  format.fmt.pix.width = static_cast<std::uint32_t>(feed_.width_px);
  format.fmt.pix.height = static_cast<std::uint32_t>(feed_.height_px);
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.bytesperline = static_cast<std::uint32_t>(feed_.width_px) * 2;
  format.fmt.pix.sizeimage = static_cast<std::uint32_t>(feed_.bytes());
  format.fmt.pix.colorspace = V4L2_COLORSPACE_SRGB;
  if (ioctl(fd_, VIDIOC_S_FMT, &format) != 0) return failed("VIDIOC_S_FMT");
  if (format.fmt.pix.sizeimage != feed_.bytes()) {
    return fail(
        fmt::format("{}: takes images of {} bytes, not of {}", feed_.device, format.fmt.pix.sizeimage, feed_.bytes()));
  }
  return {};
}

Result<void> ImageFeeder::make_buffers() {
  v4l2_requestbuffers request{};
  request.count = feed_.buffers;
  request.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  request.memory = V4L2_MEMORY_MMAP;
  if (ioctl(fd_, VIDIOC_REQBUFS, &request) != 0) return failed("VIDIOC_REQBUFS");
  for (std::uint32_t i = 0; i < request.count; ++i) {
    v4l2_buffer buffer = buffer_of(i);
    if (ioctl(fd_, VIDIOC_QUERYBUF, &buffer) != 0) return failed("VIDIOC_QUERYBUF");
    void* const at = mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, buffer.m.offset);
    if (at == MAP_FAILED || buffer.length < feed_.bytes()) return failed("a buffer");
    buffers_.push_back({at, buffer.length});
  }
  return {};
}

void ImageFeeder::close() {
  for (const Buffer& buffer : buffers_) munmap(buffer.at, buffer.bytes);  // a mapping would keep the device
  buffers_.clear();
  queued_ = 0;
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

/// One that was never queued, else one that the device has shown.
Result<void> ImageFeeder::take_buffer(std::uint32_t& index) {
  if (queued_ < buffers_.size()) {
    index = queued_;
    return {};
  }
  pollfd watched{fd_, POLLOUT, 0};
  (void)poll(&watched, 1, kWaitForBuffer_ms);
  v4l2_buffer buffer = buffer_of(0);
  if (ioctl(fd_, VIDIOC_DQBUF, &buffer) != 0) return failed("VIDIOC_DQBUF");
  // v4l2loopback names the one that was queued last, and takes any.
  index = buffer.index == last_ ? (last_ + 1) % static_cast<std::uint32_t>(buffers_.size()) : buffer.index;
  return {};
}

Result<void> ImageFeeder::queue(std::uint32_t index) {
  v4l2_buffer buffer = buffer_of(index);
  buffer.bytesused = static_cast<std::uint32_t>(feed_.bytes());
  buffer.field = V4L2_FIELD_NONE;
  if (ioctl(fd_, VIDIOC_QBUF, &buffer) != 0) return failed("VIDIOC_QBUF");
  last_ = index;
  if (queued_ == buffers_.size() || ++queued_ < buffers_.size()) return {};
  int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  if (ioctl(fd_, VIDIOC_STREAMON, &type) != 0) return failed("VIDIOC_STREAMON");
  return {};
}

Result<void> ImageFeeder::put(std::size_t image) {
  std::uint32_t index = 0;
  const bool starting = queued_ < buffers_.size();
  do {  // at the start, all buffers show it
    if (auto taken = take_buffer(index); !taken) {
      if (errno != EAGAIN) close();
      return taken;
    }
    std::memcpy(buffers_[index].at, data_ + image * feed_.bytes(), feed_.bytes());
    if (auto queued = queue(index); !queued) {
      close();
      return queued;
    }
  } while (starting && queued_ < buffers_.size());
  return {};
}

}  // namespace cgsr::hil
