#pragma once

#include "hal/sim/scene/mesh.h"

namespace cgsr::sim {

/// Primitive shapes. All lengths in metres; surface coordinates are metres along the surface, so that a pattern keeps its size.
/// Curved ones are cut finely enough that the chord stays within 0.03 mm of a 10 cm ball and 2 um of a probe cone.

/// A flat rectangle about the origin in the xy plane, facing +z.
Mesh make_rectangle(double width_m, double depth_m);

/// A box about the origin: six rectangles facing outward. A side of zero length leaves out nothing: it is an error of the caller.
Mesh make_box(const Eigen::Vector3d& size_m);

/// A cylinder along z, standing on the xy plane, with both caps.
Mesh make_cylinder(double radius_m, double height_m);

/// A cone along z, standing on the xy plane with its apex at (0, 0, height), base included; `top_radius_m` > 0 cuts the tip off.
Mesh make_cone(double base_radius_m, double height_m, double top_radius_m = 0.0);

/// A ball about the origin.
Mesh make_sphere(double radius_m);

/// An ellipsoid about the origin with the given semi-axes.
Mesh make_ellipsoid(const Eigen::Vector3d& semi_axes_m, int around = 48, int along = 24);

/// A flat disc about the origin facing +z.
Mesh make_disc(double radius_m);

/// Joins corners that were laid down as a grid of (rows + 1) x (columns + 1), row by row upwards and counter-clockwise seen from above,
/// to a curved surface; each quad is one polygon.
void connect_grid(Mesh& mesh, int rows, int columns);

/// A tube of varying elliptic section along z, closed at both ends: limbs and torsos. Stations rise in z.
struct Station {
  double z_m;
  double half_width_m;  ///< along y.
  double half_depth_m;  ///< along x.
  double centre_x_m = 0.0;
};
Mesh make_lofted(const std::vector<Station>& stations, int around = 32);

}  // namespace cgsr::sim
