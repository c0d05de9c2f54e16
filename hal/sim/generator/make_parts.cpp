#include "hal/sim/generator/make_parts.h"

#include <utility>

namespace cgsr::sim {

ShapeSpec make_part(ShapeKind kind, std::string part, std::string material, const Triple& foot, const Triple& size) {
  ShapeSpec spec;
  spec.kind = kind;
  spec.name = std::move(part);
  spec.material = std::move(material);
  spec.position_m = {rounded(foot[0]), rounded(foot[1]), rounded(foot[2])};
  spec.size_m = {rounded(size[0]), rounded(size[1]), rounded(size[2])};
  return spec;
}

ShapeSpec make_box_part(std::string part, std::string material, const Triple& foot, const Triple& size) {
  return make_part(ShapeKind::kBox, std::move(part), std::move(material), foot, size);
}

ShapeSpec make_cylinder_part(std::string part, std::string material, const Triple& foot, double diameter,
                             double height) {
  return make_part(ShapeKind::kCylinder, std::move(part), std::move(material), foot, {diameter, diameter, height});
}

Make make_known(ShapeKind kind, std::string name, const Triple& size, std::string material, std::string second) {
  Make make{std::move(name), size, {}, true, false};
  make.shapes.push_back(make_part(kind, "", std::move(material), {0, 0, 0}, size));
  make.shapes.back().second_material = std::move(second);
  return make;
}

}  // namespace cgsr::sim
