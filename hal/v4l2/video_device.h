#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "platform/time.h"

struct v4l2_buffer;  // the kernel's

namespace cgsr::hal::v4l2 {

/// What VideoDevice::wait met; several may be true.
struct Waited {
  bool image = false;
  bool event = false;
  bool error = false;  ///< the device is in an error state, or gone.
  bool woken = false;
};

/// The system calls on one video device node, so that a test can replace the kernel. Functions return 0 or an errno.
///
/// Threads: wake() from any thread, the rest from one at a time.
class VideoDevice {
 public:
  virtual ~VideoDevice() = default;

  virtual int open(const std::string& path) = 0;
  virtual void close() = 0;

  /// ioctl(2): `request` is one of VIDIOC_*, `argument` its structure.
  virtual int control(unsigned long request, void* argument) = 0;

  /// A mapping outlives close().
  virtual int map(std::size_t bytes, std::uint32_t offset, std::uint8_t*& at) = 0;
  virtual void unmap(std::uint8_t* at, std::size_t bytes) = 0;

  /// Waits until `give_up_at` on the time line of now(). \param for_images  false: for wake() alone.
  virtual Waited wait(MonoTime give_up_at, bool for_images) = 0;

  /// Ends the wait that goes on, or the next one. Never blocks, never allocates.
  virtual void wake() noexcept = 0;

  [[nodiscard]] virtual MonoTime now() const = 0;
};

/// \return one of the capture buffers that the driver has mapped, to be asked about, queued or filled.
v4l2_buffer capture_buffer(int index);

/// \return the errno in words.
std::string error_words(int error);

/// The kernel's.
std::unique_ptr<VideoDevice> make_video_device();

}  // namespace cgsr::hal::v4l2
