#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>

#include "hal/simulation.h"
#include "pipeline/vision_loop.h"

namespace cgsr::robot {

/// What chapter 5's stages came to in a run. Errors by what was really there; the vision never sees that.
struct LightFigures {
  std::uint64_t looks = 0;                               ///< images whose probes were looked at.
  std::map<std::string_view, std::uint64_t> unanswered;  ///< of these, by why they told nothing of a lamp.
  std::uint64_t known = 0;                               ///< images in which a lamp was known.
  std::uint64_t masked = 0;                              ///< images with masks.
  std::optional<illumination::KnownLamp> last;           ///< the last lamp that was known.

  std::uint64_t compared = 0;  ///< images in which a lamp was known and one burnt.
  double mean_m = 0.0;         ///< of its error.
  double worst_m = 0.0;
  double last_m = 0.0;
};

/// Adds up the figures, image by image.
class LightTally {
 public:
  void add(const Decision& decision, const std::optional<hal::ImageTruth>& truth);

  [[nodiscard]] const LightFigures& figures() const { return figures_; }

 private:
  LightFigures figures_;
};

}  // namespace cgsr::robot
