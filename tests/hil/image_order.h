#pragma once

#include <cstddef>
#include <optional>

namespace cgsr::hil {

/// Which image is written into the camera's other end in each of its periods: the first one until they play, then each once, then the last one.
class ImageOrder {
 public:
  /// \param images  how many there are, at least 1.
  explicit ImageOrder(std::size_t images) : images_(images) {}

  /// What the control folder says at the moment.
  struct Wanted {
    bool plays = false;
    bool still = false;  ///< nothing is written: the camera shows again what it has.
  };

  /// \return the number of the image, from 0; nothing: none is written.
  [[nodiscard]] std::optional<std::size_t> next(Wanted wanted) const {
    if (wanted.still) return std::nullopt;
    if (plays_on(wanted)) return played_;
    return played_ == 0 ? 0 : played_ - 1;
  }

  /// The image that next() named was written.
  void written(Wanted wanted) {
    if (plays_on(wanted) && !wanted.still) ++played_;
  }

  /// Whether the images have not all been played and the next one is due.
  [[nodiscard]] bool plays_on(Wanted wanted) const { return wanted.plays && played_ < images_; }

  [[nodiscard]] std::size_t played() const { return played_; }

 private:
  std::size_t images_;
  std::size_t played_ = 0;
};

}  // namespace cgsr::hil
