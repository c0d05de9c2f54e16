#pragma once

#include <memory>
#include <optional>
#include <string>

#include "pipeline/color/learn/light.h"
#include "platform/box.h"
#include "platform/error.h"
#include "tools/lab/image.h"

namespace cgsr::lab {

/// Of a scene, per channel, relative to what Alg. 3.1 assumed at learning.
using Light = color::Light;

struct Sighting {
  std::optional<Box> box;      ///< empty: not found
  std::optional<Light> light;  ///< of the grid, under which the object was recognised; empty: not found, or no estimate
  std::optional<Light> exact_light;  ///< the same between the grid's lights
  double divergence = 0.0;           ///< [nat] of the box from what was learned; 0 where the tracker knows none
  double confidence =
      0.0;  ///< that the box is right, 0..1; of a tracker that gives none: 1 where it found something, else 0
};

/// What a tracker says about the object when it has learned it.
struct LearnedObject {
  std::optional<Light> light;             ///< that it assumed on the image learned from; empty: it assumes none
  std::optional<double> distinctiveness;  ///< [nat], as learn prints it; empty: it measures none
};

/// Whatever learns an object from one box of one image and then says where it is. Ours and the peers behind one face, so that a
/// table treats them alike.
class BoxTracker {
 public:
  virtual ~BoxTracker() = default;

  /// Learns what lies in `box`, which is partly inside the image. \return why it refuses to.
  virtual Result<LearnedObject> learn(const Image& image, const Box& box) = 0;

  /// \param image  the next of the sequence, of the size learned from. Only after learn() succeeded.
  virtual Sighting track(const Image& image) = 0;
};

}  // namespace cgsr::lab
