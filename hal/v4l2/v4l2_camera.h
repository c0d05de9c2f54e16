#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hal/camera.h"
#include "hal/v4l2/controls.h"
#include "hal/v4l2/image_slots.h"
#include "hal/v4l2/jpeg_to_yuyv.h"
#include "hal/v4l2/parameters.h"
#include "hal/v4l2/video_device.h"

namespace cgsr::hal::v4l2 {

/// Finds the node of the wanted camera. \return its path, or nothing while it is not plugged in.
using LocateCamera = std::function<std::optional<std::string>(const std::string& wanted)>;

/// Counts since start(); none of them ever falls.
struct V4l2Counters {
  std::uint64_t images = 0;
  std::uint64_t lost = 0;      ///< gaps in the driver's sequence.
  std::uint64_t flagged = 0;   ///< delivered damaged: queued again, and answered as kCorrupt.
  std::uint64_t restarts = 0;  ///< of the stream: it stalled, or the driver asked for it.
  std::uint64_t returns = 0;   ///< times that the camera was gone and came back.
};

/// A camera at a video device, streaming into buffers that the driver shares with the program.
///
/// YUYV is lent where the driver put it, without a copy. MJPEG is decoded into buffers of the program, in next_image.
/// Stamps are of the start of the exposure: the driver's, when it stamps that; else its stamp of the end of the image
/// less end_of_frame_offset_s; else (a driver without a monotonic clock) the moment of the reading less the same.
///
/// A camera that stalls is started again. One that is unplugged is looked for, and when it is back all its settings are
/// applied again; meanwhile next_image answers kTimeout and last_problem() says since when. It is kDisconnected only
/// when it is not started.
///
/// Nothing allocates between start() and a fault, MJPEG's first image apart.
class V4l2Camera final : public Camera {
 public:
  /// \param device  not null; make_video_device() for the kernel's. \param locate  find_camera() for udev's.
  V4l2Camera(V4l2Parameters parameters, std::unique_ptr<VideoDevice> device, LocateCamera locate);
  ~V4l2Camera() override;
  V4l2Camera(const V4l2Camera&) = delete;
  V4l2Camera& operator=(const V4l2Camera&) = delete;

  Result<CameraMode> start() override;
  tl::expected<ImageLease, CaptureFailure> next_image(MonoTime give_up_at) override;
  void stop() override;
  [[nodiscard]] std::string last_problem() const override;

  /// \return what the camera refused and what was assumed, one sentence each. After start().
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// Threads: that of next_image.
  [[nodiscard]] const V4l2Counters& counters() const { return counters_; }

 private:
  struct Mapping {
    std::uint8_t* at = nullptr;
    std::size_t bytes = 0;
  };
  /// The buffers of one opening of the device. It lives until their last lease has ended.
  struct Buffers {
    explicit Buffers(VideoDevice& owner) : device(owner), slots([&owner] { owner.wake(); }) {}
    ~Buffers();
    Buffers(const Buffers&) = delete;
    Buffers& operator=(const Buffers&) = delete;

    VideoDevice& device;
    ImageSlots slots;
    std::vector<Mapping> mapped;                     ///< the driver's.
    std::vector<std::vector<std::uint8_t>> decoded;  ///< the program's, for MJPEG.
    std::uint32_t free_decoded = 0;
  };
  /// A buffer that the driver handed over.
  struct Filled {
    int index = 0;
    std::uint32_t sequence = 0;
    std::size_t bytes = 0;
    MonoTime stamp{};
    bool flagged = false;
    bool on_lease = false;  ///< it was not queued: a reader has it.
  };

  Result<CameraMode> open_device();
  Result<CameraMode> set_up(const std::string& path);
  Result<CameraMode> set_format();
  Result<Duration> set_rate();
  Result<void> make_buffers();
  Result<void> stream_on();
  void stream_off();
  void close_device();
  void unmap_what_came_back();

  tl::expected<ImageLease, CaptureFailure> take_image(MonoTime give_up_at);
  std::optional<tl::expected<ImageLease, CaptureFailure>> look(MonoTime give_up_at);
  int dequeue(Filled& filled);
  tl::expected<ImageLease, CaptureFailure> deliver(const Filled& filled);
  tl::expected<ImageLease, CaptureFailure> decode(const Filled& filled, std::uint64_t sequence, MonoTime stamp);
  void queue_returned();
  int queue(int index);
  [[nodiscard]] MonoTime stamp_of(std::uint32_t flags, MonoTime driver_stamp);
  std::uint64_t count_sequence(std::uint32_t driver_sequence);
  void restart_stream(const std::string& why);
  [[nodiscard]] bool format_stands();
  void lose(const std::string& why);
  void look_for_it(MonoTime give_up_at);
  void check_controls();
  void remember(std::string problem);
  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::string without_name(const std::string& message) const;
  [[nodiscard]] const char* user() const;

  const V4l2Parameters parameters_;
  const std::unique_ptr<VideoDevice> device_;
  const LocateCamera locate_;

  std::mutex stream_mutex_;  // start() and next_image() exclude each other; stop() clears running_ before it takes it
  std::atomic<bool> running_{false};
  CameraMode mode_;
  std::ptrdiff_t stride_bytes_ = 0;
  std::size_t image_bytes_ = 0;
  std::vector<ControlWish> wishes_;
  std::vector<std::string> notes_;
  V4l2Counters counters_;
  std::unique_ptr<Buffers> buffers_;               // null: the device is gone
  std::vector<std::unique_ptr<Buffers>> retired_;  // on lease yet
  int queued_ = 0;
  JpegToYuyv jpeg_;

  bool fresh_stream_ = true;  ///< the next image is the first since STREAMON.
  std::uint32_t driver_sequence_ = 0;
  std::uint64_t next_sequence_ = 0;
  MonoTime last_stamp_{MonoTime::min()};
  MonoTime alive_at_{};  ///< of the last sign of life of the stream.
  MonoTime look_at_{};   ///< when a camera that is gone is looked for next.
  MonoTime gone_since_{};
  int images_since_open_ = 0;
  int restarts_in_a_row_ = 0;
  bool stamps_noted_ = false;

  mutable std::mutex problem_mutex_;
  std::string problem_;
};

}  // namespace cgsr::hal::v4l2
