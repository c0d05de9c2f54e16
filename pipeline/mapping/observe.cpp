#include "pipeline/mapping/observe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "pipeline/localization/expected.h"
#include "pipeline/localization/matching.h"
#include "pipeline/mapping/map_view.h"

namespace cgsr::mapping {
namespace {

constexpr float kWholeOverlap_px = 30.0F;  // a shorter overlap weighs less
constexpr float kTelling_px = 20.0F;       // a shorter piece may well go unseen
constexpr double kRivalShare = 0.3;        // of the distance to another line that it could be
constexpr std::size_t kMostPerceived = localization::SegmentTable::kBins * 20;

constexpr float kBorder_px = 3.0F;  // nearer to the image's border a line is cut off by it

constexpr std::array<float, 2> kSide{-1.0F, 1.0F};  // of a piece's middle, on which an end of it lies

class Observer {
 public:
  Observer(const ElasticMap& map, const geometry::Camera& camera, const RefineParameters& parameters)
      : map_(&map),
        parameters_(&parameters),
        camera_(camera),
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
    take_ends(index, view, expected, radius_px, matches, observed);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const float length = 2.0F * pieces[i].half_length;
      if (length < kTelling_px) continue;
      EdgeSeen& edge = observed.edges[expected.pieces()[pieces[i].piece].edge];
      ++edge.expected;
      edge.matched += seen_px[i] > 0.3F * length ? 1 : 0;
    }
    observed.edge_at.push_back(edges_at(view, expected, matches));
  }

 private:
  /// Of each perceived edge the map's edge that it was matched with, the nearest.
  static std::vector<std::int64_t> edges_at(const View& view, const localization::ExpectedView& expected,
                                            std::span<const localization::Match> matches) {
    std::vector<std::int64_t> edge_at(view.edges.size(), -1);
    std::vector<float> off_px(view.edges.size(), std::numeric_limits<float>::infinity());
    for (const localization::Match& match : matches) {
      const localization::ProjectedPiece& piece = expected.projected()[match.projected];
      const localization::PerceivedEdge& line = view.edges.edges()[match.perceived];
      const float off = std::abs((line.middle - piece.middle).dot(line.normal()));
      if (off >= off_px[match.perceived]) continue;
      off_px[match.perceived] = off;
      edge_at[match.perceived] = expected.pieces()[piece.piece].edge;
    }
    return edge_at;
  }

  /// The end of a matched line that is nearest to an end of its expected piece: at the piece's first end, and at its second.
  struct NearestLine {
    float off_px = std::numeric_limits<float>::infinity();  ///< along the piece.
    const localization::PerceivedEdge* line = nullptr;
  };
  using NearestLines = std::array<NearestLine, 2>;

  void take_ends(std::uint32_t index, const View& view, const localization::ExpectedView& expected, float radius_px,
                 std::span<const localization::Match> matches, Observed& observed) const {
    const auto pieces = expected.projected();
    std::vector<NearestLines> nearest(pieces.size());
    for (const localization::Match& match : matches) {
      const localization::ProjectedPiece& piece = pieces[match.projected];
      const localization::PerceivedEdge& line = view.edges.edges()[match.perceived];
      const float middle = (line.middle - piece.middle).dot(piece.direction);
      for (std::size_t end = 0; end < 2; ++end) {
        const float off = std::abs(middle + kSide.at(end) * (line.half_length - piece.half_length));
        NearestLine& best = nearest[match.projected].at(end);
        if (off < radius_px && off < best.off_px) best = {off, &line};
      }
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      for (std::size_t end = 0; end < 2; ++end) {
        if (nearest[i].at(end).line == nullptr) continue;
        const auto match = end_match(index, expected, pieces[i], kSide.at(end), *nearest[i].at(end).line);
        if (match) observed.ends.push_back(*match);
      }
    }
  }

  /// Nothing where the piece ends at no corner, or the line at the image's border.
  [[nodiscard]] std::optional<EndMatch> end_match(std::uint32_t index, const localization::ExpectedView& expected,
                                                  const localization::ProjectedPiece& piece, float side,
                                                  const localization::PerceivedEdge& line) const {
    const std::uint32_t edge = expected.pieces()[piece.piece].edge;
    if (!(side < 0.0F ? expected.ends_at_first(piece) : expected.ends_at_last(piece))) return std::nullopt;
    const float alike = line.direction.dot(piece.direction) < 0.0F ? -1.0F : 1.0F;
    const Eigen::Vector2f end = line.middle + alike * side * line.half_length * line.direction;
    const Eigen::Array2f last(static_cast<float>(camera_.width_px - 1), static_cast<float>(camera_.height_px - 1));
    if ((end.array() < kBorder_px).any() || (end.array() > last - kBorder_px).any()) return std::nullopt;
    return EndMatch{index, map_->ends_of(edge).at(side < 0.0F ? 0 : 1), piece.direction.cast<double>(),
                    double{piece.direction.dot(end)}, double{line.weight} * double{piece.weight}};
  }

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
  geometry::Camera camera_;
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

Owners owners_of(const ElasticMap& map, const Observed& observed) {
  Owners owners = observed.edge_at;
  for (auto& of_view : owners) {
    for (std::int64_t& owner : of_view) {
      if (owner >= 0) owner = map.part_of(map.ends_of(static_cast<std::uint32_t>(owner))[0]);
    }
  }
  return owners;
}

}  // namespace cgsr::mapping
