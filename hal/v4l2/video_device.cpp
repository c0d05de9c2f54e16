#include "hal/v4l2/video_device.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <system_error>

namespace cgsr::hal::v4l2 {
namespace {

class KernelVideoDevice final : public VideoDevice {
 public:
  KernelVideoDevice() : wake_fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  ~KernelVideoDevice() override {
    KernelVideoDevice::close();
    if (wake_fd_ >= 0) ::close(wake_fd_);
  }
  KernelVideoDevice(const KernelVideoDevice&) = delete;
  KernelVideoDevice& operator=(const KernelVideoDevice&) = delete;

  int open(const std::string& path) override {
    close();
    fd_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return fd_ < 0 ? errno : 0;
  }

  void close() override {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }

  int control(unsigned long request, void* argument) override {
    int outcome = 0;
    do {
      outcome = ioctl(fd_, request, argument);
    } while (outcome < 0 && errno == EINTR);
    return outcome < 0 ? errno : 0;
  }

  int map(std::size_t bytes, std::uint32_t offset, std::uint8_t*& at) override {
    void* mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, offset);
    if (mapped == MAP_FAILED) return errno;  // NOLINT(cppcoreguidelines-pro-type-cstyle-cast): the system's macro
    at = static_cast<std::uint8_t*>(mapped);
    return 0;
  }

  void unmap(std::uint8_t* at, std::size_t bytes) override { munmap(at, bytes); }

  Waited wait(MonoTime give_up_at, bool for_images) override {
    std::array<pollfd, 2> watched = {pollfd{wake_fd_, POLLIN, 0}, pollfd{fd_, POLLIN | POLLPRI, 0}};
    const nfds_t count = for_images && fd_ >= 0 ? 2 : 1;
    const Duration left = std::max(give_up_at - now(), Duration::zero());
    const timespec timeout{.tv_sec = std::min<std::int64_t>(left.count() / 1'000'000'000, 3600),
                           .tv_nsec = left.count() % 1'000'000'000};
    if (ppoll(watched.data(), count, &timeout, nullptr) <= 0) return {};
    Waited met;
    met.woken = watched[0].revents != 0;
    if (met.woken) {
      std::uint64_t counted = 0;
      (void)!::read(wake_fd_, &counted, sizeof(counted));
    }
    if (count == 2) {
      met.image = (watched[1].revents & POLLIN) != 0;
      met.event = (watched[1].revents & POLLPRI) != 0;
      met.error = (watched[1].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0;
    }
    return met;
  }

  void wake() noexcept override {
    const std::uint64_t one = 1;
    (void)!::write(wake_fd_, &one, sizeof(one));
  }

  [[nodiscard]] MonoTime now() const override {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return MonoTime{std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec)};
  }

 private:
  int wake_fd_;
  int fd_ = -1;
};

}  // namespace

v4l2_buffer capture_buffer(int index) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = static_cast<std::uint32_t>(index);
  return buffer;
}

std::string error_words(int error) {
  return std::generic_category().message(error);
}

std::unique_ptr<VideoDevice> make_video_device() {
  return std::make_unique<KernelVideoDevice>();
}

}  // namespace cgsr::hal::v4l2
