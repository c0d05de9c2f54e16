#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "platform/time.h"

namespace cgsr::runtime {

/// Whether the eyes keep up: at least 90 % of the last 30 images were in time. Motion is only permitted while they
/// were.
///
/// An image was in time when its frame ended within one period of its start. An image that the camera lost (a gap in
/// the sequence) was not, nor was one that did not come; an image that is both counts once. The period is the camera's: a 10 Hz video is not late. Before
/// the first 30 the answer is no.
class ImagesInTime {
 public:
  static constexpr std::size_t kWindow = 30;
  static constexpr std::size_t kNeeded = 27;

  /// \param frame_period of the camera, > 0.
  explicit ImagesInTime(Duration frame_period) : frame_period_(frame_period) {}

  /// One image was dealt with. \param sequence the camera's; a gap to the one before counts as that many lost images.
  void dealt_with(std::uint64_t sequence, MonoTime started, MonoTime finished);

  /// A frame ran without an image, because none came.
  void missed() {
    ++missed_;
    note(false);
  }

  [[nodiscard]] bool enough() const { return seen_ >= kWindow && window_.count() >= kNeeded; }

  /// \return how many of the last 30 were in time.
  [[nodiscard]] std::size_t in_time() const { return window_.count(); }

 private:
  void note(bool in_time);

  Duration frame_period_;
  std::bitset<kWindow> window_;  // bit i: the i-th last was in time
  std::size_t seen_ = 0;         // up to kWindow
  std::optional<std::uint64_t> last_sequence_;
  std::uint64_t missed_ = 0;  // since then
};

}  // namespace cgsr::runtime
