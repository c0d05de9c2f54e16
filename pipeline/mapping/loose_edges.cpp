#include "pipeline/mapping/loose_edges.h"

#include <algorithm>
#include <cmath>

#include "pipeline/localization/expected.h"
#include "pipeline/mapping/map_view.h"

namespace cgsr::mapping {
namespace {

bool runs_along_the_map(const localization::PerceivedEdge& edge, std::span<const localization::ProjectedPiece> pieces,
                        const geometry::Camera& camera, const ProposeParameters& p) {
  return std::any_of(pieces.begin(), pieces.end(), [&](const localization::ProjectedPiece& piece) {
    if (std::abs(piece.direction.dot(edge.normal())) > 2.0F * p.angle_rad) return false;
    const Eigen::Vector2f offset = edge.middle - piece.middle;
    const float depth = 0.5F * (piece.depth0_m + piece.depth1_m);
    const float reach = std::max(p.explained_px, static_cast<float>(camera.fx_px * p.explained_m) / depth);
    const float across = std::abs(offset.dot(Eigen::Vector2f(-piece.direction.y(), piece.direction.x())));
    return across < reach && std::abs(offset.dot(piece.direction)) < piece.half_length + edge.half_length;
  });
}

}  // namespace

std::vector<std::vector<localization::PerceivedEdge>> loose_edges(const ElasticMap& map, std::span<const View> views,
                                                                  const geometry::Camera& camera,
                                                                  const ProposeParameters& parameters,
                                                                  const RefineParameters& refined_with,
                                                                  float min_length_px) {
  MapView shown(map, camera, refined_with);
  std::vector<std::vector<localization::PerceivedEdge>> loose(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const localization::ExpectedView& expected = shown.look(views[i].X_WC);
    for (const localization::PerceivedEdge& edge : views[i].edges.edges()) {
      if (2.0F * edge.half_length < min_length_px) continue;
      if (!runs_along_the_map(edge, expected.projected(), camera, parameters)) loose[i].push_back(edge);
    }
  }
  return loose;
}

}  // namespace cgsr::mapping
