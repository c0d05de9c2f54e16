#include "pipeline/mapping/part_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "pipeline/localization/expected.h"
#include "pipeline/mapping/map_view.h"

namespace cgsr::mapping {
namespace {

constexpr double kReach_sigmas = 3.2;  // of a part's place
constexpr double kStep_m = 0.02;
constexpr double kFineStep_m = 0.006;
constexpr int kFineSteps = 3;
constexpr double kPriorShare = 0.008;  // of what is expected, that a place one sigma from the measured one costs
constexpr double kClearly = 0.015;     // of what is expected, that another place must find more
constexpr float kAngle_rad = 0.15F;
constexpr double kLongest_px = 60.0;  // of an edge, that counts
constexpr double kNearest_m = 0.1;
constexpr std::size_t kFewest = 6;  // pieces seen

/// A stretch of an edge that an image should show.
struct Stretch {
  std::uint32_t view = 0;
  Eigen::Vector3d p0, p1;
  int bright_side = 0;
  double weight = 1.0;
};

/// How far a part is from where it was measured.
Eigen::Vector3d mean_move(const ElasticMap& map, const Part& part) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t corner : part.corners) sum += map.corners()[corner] - map.measured()[corner];
  return sum / static_cast<double>(part.corners.size());
}

class PartSearch {
 public:
  PartSearch(const ElasticMap& map, std::span<const View> views, const geometry::Camera& camera,
             const RefineParameters& parameters, const Owners& owners, double sharpness_px)
      : views_(views),
        camera_(camera),
        sigma_m_(parameters.map_sigma_m),
        sharpness_px_(sharpness_px),
        owners_(&owners) {
    stretches_.resize(map.parts().size());
    for (const Part& part : map.parts()) moved_.push_back(mean_move(map, part));
    MapView shown(map, camera, parameters);
    for (std::uint32_t i = 0; i < views.size(); ++i) {
      const localization::ExpectedView& expected = shown.look(views[i].X_WC);
      for (const localization::ProjectedPiece& piece : expected.projected()) {
        const std::uint32_t edge = expected.pieces()[piece.piece].edge;
        stretches_[map.part_of(map.ends_of(edge)[0])].push_back({i, expected.point_at(piece, -piece.half_length),
                                                                 expected.point_at(piece, piece.half_length),
                                                                 piece.bright_side, double{piece.weight}});
      }
    }
  }

  [[nodiscard]] Eigen::Vector3d best(std::uint32_t part, bool on_floor) const {
    const auto& stretches = stretches_[part];
    if (stretches.size() < kFewest) return Eigen::Vector3d::Zero();
    double expected = 0.0;
    for (const Stretch& stretch : stretches) expected += stretch.weight * length_of(stretch);
    const auto score = [&](const Eigen::Vector3d& d) {
      double sum = -kPriorShare * expected * (moved_[part] + d).squaredNorm() / (sigma_m_ * sigma_m_);
      for (const Stretch& stretch : stretches) sum += stretch.weight * found(stretch, d, part);
      return sum;
    };
    const double unmoved = score(Eigen::Vector3d::Zero());
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    double best_score = unmoved;
    const auto try_at = [&](const Eigen::Vector3d& d) {
      const double now = score(d);
      if (now > best_score) {
        best_score = now;
        best = d;
      }
    };
    const int reach = static_cast<int>(kReach_sigmas * sigma_m_ / kStep_m);
    for (int x = -reach; x <= reach; ++x) {
      for (int y = -reach; y <= reach; ++y) try_at({x * kStep_m, y * kStep_m, 0.0});
    }
    for (int pass = 0; pass < 2; ++pass) {
      // try_at() moves `best` meanwhile. NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
      const Eigen::Vector3d middle = best;
      for (int z = -reach; z <= reach && !on_floor; ++z) try_at({middle.x(), middle.y(), z * kStep_m});
      // Likewise. NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
      const Eigen::Vector3d fine = best;
      for (int x = -kFineSteps; x <= kFineSteps; ++x) {
        for (int y = -kFineSteps; y <= kFineSteps; ++y) {
          try_at(fine + kFineStep_m * Eigen::Vector3d(x, y, 0.0));
        }
      }
    }
    return best_score - unmoved > kClearly * expected ? best : Eigen::Vector3d::Zero();
  }

 private:
  [[nodiscard]] std::optional<Eigen::Vector2f> pixel_of(const View& view, const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d p = view.X_WC.linear().transpose() * (p_W - view.X_WC.translation());
    if (p.z() < kNearest_m) return std::nullopt;
    return Eigen::Vector2f(static_cast<float>(camera_.fx_px * p.x() / p.z() + camera_.cx_px),
                           static_cast<float>(camera_.fy_px * p.y() / p.z() + camera_.cy_px));
  }

  [[nodiscard]] double length_of(const Stretch& stretch) const {
    const auto a = pixel_of(views_[stretch.view], stretch.p0);
    const auto b = pixel_of(views_[stretch.view], stretch.p1);
    return a && b ? std::min(kLongest_px, static_cast<double>((*b - *a).norm())) : 0.0;
  }

  /// Pixels of a stretch, moved by d, beside which an edge was perceived, each by how near.
  [[nodiscard]] double found(const Stretch& stretch, const Eigen::Vector3d& d, std::int64_t part) const {
    const View& view = views_[stretch.view];
    const auto a = pixel_of(view, stretch.p0 + d);
    const auto b = pixel_of(view, stretch.p1 + d);
    if (!a || !b) return 0.0;
    const float length = (*b - *a).norm();
    if (length < 4.0F) return 0.0;
    const Eigen::Vector2f along = (*b - *a) / length;
    const Eigen::Vector2f middle = 0.5F * (*a + *b);
    double best = 0.0;
    constexpr int kBins = localization::SegmentTable::kBins;
    const int bin = localization::SegmentTable::bin_of(along);
    for (int side = -1; side <= 1; side += 2) {
      if (stretch.bright_side == -side) continue;
      for (int k = -2; k <= 2; ++k) {
        const int at = (bin + k + (side < 0 ? kBins / 2 : 0) + 2 * kBins) % kBins;
        for (std::size_t i = view.edges.first_of(at); i < view.edges.first_of(at + 1); ++i) {
          const std::int64_t owner = owners_->empty() ? -1 : (*owners_)[stretch.view][i];
          const double share = owner >= 0 && owner != part ? kOthersShare : 1.0;
          best = std::max(best, share * common(view.edges.edges()[i], middle, along, 0.5F * length));
        }
      }
    }
    return std::min(kLongest_px, best);
  }

  [[nodiscard]] double common(const localization::PerceivedEdge& edge, const Eigen::Vector2f& middle,
                              const Eigen::Vector2f& along, float half) const {
    if (std::abs(along.dot(edge.normal())) > kAngle_rad) return 0.0;
    const Eigen::Vector2f offset = edge.middle - middle;
    const float place = offset.dot(along);
    const float overlap = std::min(half, place + edge.half_length) - std::max(-half, place - edge.half_length);
    if (overlap <= 0.0F) return 0.0;
    const double off = static_cast<double>(offset.dot(edge.normal())) / sharpness_px_;
    return static_cast<double>(overlap * edge.weight) / (1.0 + off * off);
  }

  std::span<const View> views_;
  geometry::Camera camera_;
  double sigma_m_;
  double sharpness_px_;
  std::vector<Eigen::Vector3d> moved_;
  std::vector<std::vector<Stretch>> stretches_;
  const Owners* owners_;
};

}  // namespace

std::vector<Eigen::Vector3d> search_parts(const ElasticMap& map, std::span<const View> views,
                                          const geometry::Camera& camera, const RefineParameters& parameters,
                                          const Owners& owners, double sharpness_px) {
  const PartSearch search(map, views, camera, parameters, owners, sharpness_px);
  std::vector<Eigen::Vector3d> shifts;
  for (std::uint32_t i = 0; i < map.parts().size(); ++i) {
    shifts.push_back(search.best(i, map.stands_on_floor(i)));
  }
  return shifts;
}

}  // namespace cgsr::mapping
