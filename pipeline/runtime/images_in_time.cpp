#include "pipeline/runtime/images_in_time.h"

#include <algorithm>

namespace cgsr::runtime {

void ImagesInTime::dealt_with(std::uint64_t sequence, MonoTime started, MonoTime finished) {
  if (last_sequence_ && sequence > *last_sequence_) {
    // Those that were missed are noted already. More than a window of losses says no more than a window does.
    const std::uint64_t gap = sequence - *last_sequence_ - 1;
    const auto lost = std::min<std::uint64_t>(gap - std::min(gap, missed_), kWindow);
    for (std::uint64_t i = 0; i < lost; ++i) note(false);
  }
  last_sequence_ = sequence;
  missed_ = 0;
  note(finished - started <= frame_period_);
}

void ImagesInTime::note(bool in_time) {
  window_ <<= 1;
  window_[0] = in_time;
  seen_ = std::min(seen_ + 1, kWindow);
}

}  // namespace cgsr::runtime
