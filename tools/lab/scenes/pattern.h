#pragma once

#include <cstdint>
#include <vector>

#include "tools/lab/scenes/color.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

/// What the object looks like: a print of 9 to 20 patches in three to five colours of clearly different hue, each patch with a grain of
/// its own, on the unit square.
class Pattern {
 public:
  explicit Pattern(Random random);

  /// \param u, v  in [0, 1). \return the texture's colour, no channel above 1.
  [[nodiscard]] Rgb at(double u, double v) const;

  /// The colours before the grain.
  [[nodiscard]] const std::vector<Rgb>& palette() const { return palette_; }

 private:
  struct Patch {
    double u;
    double v;
    int color;
    double grain;  ///< amplitude
    std::uint64_t seed;
  };
  std::vector<Rgb> palette_;
  std::vector<Patch> patches_;
};

}  // namespace cgsr::lab
