#pragma once

#include <cstdint>

#include "platform/config/sha256.h"
#include "src/sinks/decision_digest.h"
#include "src/sinks/sink.h"

namespace cgsr::sinks {

/// Sums by which two runs are compared: over what was decided, over the rows that are written, over the pixels that came.
class DigestSink final : public Sink {
 public:
  /// \param sums_pixels  whether the pixels are summed. No two live runs take the same images, and summing them takes longer than tracking in them.
  explicit DigestSink(bool sums_pixels) : sums_pixels_(sums_pixels) {}

  Result<void> on_image(const ImageReport& report) override;
  Result<void> on_switching(const SwitchRecord& record) override;

  /// Ends the sums.
  void summarize(Summary& summary) override;

 private:
  DecisionDigest decisions_;
  bool sums_pixels_;
  config::Sha256 outputs_;
  config::Sha256 inputs_;
  std::uint64_t pictures_ = 0;
};

}  // namespace cgsr::sinks
