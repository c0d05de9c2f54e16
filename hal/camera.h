#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "platform/error.h"
#include "platform/image_lease.h"

namespace cgsr::hal {

/// What a camera agreed to deliver.
struct CameraMode {
  int width_px = 0;
  int height_px = 0;
  PixelFormat format = PixelFormat::kYuyv;
  Duration frame_period{};  ///< > 0. "Late" and "in time" are said against this period, not against 33 ms.
};

enum class CaptureFailure : std::uint8_t {
  kTimeout,  ///< no image until the deadline; trying again is fine.
  kNoSlot,   ///< every slot is on lease: the consumer is too slow. The image was lost and is counted in the sequence.
  kCorrupt,  ///< the image was flagged or could not be decoded; it has been given back.
  kDisconnected,  ///< the device is gone or not started: stop, then start again.
  kEndOfStream,   ///< a recording ended: no further image will come.
};
constexpr std::string_view to_string(CaptureFailure failure) {
  switch (failure) {
    case CaptureFailure::kTimeout:
      return "timeout";
    case CaptureFailure::kNoSlot:
      return "no free slot";
    case CaptureFailure::kCorrupt:
      return "corrupt";
    case CaptureFailure::kDisconnected:
      return "disconnected";
    case CaptureFailure::kEndOfStream:
      return "end of stream";
  }
  return "";
}

/// A camera that streams YUYV. An implementation that cannot do something says so with an error, never with a silent
/// default.
///
/// Threads: start and stop from the service thread, next_image from the capture thread only; leases end anywhere.
/// Every lease must have ended before the camera is destroyed; a lease outlives stop().
class Camera {
 public:
  virtual ~Camera() = default;

  /// Starts streaming. \return the mode that took effect, or what is wrong with the device or file. Starting twice is
  /// an error; after stop() it may be started again: sequence numbers then begin anew, stamps go on rising.
  virtual Result<CameraMode> start() = 0;

  /// Waits for the next image, never past `give_up_at`. Sequence numbers rise strictly, stamps never fall and never lie
  /// after `give_up_at`. Every image has the size that start() named.
  virtual tl::expected<ImageLease, CaptureFailure> next_image(MonoTime give_up_at) = 0;

  /// Stops streaming; a waiting next_image returns within 50 ms with kDisconnected. Idempotent.
  virtual void stop() = 0;

  /// \return the last failure of next_image in words for the log: which image, what was met, what was expected. Empty
  /// when there was none since start(). Threads: any; not for the frame path.
  [[nodiscard]] virtual std::string last_problem() const = 0;
};

}  // namespace cgsr::hal
