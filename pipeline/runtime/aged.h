#pragma once

#include "platform/time.h"

namespace cgsr::runtime {

/// A stage's last output and how old it is. It never turns into the value by itself: whoever reads it says how old is too old.
template <class T>
struct Aged {
  T value{};
  MonoTime stamp{};                ///< of the frame in which it was computed. What it was computed from may be older.
  Duration age = Duration::max();  ///< from there to the present frame: zero when computed just now, max() when never.

  [[nodiscard]] bool ever() const { return age != Duration::max(); }
  [[nodiscard]] bool fresh() const { return age == Duration::zero(); }

  /// \return the value, or null when it is older than `max_age`, or there never was one.
  [[nodiscard]] const T* within(Duration max_age) const { return ever() && age <= max_age ? &value : nullptr; }
};

}  // namespace cgsr::runtime
