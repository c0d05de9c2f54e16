#pragma once

#include <cstdint>
#include <string>

#include "platform/error.h"

namespace cgsr::hil {

/// vivid's button "Inject V4L2_BUF_FLAG_ERROR": the driver flags the next image as damaged, of whichever of its ends comes first.
class FlagButton {
 public:
  explicit FlagButton(std::string device) : device_(std::move(device)) {}
  ~FlagButton() { release(); }
  FlagButton(const FlagButton&) = delete;
  FlagButton& operator=(const FlagButton&) = delete;

  /// Opens the device at the first press. \return an error when it has no such button.
  Result<void> press();

  /// Closes the device: one that is open keeps its number when the camera goes and comes back.
  void release();

 private:
  std::string device_;
  int fd_ = -1;
  std::uint32_t control_ = 0;
};

}  // namespace cgsr::hil
