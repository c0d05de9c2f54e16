#include "tests/hil/image_feeder.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace cgsr::hil {
namespace {

tl::unexpected<Error> failed(const std::string& what) {
  return fail(fmt::format("{}: {}", what, std::strerror(errno)));
}

}  // namespace

Result<void> ImageFeeder::load(bool whole) {
  if (data_ == nullptr) {
    const int file = ::open(feed_.file.c_str(), O_RDONLY | O_CLOEXEC);
    const off_t size = file < 0 ? -1 : lseek(file, 0, SEEK_END);  // of a memory module too
    if (size < 0) return failed(feed_.file);
    images_ = static_cast<std::size_t>(size) / feed_.bytes();
    if (feed_.count > 0) images_ = std::min(images_, feed_.count);
    void* const mapped = mmap(nullptr, images_ * feed_.bytes(), PROT_READ, MAP_SHARED, file, 0);
    ::close(file);
    if (mapped == MAP_FAILED) return failed(feed_.file);
    data_ = static_cast<const std::uint8_t*>(mapped);
  }
  if (!whole) return {};
  // MADV_POPULATE_READ reads every page and maps it: no fault later.
  if (madvise(const_cast<std::uint8_t*>(data_), images_ * feed_.bytes(), MADV_POPULATE_READ) != 0) {
    return failed(fmt::format("reading {}", feed_.file));
  }
  return {};
}

Result<void> ImageFeeder::open() {
  fd_ = ::open(feed_.device.c_str(), O_WRONLY | O_CLOEXEC);
  if (fd_ < 0) return failed(feed_.device);
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  format.fmt.pix.width = static_cast<std::uint32_t>(feed_.width_px);
  format.fmt.pix.height = static_cast<std::uint32_t>(feed_.height_px);
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.bytesperline = static_cast<std::uint32_t>(feed_.width_px) * 2;
  format.fmt.pix.sizeimage = static_cast<std::uint32_t>(feed_.bytes());
  format.fmt.pix.colorspace = V4L2_COLORSPACE_SRGB;
  if (ioctl(fd_, VIDIOC_S_FMT, &format) != 0) {
    auto error = failed(fmt::format("{}: VIDIOC_S_FMT", feed_.device));
    close();
    return error;
  }
  if (format.fmt.pix.sizeimage != feed_.bytes()) {
    close();
    return fail(
        fmt::format("{}: takes images of {} bytes, not of {}", feed_.device, format.fmt.pix.sizeimage, feed_.bytes()));
  }
  return {};
}

void ImageFeeder::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

bool ImageFeeder::write(std::size_t image) {
  const ssize_t written = ::write(fd_, data_ + image * feed_.bytes(), feed_.bytes());
  if (written == static_cast<ssize_t>(feed_.bytes())) return true;
  close();
  return false;
}

}  // namespace cgsr::hil
