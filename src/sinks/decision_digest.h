#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "pipeline/stages/frame_result.h"
#include "pipeline/stages/switchboard.h"
#include "platform/config/sha256.h"

namespace cgsr::sinks {

/// SHA-256 over what a run decided, in a fixed binary order that knows no names: per image its sequence number, whether the object was found
/// and its box [px], the pose X_WC and its state, the lamp's position [m], the state of the shadow masks, and the motion goal [m/s, rad/s];
/// and every request to switch a lamp. Numbers enter as the bytes of their IEEE doubles or 64-bit integers, little endian.
///
/// Two runs with the same digest decided the same, whatever their files, columns and messages look like. Times of computing do not enter.
class DecisionDigest {
 public:
  /// One image with what was decided about it, in the order of the images.
  void add_image(std::uint64_t image_sequence, const stages::FrameResult& frame);
  /// One switching, in the order of the requests.
  void add_request(const stages::SwitchRequest& request);

  /// \return 64 lower-case hexadecimal digits. Ends the sum: nothing may be added afterwards.
  std::string hex();

 private:
  static void add(config::Sha256& sum, double value);
  static void add(config::Sha256& sum, std::uint64_t value);

  config::Sha256 images_;
  config::Sha256 requests_;
};

}  // namespace cgsr::sinks
