#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/camera.h"
#include "hal/replay/image_source.h"
#include "hal/replay/slot_pool.h"
#include "platform/clock.h"
#include "platform/parameters.h"

namespace cgsr::hal {

enum class ReplayPace : std::uint8_t { kAsFastAsPossible, kOwnRate };
inline constexpr Named<ReplayPace> kReplayPaceNames[] = {{"as_fast_as_possible", ReplayPace::kAsFastAsPossible},
                                                         {"own_rate", ReplayPace::kOwnRate}};
constexpr std::string_view to_string(ReplayPace pace) {
  return word_in(kReplayPaceNames, pace);
}

struct ReplayParameters {
  std::string path;
  ReplayPace pace = ReplayPace::kAsFastAsPossible;
  int width_px = 0;
  int height_px = 0;
  double rate_hz = 0.0;
  int first = 0;
  int count = 0;
  bool loop = false;
  int slots = 6;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.path("path", self.path,
               "The video file, image file or folder of images to replay; a folder is read in the order of its names.");
    visit.choice("pace", self.pace, kReplayPaceNames,
                 "With own_rate an image is delivered when its time has come; with as_fast_as_possible it is delivered "
                 "at once.");
    visit.number("width_px", self.width_px, {0, kLongestSide_px}, "px",
                 "Images are scaled to this even width; 0 keeps the stored width.");
    visit.number("height_px", self.height_px, {0, kLongestSide_px}, "px",
                 "Images are scaled to this height; 0 keeps the stored height.");
    visit.number("rate_hz", self.rate_hz, {0.0, 500.0}, "Hz",
                 "The number of images per second; 0 takes the video's own rate, and 30 Hz for image files.");
    visit.number("first", self.first, {0, 1'000'000'000}, "1",
                 "The index of the first image to replay, counted from 0.");
    visit.number("count", self.count, {0, 1'000'000'000}, "1",
                 "The number of images to replay; 0 replays all of them.");
    visit.flag("loop", self.loop, "The replay starts again from the first image when it has reached the last one.");
    visit.number("slots", self.slots, {1, SlotPool::kMostSlots}, "1",
                 "The number of images that can be on lease at the same time.");
  }
};

/// Videos and images as a camera: YUYV (bgr_to_yuyv.h), the size of the first image that decodes, an odd last column dropped.
///
/// The stamp of image i is that of image 0 plus i periods, whatever the file says about single images.
/// As fast as possible: stamps are the time and begin at 0. An image is there at once, unless its stamp lies after the
/// deadline (kTimeout: ask with a later one). With all slots on lease it waits, in host time, for as long as the deadline
/// lies after the stamp: nothing is lost.
/// At its own rate: image 0 is due at start(), on the clock. Like a driver it holds as many overdue images as it has slots;
/// who asks later than that has lost the oldest, and an image that finds no free slot is lost (kNoSlot). A lost image is a
/// gap in the sequence. On a simulated clock a wait ends when the clock moves or ends.
///
/// An image that is damaged, unreadable or of another size than the first is refused (kCorrupt, counted in the sequence) and
/// the next one follows. kDisconnected: with `loop`, a whole round brought no image.
///
/// Decoding runs in next_image and allocates (libraries); it is no camera for real-time guarantees.
class ReplayCamera final : public Camera {
 public:
  /// \param clock  needed for kOwnRate only; outlives the camera.
  explicit ReplayCamera(ReplayParameters parameters, Clock* clock = nullptr);

  /// Opens the file and decodes up to the first good image. The error names the file and what was met.
  Result<CameraMode> start() override;
  tl::expected<ImageLease, CaptureFailure> next_image(MonoTime give_up_at) override;
  void stop() override;
  [[nodiscard]] std::string last_problem() const override;

  /// \return what the person who started this should know: defaults taken, columns dropped, odd orders. After start().
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  enum class Staged : std::uint8_t { kNothing, kImage, kRefused, kEnd };
  enum class Pixels : std::uint8_t { kWanted, kUnwanted };

  Result<CameraMode> open();
  Result<void> check_parameters() const;
  Result<void> find_mode();
  Result<Duration> frame_period();
  Result<void> rewind_to_first();
  void stage(Pixels pixels);
  Staged read_next(Pixels pixels);
  bool size_is_right();
  void skip_overdue();
  [[nodiscard]] MonoTime stamp() const { return origin_ + static_cast<std::int64_t>(sequence_) * mode_.frame_period; }
  tl::expected<void, CaptureFailure> wait_until_due(MonoTime give_up_at);
  tl::expected<int, CaptureFailure> wait_for_slot(MonoTime give_up_at);
  ImageLease lend(int slot);
  void pass_over();
  void remember(std::string problem);

  const ReplayParameters parameters_;
  Clock* const clock_;

  std::mutex stream_mutex_;  // start() and next_image() exclude each other; stop() only clears running_
  std::atomic<bool> running_{false};
  std::unique_ptr<ImageSource> source_;
  CameraMode mode_;
  SlotPool pool_;
  std::vector<std::string> notes_;

  MonoTime origin_{};           // stamp of sequence number 0
  std::uint64_t sequence_ = 0;  // of the image that is staged or comes next
  int taken_ = 0;               // images of this round, counted against `count`
  bool good_this_round_ = false;
  Staged staged_ = Staged::kNothing;
  cv::Size stored_size_;  // of every image in the file, before scaling
  cv::Mat bgr_;
  cv::Mat scaled_;

  mutable std::mutex problem_mutex_;
  std::string problem_;
};

}  // namespace cgsr::hal
