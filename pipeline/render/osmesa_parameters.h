#pragma once

#include "platform/parameters.h"

namespace cgsr::render {

/// How visible edges are found with OpenGL (4.2).
struct OsmesaParameters {
  int width = 640;
  int height = 480;
  double near_m = 0.05;
  double min_gap_px = 2.5;
  double min_piece_px = 2.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("width", self.width, {16, 4096}, "", "columns of what OpenGL draws into");
    visit.number("height", self.height, {16, 4096}, "", "rows of it");
    visit.number("near_m", self.near_m, {0.001, 10.0}, "m", "what is nearer is not drawn");
    visit.number("min_gap_px", self.min_gap_px, {0.0, 50.0}, "px", "shorter gaps are closed: lines that cross");
    visit.number("min_piece_px", self.min_piece_px, {0.0, 100.0}, "px", "shorter pieces are left out");
  }
};

}  // namespace cgsr::render
