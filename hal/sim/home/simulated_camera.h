#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hal/camera.h"
#include "hal/sim/home/scenario.h"
#include "hal/sim/render/sensor.h"

namespace cgsr::sim {

/// A camera of the simulated home: images at whole periods from 0 on, and what the script does to them.
///
///   dropped   never comes; the sequence shows the gap
///   frozen    comes with the last image's pixels
///   corrupt   kCorrupt
///   late      comes `late_s` after its time; what falls due meanwhile is lost
///   gone      kDisconnected, and start() fails, until it is back
///
/// It never waits: an image that is not there by `give_up_at` is a timeout at once. Image n is there at its stamp plus
/// the delay. A lease outlives stop(), not the camera.
class SimulatedCamera final : public hal::Camera, private ImageLender {
 public:
  /// Draws the image that is exposed from `stamp` on. \param number  counts images from 0, whatever became of them.
  using Draw = std::function<void(std::uint64_t number, MonoTime stamp, const YuyvBuffer& buffer)>;
  /// What time it is in the simulated world.
  using Now = std::function<MonoTime()>;

  /// \param end  no image is exposed from then on: the stream ends.
  SimulatedCamera(const hal::CameraMode& mode, Duration delay, MonoTime end, std::vector<CameraEventSpec> script,
                  Draw draw, Now now);

  Result<hal::CameraMode> start() override;
  tl::expected<ImageLease, hal::CaptureFailure> next_image(MonoTime give_up_at) override;
  void stop() override { started_.store(false); }
  [[nodiscard]] std::string last_problem() const override { return problem_; }

 private:
  static constexpr int kSlots = 8;

  [[nodiscard]] const CameraEventSpec* happening(CameraTrouble what, MonoTime at) const;
  [[nodiscard]] MonoTime stamp_of(std::uint64_t number) const {
    return MonoTime{mode_.frame_period * static_cast<std::int64_t>(number)};
  }
  tl::expected<ImageLease, hal::CaptureFailure> failure(hal::CaptureFailure failure, std::string words);
  tl::expected<ImageLease, hal::CaptureFailure> take(std::uint64_t number);
  void give_back(int slot) noexcept override;

  hal::CameraMode mode_;
  Duration delay_;
  MonoTime end_;
  std::vector<CameraEventSpec> script_;
  Draw draw_;
  Now now_;
  std::vector<std::vector<std::uint8_t>> pixels_;  // [slot]
  std::vector<std::uint8_t> last_pixels_;          // kept only for a script that freezes
  bool freezes_ = false;
  std::atomic<std::uint32_t> free_{(1U << kSlots) - 1};  // bit i: slot i is free
  std::atomic<bool> started_{false};
  std::uint64_t next_ = 0;   // number of the next image
  std::uint64_t first_ = 0;  // number of the image whose sequence is 0
  std::string problem_;
};

}  // namespace cgsr::sim
