#include "hal/rmp/feedback_age.h"

#include <algorithm>
#include <limits>

namespace cgsr::hal::rmp {

bool FeedbackAge::take(MessageId id, MonoTime stamp) {
  const auto* const found = std::find(kNeeded.begin(), kNeeded.end(), id);
  if (found == kNeeded.end()) return false;
  const auto index = static_cast<std::size_t>(found - kNeeded.begin());
  stamps_[index] = stamp;
  ever_ |= 1U << index;
  this_set_ |= 1U << index;
  if (this_set_ != kWhole) return false;

  this_set_ = 0;
  if (stamp - last_set_ > most_between_sets_) sets_in_a_row_ = 0;
  if (sets_in_a_row_ < std::numeric_limits<int>::max()) ++sets_in_a_row_;
  last_set_ = stamp;
  return true;
}

std::optional<FeedbackAge::Oldest> FeedbackAge::oldest(MonoTime now) const {
  if (!complete()) return std::nullopt;
  const auto* const stamp = std::min_element(stamps_.begin(), stamps_.end());
  return Oldest{kNeeded[static_cast<std::size_t>(stamp - stamps_.begin())], now - *stamp};
}

}  // namespace cgsr::hal::rmp
