#pragma once

#include "platform/parameters.h"

namespace cgsr::render {

/// How visible edges are found with our own depth buffer. Ours; the dissertation (4.2) uses OpenGL.
struct RasterParameters {
  int width = 320;
  int height = 240;
  double near_m = 0.05;
  double sample_cells = 4.0;
  double refine_cells = 0.1;
  double tolerance = 0.0002;
  double min_piece_px = 2.0;
  double min_surface_cells = 1.0;
  int max_surfaces = 2000;
  int max_triangles = 10000;
  int max_edges = 2500;
  int max_visited = 8192;
  int max_pieces = 3000;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("width", self.width, {16, 2048}, "", "columns of the depth buffer");
    visit.number("height", self.height, {16, 2048}, "", "rows of it");
    visit.number("near_m", self.near_m, {0.001, 10.0}, "m", "what is nearer is not drawn");
    visit.number("sample_cells", self.sample_cells, {0.5, 50.0}, "", "cells between looks along an edge");
    visit.number("refine_cells", self.refine_cells, {0.01, 5.0}, "", "how sharply ends of visible pieces are found");
    visit.number("tolerance", self.tolerance, {0.0, 0.1}, "", "relative depth by which an edge may lie behind");
    visit.number("min_piece_px", self.min_piece_px, {0.0, 100.0}, "px", "shorter pieces are left out");
    visit.number("min_surface_cells", self.min_surface_cells, {0.0, 50.0}, "",
                 "surfaces that look smaller than this from end to end hide nothing");
    visit.number("max_surfaces", self.max_surfaces, {1, 10000000}, "",
                 "drawn, or parts of 64 triangles of larger ones; nearest first");
    visit.number("max_triangles", self.max_triangles, {1, 10000000}, "", "drawn at most");
    visit.number("max_edges", self.max_edges, {1, 10000000}, "", "looked at, nearest and longest first");
    visit.number("max_visited", self.max_visited, {64, 10000000}, "",
                 "surfaces or edges that may be in view and are looked at to find the largest, nearest groups first");
    visit.number("max_pieces", self.max_pieces, {16, 10000000}, "", "visible pieces of edges answered with");
  }
};

}  // namespace cgsr::render
