#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/rmp/messages.h"
#include "platform/time.h"

namespace cgsr::hal::rmp {

/// How old what the drive needs of the base is, message by message, and for how long it has come whole.
///
/// The base sends a set of messages every 10 ms, in no order to rely on: a set is whole once every needed message has
/// come since the last whole one.
class FeedbackAge {
 public:
  /// Odometry, attitude, mode and status words: without any of these the robot must not be driven.
  static constexpr std::array kNeeded = {MessageId::kAttitude, MessageId::kMotion, MessageId::kIntegrated,
                                         MessageId::kModeAndPower, MessageId::kStatus};

  struct Oldest {
    MessageId id = MessageId::kAttitude;
    Duration age{};
  };

  /// \param most_between_sets  a longer way from one whole set to the next breaks the series, > 0.
  explicit FeedbackAge(Duration most_between_sets) : most_between_sets_(most_between_sets) {}

  /// A message came. Those that are not needed change nothing. \return whether it made a set whole.
  bool take(MessageId id, MonoTime stamp);

  /// Whole sets in a row since the start, the last gap or break_series().
  [[nodiscard]] int sets_in_a_row() const { return sets_in_a_row_; }
  void break_series() { sets_in_a_row_ = 0; }

  /// \return whether every needed message has come at least once.
  [[nodiscard]] bool complete() const { return ever_ == kWhole; }

  /// \return the needed message that is oldest at `now`; nothing while not complete.
  [[nodiscard]] std::optional<Oldest> oldest(MonoTime now) const;

 private:
  static constexpr unsigned kWhole = (1U << kNeeded.size()) - 1;

  Duration most_between_sets_;
  std::array<MonoTime, kNeeded.size()> stamps_{};
  unsigned ever_ = 0;      // a bit for each needed message
  unsigned this_set_ = 0;  // likewise
  MonoTime last_set_{};
  int sets_in_a_row_ = 0;
};

}  // namespace cgsr::hal::rmp
