#pragma once

#include "platform/parameters.h"

namespace cgsr::render {

/// How visible edges are found with our own depth buffer.
struct RasterParameters {
  int width = 320;
  int height = 240;
  double near_m = 0.05;
  double sample_cells = 4.0;
  double refine_cells = 0.1;
  double tolerance = 0.0002;
  double piece_least_px = 2.0;
  double surface_least_cells = 1.0;
  int surfaces_most = 2000;
  int triangles_most = 10000;
  int edges_most = 2500;
  int looked_at_most = 8192;
  int pieces_most = 3000;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("width", self.width, {16, 2048}, "", "columns of the depth buffer");
    visit.number("height", self.height, {16, 2048}, "", "rows of it");
    visit.number("near_m", self.near_m, {0.001, 10.0}, "m", "what is nearer is not drawn");
    visit.number("sample_cells", self.sample_cells, {0.5, 50.0}, "", "cells between looks along an edge");
    visit.number("refine_cells", self.refine_cells, {0.01, 5.0}, "", "how sharply ends of visible pieces are found");
    visit.number("tolerance", self.tolerance, {0.0, 0.1}, "", "relative depth by which an edge may lie behind");
    visit.number("piece_least_px", self.piece_least_px, {0.0, 100.0}, "px", "shorter pieces are left out");
    visit.number("surface_least_cells", self.surface_least_cells, {0.0, 50.0}, "",
                 "surfaces that look smaller than this from end to end hide nothing");
    visit.number("surfaces_most", self.surfaces_most, {1, 10000000}, "",
                 "drawn, or parts of 64 triangles of larger ones; nearest first");
    visit.number("triangles_most", self.triangles_most, {1, 10000000}, "", "drawn at most");
    visit.number("edges_most", self.edges_most, {1, 10000000}, "", "looked at, nearest and longest first");
    visit.number("looked_at_most", self.looked_at_most, {64, 10000000}, "",
                 "surfaces or edges that may be in view and are looked at to find the largest, nearest groups first");
    visit.number("pieces_most", self.pieces_most, {16, 10000000}, "", "visible pieces of edges answered with");
  }
};

}  // namespace cgsr::render
