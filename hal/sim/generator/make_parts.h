#pragma once

#include <string>

#include "hal/sim/generator/makes.h"

namespace cgsr::sim {

/// A shape of a make, on its foot in the make's frame.
ShapeSpec make_part(ShapeKind kind, std::string part, std::string material, const Triple& foot, const Triple& size);
ShapeSpec make_box_part(std::string part, std::string material, const Triple& foot, const Triple& size);
ShapeSpec make_cylinder_part(std::string part, std::string material, const Triple& foot, double diameter,
                             double height);

/// A make that world files know as a whole.
Make make_known(ShapeKind kind, std::string name, const Triple& size, std::string material, std::string second);

}  // namespace cgsr::sim
