#pragma once

#include "hal/sim/generator/site.h"

namespace cgsr::sim {

/// How much was put into a home.
struct Furnished {
  int furniture = 0;
  int pictures = 0;
  int clutter = 0;  ///< what no map knows.
};

/// Furniture by the kind of each room, pictures on bare walls, and clutter on the floor and on top of things.
Furnished furnish(Site& site, Draw& draw);

}  // namespace cgsr::sim
