#include "pipeline/mapping/propose.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "pipeline/mapping/loose_edges.h"

namespace cgsr::mapping {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;

constexpr double kNearest_m = 0.2;
constexpr double kFarthest_m = 6.0;
constexpr double kLeastBaseline_m = 0.12;
constexpr double kMostBaseline_m = 1.5;
constexpr std::size_t kPartners = 5;  // views that a perceived edge is paired with
constexpr int kRounds = 3;            // of fitting a line to its images
constexpr double kAlong = 1e7;        // holds a line's ends along itself [1/m^2]: images hold them across alone

/// A perceived edge that the map does not explain.
struct Loose {
  Vector2f middle, direction;
  float half_length = 0.0F;
  bool used = false;

  [[nodiscard]] Vector2f normal() const { return {-direction.y(), direction.x()}; }
  [[nodiscard]] Vector2f end(float side) const { return middle + side * half_length * direction; }
};

struct Support {
  std::size_t view;
  std::size_t edge;
};

class Proposer {
 public:
  Proposer(std::span<const View> views, const geometry::Camera& camera, const ProposeParameters& parameters)
      : views_(views), camera_(camera), p_(parameters), loose_(views.size()) {}

  /// Of every view what runs along no edge of the map.
  void collect(const ElasticMap& map, const RefineParameters& refined_with) {
    const auto edges = loose_edges(map, views_, camera_, p_, refined_with, p_.min_length_px);
    for (std::size_t i = 0; i < views_.size(); ++i) {
      for (const localization::PerceivedEdge& edge : edges[i]) {
        loose_[i].push_back({edge.middle, edge.direction, edge.half_length});
      }
    }
  }

  std::vector<Proposal> find() {
    std::vector<Support> seeds;
    for (std::size_t v = 0; v < loose_.size(); ++v) {
      for (std::size_t e = 0; e < loose_[v].size(); ++e) seeds.push_back({v, e});
    }
    std::sort(seeds.begin(), seeds.end(), [&](const Support& a, const Support& b) {
      return loose_[a.view][a.edge].half_length > loose_[b.view][b.edge].half_length;
    });
    std::vector<Proposal> found;
    for (const Support& seed : seeds) {
      if (loose_[seed.view][seed.edge].used) continue;
      if (auto proposal = grow(seed)) found.push_back(*proposal);
    }
    return each_once(std::move(found));
  }

 private:
  struct Line {
    Vector3d a, b;
  };

  [[nodiscard]] Vector3d ray(std::size_t view, const Vector2f& pixel) const {
    const Vector3d d((static_cast<double>(pixel.x()) - camera_.cx_px) / camera_.fx_px,
                     (static_cast<double>(pixel.y()) - camera_.cy_px) / camera_.fy_px, 1.0);
    return views_[view].X_WC.linear() * d;
  }
  [[nodiscard]] std::optional<Vector2f> pixel(std::size_t view, const Vector3d& p_W) const {
    const Vector3d p = views_[view].X_WC.linear().transpose() * (p_W - views_[view].X_WC.translation());
    if (p.z() < kNearest_m) return std::nullopt;
    return Vector2f(static_cast<float>(camera_.fx_px * p.x() / p.z() + camera_.cx_px),
                    static_cast<float>(camera_.fy_px * p.y() / p.z() + camera_.cy_px));
  }

  /// A perceived edge of one view on the plane of one of another.
  [[nodiscard]] std::optional<Line> meet(const Support& one, const Support& other) const {
    const Loose& a = loose_[one.view][one.edge];
    const Loose& b = loose_[other.view][other.edge];
    const Vector3d normal = ray(other.view, b.end(-1.0F)).cross(ray(other.view, b.end(1.0F))).normalized();
    const Vector3d own = ray(one.view, a.end(-1.0F)).cross(ray(one.view, a.end(1.0F))).normalized();
    if (normal.cross(own).norm() < 0.5 * p_.min_parallax_rad) return std::nullopt;
    Line line;
    const Vector3d& from = views_[one.view].X_WC.translation();
    const double level = normal.dot(views_[other.view].X_WC.translation() - from);
    for (const float side : {-1.0F, 1.0F}) {
      const Vector3d d = ray(one.view, a.end(side));
      const double depth = level / normal.dot(d);  // along the camera's axis: ray() has z = 1 there
      if (!(depth > kNearest_m && depth < kFarthest_m)) return std::nullopt;
      (side < 0.0F ? line.a : line.b) = from + depth * d;
    }
    return line;
  }

  /// The best loose edge of a view that runs along a line in space.
  [[nodiscard]] std::optional<std::size_t> supporting(std::size_t view, const Line& line) const {
    const auto a = pixel(view, line.a);
    const auto b = pixel(view, line.b);
    if (!a || !b) return std::nullopt;
    const Vector2f d = *b - *a;
    const float length = d.norm();
    if (length < 0.5F * p_.min_length_px) return std::nullopt;
    const Vector2f along = d / length;
    const Vector2f across(-along.y(), along.x());
    std::optional<std::size_t> best;
    float nearest = p_.support_px;
    for (std::size_t i = 0; i < loose_[view].size(); ++i) {
      const Loose& edge = loose_[view][i];
      if (edge.used || std::abs(edge.direction.dot(across)) > p_.angle_rad) continue;
      const float off =
          std::max(std::abs((edge.end(-1.0F) - *a).dot(across)), std::abs((edge.end(1.0F) - *a).dot(across)));
      if (off >= nearest) continue;
      const float place = (edge.middle - *a).dot(along);
      const float overlap = std::min(length, place + edge.half_length) - std::max(0.0F, place - edge.half_length);
      if (overlap < p_.overlap * std::max(0.6F * length, 2.0F * edge.half_length)) continue;
      nearest = off;
      best = i;
    }
    return best;
  }

  [[nodiscard]] std::vector<Support> supports_of(const Line& line) const {
    std::vector<Support> supports;
    for (std::size_t v = 0; v < loose_.size(); ++v) {
      if (const auto edge = supporting(v, line)) supports.push_back({v, *edge});
    }
    return supports;
  }

  /// Moves both ends across the line until it lies best in all images that support it.
  [[nodiscard]] double fit(const std::vector<Support>& supports, Line& line) const {
    double rms = 0.0;
    for (int round = 0; round < kRounds; ++round) {
      const Vector3d along = (line.b - line.a).normalized();
      Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Identity();
      for (int end = 0; end < 2; ++end) A.block<3, 3>(3 * end, 3 * end) += kAlong * along * along.transpose();
      Eigen::Matrix<double, 6, 1> g = Eigen::Matrix<double, 6, 1>::Zero();
      double sum = 0.0;
      for (const Support& support : supports) {
        const Loose& edge = loose_[support.view][support.edge];
        const Vector3d normal =
            ray(support.view, edge.end(-1.0F)).cross(ray(support.view, edge.end(1.0F))).normalized();
        for (int end = 0; end < 2; ++end) {
          const Vector3d from = (end == 0 ? line.a : line.b) - views_[support.view].X_WC.translation();
          const double px_per_m = camera_.fx_px / from.norm();
          const double off = px_per_m * normal.dot(from);
          sum += off * off;
          A.block<3, 3>(3 * end, 3 * end) += px_per_m * px_per_m * normal * normal.transpose();
          g.segment<3>(3 * end) += px_per_m * off * normal;
        }
      }
      rms = std::sqrt(sum / (2.0 * static_cast<double>(supports.size())));
      const Eigen::Matrix<double, 6, 1> step = A.ldlt().solve(g);
      line.a -= step.head<3>();
      line.b -= step.tail<3>();
    }
    return rms;
  }

  [[nodiscard]] double parallax(const std::vector<Support>& supports, const Line& line) const {
    const Vector3d middle = 0.5 * (line.a + line.b);
    const Vector3d along = (line.b - line.a).normalized();
    double most = 0.0;
    std::optional<Vector3d> first;
    for (const Support& support : supports) {
      const Vector3d plane = (middle - views_[support.view].X_WC.translation()).cross(along).normalized();
      if (!first) first = plane;
      most = std::max(most, std::acos(std::clamp(plane.dot(*first), -1.0, 1.0)));
    }
    return most;
  }

  [[nodiscard]] bool inside(const std::optional<Vector2f>& p) const {
    return p && p->x() >= 0.0F && p->y() >= 0.0F && p->x() <= static_cast<float>(camera_.width_px - 1) &&
           p->y() <= static_cast<float>(camera_.height_px - 1);
  }

  /// In how many images both ends would be, were nothing in front.
  [[nodiscard]] double images_with(const Line& line) const {
    int count = 0;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      count += inside(pixel(v, line.a)) && inside(pixel(v, line.b)) ? 1 : 0;
    }
    return count;
  }

  [[nodiscard]] std::vector<std::size_t> partners_of(std::size_t view) const {
    std::vector<std::pair<double, std::size_t>> near;
    const geometry::Pose& X = views_[view].X_WC;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const double baseline = (views_[v].X_WC.translation() - X.translation()).norm();
      if (baseline < kLeastBaseline_m || baseline > kMostBaseline_m) continue;
      const double facing = views_[v].X_WC.linear().col(2).dot(X.linear().col(2));
      if (facing > 0.5) near.emplace_back(std::abs(baseline - 0.5), v);
    }
    std::sort(near.begin(), near.end());
    std::vector<std::size_t> partners;
    for (std::size_t i = 0; i < std::min(kPartners, near.size()); ++i) partners.push_back(near[i].second);
    return partners;
  }

  std::optional<Proposal> grow(const Support& seed) {
    std::vector<Support> best;
    Line best_line;
    for (const std::size_t view : partners_of(seed.view)) {
      for (std::size_t e = 0; e < loose_[view].size(); ++e) {
        if (loose_[view][e].used) continue;
        const auto line = meet(seed, {view, e});
        if (!line || (line->b - line->a).norm() < p_.min_length_m) continue;
        auto supports = supports_of(*line);
        if (supports.size() <= best.size()) continue;
        best = std::move(supports);
        best_line = *line;
      }
    }
    if (static_cast<int>(best.size()) < p_.min_support) return std::nullopt;
    double rms = fit(best, best_line);
    best = supports_of(best_line);
    if (static_cast<int>(best.size()) < p_.min_support) return std::nullopt;
    rms = fit(best, best_line);
    if (parallax(best, best_line) < p_.min_parallax_rad) return std::nullopt;
    if (static_cast<double>(best.size()) < p_.min_share * images_with(best_line)) return std::nullopt;
    for (const Support& support : best) loose_[support.view][support.edge].used = true;
    const auto longest = std::ranges::max_element(
        best, {}, [&](const Support& support) { return loose_[support.view][support.edge].half_length; });
    return Proposal{best_line.a, best_line.b, static_cast<int>(best.size()), rms, longest->view, {}};
  }

  [[nodiscard]] std::vector<Proposal> each_once(std::vector<Proposal> found) const {
    std::stable_sort(found.begin(), found.end(),
                     [](const Proposal& a, const Proposal& b) { return a.images > b.images; });
    std::vector<Proposal> kept;
    const auto off = [](const Proposal& line, const Vector3d& p) {
      const Vector3d d = line.b - line.a;
      return (line.a + std::clamp((p - line.a).dot(d) / d.squaredNorm(), 0.0, 1.0) * d - p).norm();
    };
    for (const Proposal& proposal : found) {
      const bool again = std::any_of(kept.begin(), kept.end(), [&](const Proposal& known) {
        return off(known, proposal.a) < p_.same_m && off(known, proposal.b) < p_.same_m;
      });
      if (!again) kept.push_back(proposal);
    }
    return kept;
  }

  std::span<const View> views_;
  geometry::Camera camera_;
  ProposeParameters p_;
  std::vector<std::vector<Loose>> loose_;
};

}  // namespace

std::vector<Proposal> propose_edges(const ElasticMap& map, std::span<const View> views, const geometry::Camera& camera,
                                    const ProposeParameters& parameters, const RefineParameters& refined_with) {
  Proposer proposer(views, camera, parameters);
  proposer.collect(map, refined_with);
  return proposer.find();
}

}  // namespace cgsr::mapping
