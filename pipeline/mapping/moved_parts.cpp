#include "pipeline/mapping/moved_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "pipeline/localization/expected.h"
#include "pipeline/localization/segment_table.h"
#include "pipeline/mapping/map_view.h"
#include "pipeline/mapping/observe.h"

namespace cgsr::mapping {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;

constexpr double kLargest_m = 2.5;  // of a piece of furniture
constexpr double kReach_m = 0.8;    // along the floor
constexpr double kStep_m = 0.04;
constexpr double kLevel_m = 0.05;       // up and down, of what does not stand on the floor
constexpr double kUp_sigmas = 2.0;      // of a part's place: how far up and down it may be from where it was measured
constexpr double kBeside_sigmas = 2.6;  // nearer along the floor it was only measured wrongly
constexpr double kFineStep_m = 0.01;
constexpr int kFineSteps = 6;
constexpr double kFarthest_m = 5.0;
constexpr double kNearest_m = 0.2;
constexpr float kShortest_px = 8.0F;
constexpr double kLongest_px = 60.0;  // of an edge, that counts
constexpr float kCoarse_px = 4.0F;    // how far off a line counts half
constexpr float kFine_px = 2.0F;
constexpr float kAngle_rad = 0.12F;
constexpr double kFitsHere = 0.35;      // a share found from which on a part is not looked for elsewhere
constexpr double kFitsThere = 0.4;      // a share found from which on it is there,
constexpr double kClearly = 1.8;        // and so many times what is found where the map has it
constexpr double kExpected_px = 400.0;  // at least, there
constexpr int kFewestImages = 5;
constexpr double kSeen_images = 3.0;  // that show it there, counted by the share that is found
constexpr int kFewestOfEdge = 3;      // images that show an edge that is proposed
constexpr double kShown = 0.4;        // of a stretch in an image, from which on that shows it
constexpr double kShortest_m = 0.08;  // of an edge that is proposed
constexpr std::size_t kTried = 10;    // best places of the grid that are looked at closely

struct Stretch {
  Vector3d a, b;
  std::uint32_t edge = 0;  // of the map
};

/// The perceived edge that shows most of a stretch: how much, and how far beside it.
struct Found {
  double overlap_px = 0.0;
  double off_px = 0.0;
};

struct Share {
  double expected_px = 0.0;
  double found_px = 0.0;
  int images = 0;  // that show some of it
  [[nodiscard]] double value() const { return expected_px > 0.0 ? found_px / expected_px : 0.0; }
};

class Finder {
 public:
  Finder(const ElasticMap& map, std::span<const View> views, const geometry::Camera& camera,
         const RefineParameters& refined_with)
      : views_(views),
        camera_(camera),
        owners_(owners_of(map, observe(map, views, camera, refined_with, kExplained_px))) {}

  /// Whose edges are looked for from now on.
  void look_for(std::uint32_t part) { part_ = part; }

  /// What the images show of some edges when they are moved; nothing hides them.
  [[nodiscard]] Share share_of(const std::vector<Stretch>& edges, const Vector3d& middle, const Vector3d& d) const {
    Share sum;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      if (!near(v, middle + d)) continue;
      Share here;
      for (const Stretch& edge : edges) add(v, {edge.a + d, edge.b + d, edge.edge}, kCoarse_px, here);
      add_image(here, sum);
    }
    return sum;
  }

  Found add(std::size_t view, const Stretch& stretch, float sharpness_px, Share& share) const {
    const auto a = pixel(view, stretch.a);
    const auto b = pixel(view, stretch.b);
    if (!a || !b) return {};
    const float length = (*b - *a).norm();
    if (length < kShortest_px) return {};
    const Found best = found(view, *a, *b, sharpness_px);
    share.expected_px += std::min(kLongest_px, static_cast<double>(length));
    share.found_px += std::min(kLongest_px, best.overlap_px);
    return best;
  }

  static void add_image(const Share& one, Share& sum) {
    sum.expected_px += one.expected_px;
    sum.found_px += one.found_px;
    sum.images += one.found_px > 0.25 * one.expected_px ? 1 : 0;
  }

  /// Whether a view may show something at a place.
  [[nodiscard]] bool near(std::size_t view, const Vector3d& p_W) const {
    const Vector3d p = in_camera(view, p_W);
    if (p.z() < kNearest_m || p.z() > kFarthest_m) return false;
    const double u = camera_.fx_px * p.x() / p.z() + camera_.cx_px;
    return u > -0.2 * camera_.width_px && u < 1.2 * camera_.width_px;
  }

 private:
  [[nodiscard]] Vector3d in_camera(std::size_t view, const Vector3d& p_W) const {
    return views_[view].X_WC.linear().transpose() * (p_W - views_[view].X_WC.translation());
  }
  [[nodiscard]] std::optional<Vector2f> pixel(std::size_t view, const Vector3d& p_W) const {
    const Vector3d p = in_camera(view, p_W);
    if (p.z() < kNearest_m) return std::nullopt;
    const double u = camera_.fx_px * p.x() / p.z() + camera_.cx_px;
    const double v = camera_.fy_px * p.y() / p.z() + camera_.cy_px;
    if (u < 0.0 || v < 0.0 || u > camera_.width_px - 1 || v > camera_.height_px - 1) return std::nullopt;
    return Vector2f(static_cast<float>(u), static_cast<float>(v));
  }

  [[nodiscard]] Found found(std::size_t view, const Vector2f& a, const Vector2f& b, float sharpness_px) const {
    const float half = 0.5F * (b - a).norm();
    const Vector2f along = (b - a) / (2.0F * half);
    const Vector2f middle = 0.5F * (a + b);
    Found best;
    for (std::size_t i = 0; i < views_[view].edges.size(); ++i) {
      const localization::PerceivedEdge& edge = views_[view].edges.edges()[i];
      if (std::abs(along.dot(edge.normal())) > kAngle_rad) continue;
      const Vector2f offset = edge.middle - middle;
      const float place = offset.dot(along);
      const float overlap = std::min(half, place + edge.half_length) - std::max(-half, place - edge.half_length);
      if (overlap <= 0.0F) continue;
      const float off_px = offset.dot(edge.normal());
      const float off = off_px / sharpness_px;
      const std::int64_t owner = owners_[view][i];
      const double share = owner >= 0 && owner != part_ ? kOthersShare : 1.0;
      const double counted = share * static_cast<double>(overlap / (1.0F + off * off));
      if (counted > best.overlap_px) best = {counted, static_cast<double>(off_px)};
    }
    return best;
  }

  std::span<const View> views_;
  geometry::Camera camera_;
  Owners owners_;
  std::int64_t part_ = -1;
};

std::vector<Stretch> edges_of(const ElasticMap& map, std::uint32_t part) {
  std::vector<Stretch> edges;
  for (std::uint32_t i = 0; i < map.map().edges.size(); ++i) {
    const auto [a, b] = map.ends_of(i);
    if (map.part_of(a) == part && map.part_of(b) == part) edges.push_back({map.corners()[a], map.corners()[b], i});
  }
  return edges;
}

/// Stretches of one part's edges that each view should show.
std::vector<std::vector<Stretch>> visible_of(const ElasticMap& map, std::uint32_t part, const Finder& finder,
                                             std::span<const View> views, const geometry::Camera& camera,
                                             const RefineParameters& parameters) {
  Vector3d middle = Vector3d::Zero();
  for (const std::uint32_t corner : map.parts()[part].corners) {
    middle += map.corners()[corner] / static_cast<double>(map.parts()[part].corners.size());
  }
  MapView shown(map, camera, parameters);
  std::vector<std::vector<Stretch>> stretches(views.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (!finder.near(v, middle)) continue;
    const localization::ExpectedView& expected = shown.look(views[v].X_WC);
    for (const localization::ProjectedPiece& piece : expected.projected()) {
      const std::uint32_t edge = expected.pieces()[piece.piece].edge;
      if (map.part_of(map.ends_of(edge)[0]) != part) continue;
      stretches[v].push_back(
          {expected.point_at(piece, -piece.half_length), expected.point_at(piece, piece.half_length), edge});
    }
  }
  return stretches;
}

/// ... and what of them is shown.
Share share_of(const Finder& finder, const std::vector<std::vector<Stretch>>& stretches, const Vector3d& d) {
  Share sum;
  for (std::size_t v = 0; v < stretches.size(); ++v) {
    Share here;
    for (const Stretch& stretch : stretches[v])
      finder.add(v, {stretch.a + d, stretch.b + d, stretch.edge}, kFine_px, here);
    Finder::add_image(here, sum);
  }
  return sum;
}

struct Place {
  Vector3d d;
  double share;
};

/// How far from where it was measured a part is looked for.
struct Reach {
  double least_m;  ///< along the floor.
  double up_m;     ///< up and down; 0: it stands on the floor.
  [[nodiscard]] bool holds(const Vector3d& d) const { return d.head<2>().norm() >= least_m && std::abs(d.z()) <= up_m; }
};

/// Places of the grid, the best ones first, two and a half steps apart at least.
std::vector<Place> best_places(const Finder& finder, const std::vector<Stretch>& edges, const Vector3d& middle,
                               const Reach& within) {
  std::vector<Place> places;
  const int reach = static_cast<int>(kReach_m / kStep_m);
  const int levels = static_cast<int>(std::lround(within.up_m / kLevel_m));
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      if (kStep_m * std::hypot(x, y) > kReach_m) continue;
      for (int z = -levels; z <= levels; ++z) {
        const Vector3d d(x * kStep_m, y * kStep_m, z * kLevel_m);
        if (!within.holds(d)) continue;
        const Share share = finder.share_of(edges, middle, d);
        if (share.expected_px >= kExpected_px) places.push_back({d, share.value()});
      }
    }
  }
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.share > b.share; });
  std::vector<Place> apart;
  for (const Place& place : places) {
    const bool close = std::any_of(apart.begin(), apart.end(),
                                   [&](const Place& known) { return (known.d - place.d).norm() < 2.5 * kStep_m; });
    if (!close) apart.push_back(place);
    if (apart.size() == kTried) break;
  }
  return apart;
}

Eigen::AlignedBox3d box_of(const ElasticMap& map, std::uint32_t part) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t corner : map.parts()[part].corners) box.extend(map.corners()[corner]);
  return box;
}

/// What fits badly was pulled out of shape and off its height by what it was taken for.
void put_where_measured(ElasticMap& map, std::uint32_t part) {
  auto corners = map.corners();
  for (const std::uint32_t corner : map.parts()[part].corners) corners[corner] = map.measured()[corner];
  map.move(corners);
}

void move_part(ElasticMap& map, std::uint32_t part, const Vector3d& d) {
  auto corners = map.corners();
  for (const std::uint32_t corner : map.parts()[part].corners) corners[corner] += d;
  map.move(corners);
}

/// With what hides it there, and more exactly.
std::optional<MovedPart> look_closely(ElasticMap& map, std::uint32_t part, const Vector3d& d, const Reach& within,
                                      const Finder& finder, std::span<const View> views, const geometry::Camera& camera,
                                      const RefineParameters& parameters) {
  move_part(map, part, d);
  const auto stretches = visible_of(map, part, finder, views, camera, parameters);
  move_part(map, part, -d);
  MovedPart best;
  const auto try_at = [&](const Vector3d& fine) {
    if (!within.holds(d + fine)) return;
    const Share share = share_of(finder, stretches, fine);
    if (share.expected_px < kExpected_px || share.images < kFewestImages || share.value() <= best.share_there) return;
    best = {part, d + fine, 0.0, share.value(), share.images, {}};
  };
  const int levels = within.up_m > 0.0 ? kFineSteps : 0;
  for (int z = -levels; z <= levels; ++z) try_at({0.0, 0.0, z * kFineStep_m});
  const double level = best.images > 0 ? best.shift.z() - d.z() : 0.0;
  for (int x = -kFineSteps; x <= kFineSteps; ++x) {
    for (int y = -kFineSteps; y <= kFineSteps; ++y) try_at({x * kFineStep_m, y * kFineStep_m, level});
  }
  if (best.images == 0) return std::nullopt;
  return best;
}

/// The edges of a part that images show where it was found.
std::vector<Proposal> edges_there(ElasticMap& map, const MovedPart& moved, const Finder& finder,
                                  std::span<const View> views, const geometry::Camera& camera,
                                  const RefineParameters& parameters) {
  move_part(map, moved.part, moved.shift);
  const auto stretches = visible_of(map, moved.part, finder, views, camera, parameters);
  struct Seen {
    Proposal proposal;
    double longest_px = 0.0;
  };
  std::map<std::uint32_t, Seen> seen;
  for (std::size_t v = 0; v < stretches.size(); ++v) {
    for (const Stretch& stretch : stretches[v]) {
      Share share;
      const Found found = finder.add(v, stretch, kFine_px, share);
      if (share.value() < kShown) continue;
      Seen& edge = seen[stretch.edge];
      ++edge.proposal.images;
      edge.proposal.rms_px += found.off_px * found.off_px;
      if (found.overlap_px <= edge.longest_px) continue;
      edge.longest_px = found.overlap_px;
      edge.proposal.best_view = v;
    }
  }
  std::vector<Proposal> proposals;
  for (auto& [index, edge] : seen) {
    const auto [a, b] = map.ends_of(index);
    Proposal& proposal = edge.proposal;
    proposal.a = map.corners()[a];
    proposal.b = map.corners()[b];
    proposal.rms_px = std::sqrt(proposal.rms_px / proposal.images);
    proposal.part = map.parts()[moved.part].name;
    if (proposal.images >= kFewestOfEdge && (proposal.b - proposal.a).norm() >= kShortest_m) {
      proposals.push_back(proposal);
    }
  }
  move_part(map, moved.part, -moved.shift);
  return proposals;
}

/// Where a part, which is where it was measured, fits best beside that.
std::optional<MovedPart> best_place(ElasticMap& map, std::uint32_t part, const Finder& finder,
                                    std::span<const View> views, const geometry::Camera& camera,
                                    const RefineParameters& refined_with) {
  const double sigma_m = refined_with.map_sigma_m;
  const Reach within{kBeside_sigmas * sigma_m, map.stands_on_floor(part) ? 0.0 : kUp_sigmas * sigma_m};
  std::optional<MovedPart> best;
  for (const Place& place : best_places(finder, edges_of(map, part), box_of(map, part).center(), within)) {
    auto closer = look_closely(map, part, place.d, within, finder, views, camera, refined_with);
    if (closer) closer = look_closely(map, part, closer->shift, within, finder, views, camera, refined_with);
    if (closer && (!best || closer->share_there > best->share_there)) best = closer;
  }
  return best;
}

}  // namespace

std::vector<MovedPart> find_moved_parts(ElasticMap& map, std::span<const View> views, const geometry::Camera& camera,
                                        const RefineParameters& refined_with) {
  Finder finder(map, views, camera, refined_with);
  const auto at_rest = map.corners();
  std::vector<MovedPart> moved;
  for (std::uint32_t part = 0; part < map.parts().size(); ++part) {
    if (box_of(map, part).sizes().maxCoeff() > kLargest_m) continue;
    finder.look_for(part);
    const Share here = share_of(finder, visible_of(map, part, finder, views, camera, refined_with), Vector3d::Zero());
    if (here.expected_px < kExpected_px || here.value() > kFitsHere) continue;
    put_where_measured(map, part);
    auto best = best_place(map, part, finder, views, camera, refined_with);
    if (best && best->share_there >= std::max(kFitsThere, kClearly * here.value()) &&
        best->share_there * best->images >= kSeen_images) {
      best->share_here = here.value();
      best->edges = edges_there(map, *best, finder, views, camera, refined_with);
      moved.push_back(*best);
    }
    map.move(at_rest);
  }
  return moved;
}

}  // namespace cgsr::mapping
