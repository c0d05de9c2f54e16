#include "tests/hil/flag_button.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

namespace cgsr::hil {
namespace {

/// \return the control of that name, or 0.
std::uint32_t find_control(int fd, std::string_view name) {
  v4l2_queryctrl query{};
  query.id = V4L2_CTRL_FLAG_NEXT_CTRL;
  while (ioctl(fd, VIDIOC_QUERYCTRL, &query) == 0) {
    // The kernel's name is shorter than the control's, and ends with a zero.
    if (name.starts_with(reinterpret_cast<const char*>(query.name))) return query.id;
    query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  return 0;
}

}  // namespace

void FlagButton::release() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
  control_ = 0;
}

Result<void> FlagButton::press() {
  if (fd_ < 0) fd_ = ::open(device_.c_str(), O_RDWR | O_CLOEXEC);
  if (fd_ < 0) return fail(fmt::format("{}: {}", device_, std::strerror(errno)));
  if (control_ == 0) control_ = find_control(fd_, "Inject V4L2_BUF_FLAG_ERROR");
  v4l2_control press{control_, 1};
  if (control_ == 0 || ioctl(fd_, VIDIOC_S_CTRL, &press) != 0) {
    const int error = errno;
    release();
    return fail(fmt::format("{}: the button that flags images cannot be pressed: {}", device_, std::strerror(error)));
  }
  return {};
}

}  // namespace cgsr::hil
