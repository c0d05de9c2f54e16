#include "pipeline/shade/silhouettes.h"

#include <algorithm>
#include <cmath>

namespace cgsr::shade {
namespace {

constexpr std::size_t kWorkPerUnit = 10'000;  // cells of the lamp's view that are visited, about ten instructions each
constexpr std::size_t kWorkPerStep = 40;      // a place along an edge: two questions to the view

}  // namespace

Silhouettes::Silhouettes(const world::Map& map, const ShadeParameters& parameters)
    : map_(map), lamp_(map, parameters), lamp_in_front_(map.surfaces.size()) {
  for (const Eigen::Vector3f& p : map.vertices) box_.extend(p);
  sides_.reserve(std::min(map.edges.size(), static_cast<std::size_t>(parameters.max_edges)));
}

void Silhouettes::begin(const Eigen::Vector3f& p_WL) {
  p_WL_ = p_WL;
  lamp_.begin(p_WL);
  sides_.clear();
  next_edge_ = 0;
  seen_ = false;
  for (std::size_t i = 0; i < map_.surfaces.size(); ++i) {
    lamp_in_front_[i] = map_.surfaces[i].normal.dot(p_WL) > map_.surfaces[i].offset_m ? 1 : 0;
  }
}

bool Silhouettes::work_unit() {
  if (!seen_) {
    seen_ = lamp_.go_on(kWorkPerUnit);
    return seen_ && map_.edges.empty();
  }
  for (std::size_t done = 0; done < kWorkPerUnit && next_edge_ < map_.edges.size(); ++next_edge_) {
    if (sides_.size() == sides_.capacity()) return true;
    const world::Edge& edge = map_.edges[next_edge_];
    done += bounds_shade(edge) ? take_edge(edge) : 1;
  }
  return next_edge_ == map_.edges.size();
}

/// An edge of which one surface is turned to the lamp and the other is not, or is not there.
bool Silhouettes::bounds_shade(const world::Edge& edge) const {
  const auto [a, b] = edge.surfaces;
  if (a == world::kNone || b == world::kNone) return a != b;
  return lamp_in_front_[a] != lamp_in_front_[b];
}

/// Tries places along an edge: what the lamp does not see of it lies in shade already and bounds nothing.
/// \return the work that it took.
std::size_t Silhouettes::take_edge(const world::Edge& edge) {
  constexpr float kStep_m = 0.04F;
  constexpr float kMostSteps = 48.0F;
  constexpr float kSpare = 1.02F;
  const Eigen::Vector3f& a = map_.vertices[edge.vertices[0]];
  const Eigen::Vector3f& b = map_.vertices[edge.vertices[1]];
  const Eigen::Vector3f way = b - a;
  const float length_m = way.norm();
  if (length_m < 1e-6F) return 1;
  const auto steps = static_cast<int>(std::clamp(length_m / kStep_m, 4.0F, kMostSteps));
  const float step = 1.0F / static_cast<float>(steps);
  int first = -1;  // of the stretch that is being seen
  int last = -1;
  float reach = 0.0F;
  const auto end_stretch = [&] {
    if (first < 0 || sides_.size() == sides_.capacity()) return;
    const float from = std::max(static_cast<float>(first - 1) * step, 0.0F);
    const float to = std::min(static_cast<float>(last + 2) * step, 1.0F);
    sides_.push_back({a + from * way, a + to * way, kSpare * reach});
    first = -1;
    reach = 0.0F;
  };
  for (int i = 0; i < steps; ++i) {
    const float here = reach_beyond(a + (static_cast<float>(i) + 0.5F) * step * way, way / length_m);
    if (here > 1.0F) {
      if (first < 0) first = i;
      last = i;
      reach = std::max(reach, here);
    } else if (i > last + 2) {
      end_stretch();
    }
  }
  end_stretch();
  return static_cast<std::size_t>(steps) * kWorkPerStep;
}

/// How many times as far as a place of an edge the light goes that just passes it. \return not above 1: none does, or both sides of the edge are
/// stopped there.
float Silhouettes::reach_beyond(const Eigen::Vector3f& p_W, const Eigen::Vector3f& along) const {
  constexpr float kBeside = 1e-3F;  // of the distance
  constexpr float kBeyond = 1.0005F;
  const Eigen::Vector3f beside = kBeside * (p_W - p_WL_).cross(along);
  const float reach = std::max(lamp_.reach(p_W + beside), lamp_.reach(p_W - beside));
  if (reach < kBeyond) return 0.0F;
  return std::min(reach, leaves_map_after(p_W));
}

/// How far the lamp's ray through a point goes until it is out of the map's box, in units of the way to the point.
float Silhouettes::leaves_map_after(const Eigen::Vector3f& p_W) const {
  float after = 1e4F;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const float way = p_W[i] - p_WL_[i];
    if (std::abs(way) < 1e-6F) continue;
    const float border = way > 0.0F ? box_.max()[i] : box_.min()[i];
    after = std::min(after, (border - p_WL_[i]) / way);
  }
  return std::max(1.2F * after, 1.0F);
}

}  // namespace cgsr::shade
