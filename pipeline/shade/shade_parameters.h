#pragma once

#include "platform/parameters.h"

namespace cgsr::shade {

/// How shaded regions are found (5.2).
struct ShadeParameters {
  int width = 160;
  int height = 120;
  int finer = 2;
  int lamp_cells = 384;
  double near_m = 0.05;
  double margin = 1e-5;
  double lift = 1e-3;
  int max_surfaces = 4000;
  int max_edges = 4000;
  double sigmas = 1.5;
  double ball_sigmas = 2.0;
  double map_sigma_m = 0.005;
  int max_widening_cells = 7;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("width", self.width, {16, 1024}, "", "The number of columns of the masks.");
    visit.number("height", self.height, {16, 1024}, "", "The number of rows of the masks.");
    visit.number("finer", self.finer, {1, 8}, "", "The number of depth-buffer cells along each side of a mask cell.");
    visit.number("lamp_cells", self.lamp_cells, {32, 2048}, "",
                 "The number of cells along each side of the six views from the lamp.");
    visit.number("near_m", self.near_m, {0.001, 10.0}, "m",
                 "The distance of the near plane; surfaces nearer to the camera or the lamp are not drawn.");
    visit.number("margin", self.margin, {0.0, 0.01}, "",
                 "The distance behind a surface at which its shadow begins, as a ratio of the distance.");
    visit.number("lift", self.lift, {0.0, 0.1}, "",
                 "Shadow volumes flatter than this ratio of the distance are ignored.");
    visit.number("max_surfaces", self.max_surfaces, {1, 10000000}, "",
                 "The largest number of surfaces drawn from the camera, and from the lamp.");
    visit.number("max_edges", self.max_edges, {1, 10000000}, "",
                 "The largest number of silhouette edges whose shadow volumes are drawn.");
    visit.number("sigmas", self.sigmas, {0.0, 10.0}, "",
                 "The number of standard deviations of pose, lamp and map by which the mask of possibly shaded cells "
                 "is widened.");
    visit.number("ball_sigmas", self.ball_sigmas, {0.0, 10.0}, "",
                 "The number of those standard deviations by which a ball's place may be off when it is asked whether "
                 "the ball may lie in shade.");
    visit.number("map_sigma_m", self.map_sigma_m, {0.0, 0.5}, "m",
                 "The standard deviation of the map's corners in every direction.");
    visit.number("max_widening_cells", self.max_widening_cells, {0, 7}, "",
                 "The largest number of cells by which the mask is widened.");
  }
};

}  // namespace cgsr::shade
