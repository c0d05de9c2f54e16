#include "pipeline/mapping/observe.h"

#include <algorithm>
#include <cmath>

#include "pipeline/localization/expected.h"
#include "pipeline/localization/matching.h"
#include "pipeline/mapping/map_view.h"

namespace cgsr::mapping {
namespace {

constexpr float kWholeOverlap_px = 30.0F;  // a shorter overlap weighs less
constexpr float kTelling_px = 20.0F;       // a shorter piece may well go unseen
constexpr double kRivalShare = 0.3;        // of the distance to another line that it could be
constexpr std::size_t kMostPerceived = localization::SegmentTable::kBins * 20;

class Observer {
 public:
  Observer(const ElasticMap& map, const geometry::Camera& camera, const RefineParameters& parameters)
      : map_(&map),
        parameters_(&parameters),
        shown_(map, camera, parameters),
        matcher_(static_cast<std::size_t>(parameters.max_pieces), kMostPerceived) {}

  void take(std::uint32_t index, const View& view, float radius_px, Observed& observed) {
    const localization::ExpectedView& expected = shown_.look(view.X_WC);
    const auto pieces = expected.projected();
    const auto matches = matcher_.match(pieces, view.edges, {.radius_px = radius_px});
    std::vector<float> seen_px(pieces.size(), 0.0F);
    for (const localization::Match& match : matches) {
      seen_px[match.projected] += match.overlap_px();
      observed.matches.push_back(line_match(index, view, expected, match));
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const float length = 2.0F * pieces[i].half_length;
      if (length < kTelling_px) continue;
      EdgeSeen& edge = observed.edges[expected.pieces()[pieces[i].piece].edge];
      ++edge.expected;
      edge.matched += seen_px[i] > 0.3F * length ? 1 : 0;
    }
    std::vector<bool> explained(view.edges.size(), false);
    for (const localization::Match& match : matches) explained[match.perceived] = true;
    observed.explained.push_back(std::move(explained));
  }

 private:
  [[nodiscard]] double place_on(std::uint32_t edge, const Eigen::Vector3d& p) const {
    const auto& vertices = map_->map().edges[edge].vertices;
    const Eigen::Vector3d a = map_->map().vertices[vertices[0]].cast<double>();
    const Eigen::Vector3d d = map_->map().vertices[vertices[1]].cast<double>() - a;
    return std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
  }

  [[nodiscard]] LineMatch line_match(std::uint32_t index, const View& view, const localization::ExpectedView& expected,
                                     const localization::Match& match) const {
    const localization::ProjectedPiece& piece = expected.projected()[match.projected];
    const localization::PerceivedEdge& line = view.edges.edges()[match.perceived];
    LineMatch found;
    found.view = index;
    found.edge = expected.pieces()[piece.piece].edge;
    found.along = {place_on(found.edge, expected.point_at(piece, match.from_px)),
                   place_on(found.edge, expected.point_at(piece, match.to_px))};
    found.normal = line.normal().cast<double>();
    found.offset_px = found.normal.dot(line.middle.cast<double>());
    const double rival = match.rival_px < localization::Match::kNoRival ? kRivalShare * double{match.rival_px} : 0.0;
    found.sigma_px = std::hypot(double{line.sigma_px}, parameters_->line_sigma_px, rival);
    found.weight = double{line.weight} * double{piece.weight} *
                   std::clamp(double{match.overlap_px() / kWholeOverlap_px}, 0.2, 1.0);
    return found;
  }

  const ElasticMap* map_;
  const RefineParameters* parameters_;
  MapView shown_;
  localization::Matcher matcher_;
};

}  // namespace

Observed observe(const ElasticMap& map, std::span<const View> views, const geometry::Camera& camera,
                 const RefineParameters& parameters, float radius_px) {
  Observed observed;
  observed.edges.resize(map.map().edges.size());
  Observer observer(map, camera, parameters);
  for (std::size_t i = 0; i < views.size(); ++i) {
    observer.take(static_cast<std::uint32_t>(i), views[i], radius_px, observed);
  }
  return observed;
}

}  // namespace cgsr::mapping
