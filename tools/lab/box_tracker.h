#pragma once

#include <memory>
#include <optional>
#include <string>

#include "platform/box.h"
#include "platform/error.h"
#include "tools/lab/image.h"

namespace cgsr::lab {

/// The light (r, g, b) under which a tracker recognised its object, relative to what it assumed at learning.
struct Light {
  double r = 0.0;
  double g = 0.0;
  double b = 0.0;
};

struct Sighting {
  std::optional<Box> box;      ///< empty: not found
  std::optional<Light> light;  ///< empty: not found, or the tracker estimates none
};

/// Whatever learns an object from one box of one image and then says where it is. Ours and the peers behind one face, so that a
/// table treats them alike.
class BoxTracker {
 public:
  virtual ~BoxTracker() = default;

  /// Learns what lies in `box`, which is partly inside the image. \return why it refuses to.
  virtual Result<void> learn(const Image& image, const Box& box) = 0;

  /// \param image  the next of the sequence, of the size learned from. Only after learn() succeeded.
  virtual Sighting track(const Image& image) = 0;
};

}  // namespace cgsr::lab
