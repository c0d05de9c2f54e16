#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "hal/camera.h"
#include "hal/replay/slot_pool.h"
#include "platform/clock.h"

namespace cgsr::hal {

struct RampCameraParameters {
  int width_px = 640;
  int height_px = 480;
  double rate_hz = 30.0;
};

/// A camera without hardware: a grey ramp that moves one pixel per image. An example of a driver (docs/guides/write-a-driver.md).
///
/// Threads: as Camera.
class RampCamera final : public Camera {
 public:
  /// \param clock  outlives the camera.
  RampCamera(Clock& clock, const RampCameraParameters& parameters) : clock_(clock), parameters_(parameters) {}

  Result<CameraMode> start() override;
  tl::expected<ImageLease, CaptureFailure> next_image(MonoTime give_up_at) override;
  void stop() override { running_ = false; }
  [[nodiscard]] std::string last_problem() const override;

 private:
  [[nodiscard]] Duration period() const { return seconds(1.0 / parameters_.rate_hz); }
  bool wait_until(MonoTime end);
  void paint(std::uint8_t* pixels, std::uint64_t sequence) const;

  Clock& clock_;
  RampCameraParameters parameters_;
  SlotPool pool_;
  std::atomic<bool> running_{false};
  MonoTime due_{};  // stamp of the next image
  std::uint64_t sequence_ = 0;
  mutable std::mutex problem_mutex_;
  std::string problem_;
};

}  // namespace cgsr::hal
