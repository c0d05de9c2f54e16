#pragma once

#include <cstdint>

#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/board.h"
#include "pipeline/illumination/luma_view.h"
#include "platform/parameters.h"

namespace cgsr::illumination {

/// How edges of board and cones are looked for: section [probes.registration] of a robot's file.
struct RegistrationParameters {
  double spacing_px = 10.0;
  double first_reach_px = 13.0;
  double next_reach_px = 4.0;
  double min_contrast = 5.0;
  int min_points = 24;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("spacing_px", self.spacing_px, {1.0, 100.0}, "px", "The distance between the samples along an edge.");
    visit.number("first_reach_px", self.first_reach_px, {2.0, 15.0}, "px",
                 "The search distance on either side of an edge whose position is predicted by the mount alone.");
    visit.number("next_reach_px", self.next_reach_px, {2.0, 15.0}, "px",
                 "The search distance on either side of an edge that was found in the previous image.");
    visit.number("min_contrast", self.min_contrast, {1.0, 100.0}, "grey levels",
                 "The smallest contrast of an edge that is accepted.");
    visit.number("min_points", self.min_points, {6, 400}, "",
                 "The smallest number of points on board and cones; an image with fewer gives no answer.");
  }
};

/// The camera against the board, as one image shows it: metres and radians, the board's frame B.
struct Registration {
  bool good = false;
  geometry::Pose X_BC = geometry::Pose::Identity();
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  ///< of geometry::moved(X_BC, step).
  int points = 0;                                              ///< that agree.
  int cones = 0;                                               ///< of which enough was seen: bit i is probe i.
  double rms_px = 0.0;                                         ///< of those points.
};

/// Finds the camera against the board from the board's edges, the cones' silhouettes and the fronts of their bases. The mount is the prior: used
/// alone it would cost decimetres at the lamp, since a tenth of a degree moves a shadow by a millimetre and that the lamp by two centimetres.
///
/// Gauss-Newton over six numbers; points along each expected line, each moved across it to the strongest edge nearby, and weighted down when
/// it does not agree with the rest. Nothing is allocated.
/// Control points along model edges: RAPiD (Harris and Stennett 1990). The dissertation (5.1) takes the camera's pose from its configuration.
///
/// \param start  the last image's registration; the prior stays the mount.
Registration register_board(const Board& board, const RegistrationParameters& parameters, const LumaView& image,
                            const geometry::Pose& start, bool start_is_good);

}  // namespace cgsr::illumination
