#include "pipeline/mapping/map_view.h"

#include <cstddef>

namespace cgsr::mapping {
namespace {

render::RasterParameters raster_of(const RefineParameters& parameters) {
  render::RasterParameters raster;
  raster.max_pieces = parameters.max_pieces;
  raster.max_edges = raster.max_surfaces = 20'000;
  raster.max_triangles = raster.max_visited = 100'000;
  return raster;
}

}  // namespace

MapView::MapView(const ElasticMap& map, const geometry::Camera& camera, const RefineParameters& parameters)
    : camera_(camera),
      raster_(map.map(), raster_of(parameters)),
      expected_(map.map(), static_cast<std::size_t>(parameters.max_pieces)) {
  visible_.reserve(static_cast<std::size_t>(parameters.max_pieces));
}

const localization::ExpectedView& MapView::look(const geometry::Pose& X_WC) {
  raster_.look(X_WC, camera_, visible_);
  expected_.take(visible_, X_WC);
  expected_.project(X_WC, camera_);
  return expected_;
}

}  // namespace cgsr::mapping
