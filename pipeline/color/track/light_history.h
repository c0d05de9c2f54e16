#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "pipeline/color/learn/light.h"
#include "platform/time.h"

namespace cgsr::color {

/// The light that most images of the last second matched: the stripe of Fig. 3.3. It is for people and reports; the tracker never
/// prefers a light it saw before (3.2.2).
class LightHistory {
 public:
  static constexpr Duration kSpan = seconds(1.0);
  static constexpr std::size_t kMostImages = 128;

  /// \param stamp  of the image; never falls. \param light  that its match was made under; nothing: not found.
  /// \return the plurality of the images within kSpan up to `stamp`, of equally frequent ones the one seen last; nothing when the object
  ///         was in none of them.
  std::optional<Light> add(MonoTime stamp, const std::optional<Light>& light);

 private:
  struct Entry {
    MonoTime stamp{};
    std::optional<Light> light;
  };
  [[nodiscard]] const Entry& recent(std::size_t age) const {
    return entries_[(next_ + kMostImages - 1 - age) % kMostImages];
  }

  std::array<Entry, kMostImages> entries_;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace cgsr::color
