#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "platform/time.h"

namespace cgsr {

/// Which of a stream of messages are worth a line of the log: the first, a changed one at most every `min_gap`, and the
/// same again every `repeat_after` for as long as it is offered.
///
/// Threads: one. Allocates.
class MessageRate {
 public:
  /// \param repeat_after  nothing: the same message is never repeated.
  explicit MessageRate(Duration min_gap, std::optional<Duration> repeat_after = std::nullopt)
      : min_gap_(min_gap), repeat_after_(repeat_after) {}

  /// \param text  the state of things; empty when there is nothing to say. \return whether to log it at `now`.
  bool take(std::string_view text, MonoTime now) {
    if (text.empty()) return false;
    if (logged_at_) {
      const Duration since = now - *logged_at_;
      const bool due = text == last_ ? repeat_after_ && since >= *repeat_after_ : since >= min_gap_;
      if (!due) return false;
    }
    last_ = text;
    logged_at_ = now;
    return true;
  }

 private:
  Duration min_gap_;
  std::optional<Duration> repeat_after_;
  std::optional<MonoTime> logged_at_;
  std::string last_;
};

}  // namespace cgsr
