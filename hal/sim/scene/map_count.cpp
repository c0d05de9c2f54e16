#include "hal/sim/scene/map_count.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace cgsr::sim {
namespace {

// Corners on a grid of 0.1 mm. Two that straddle a grid line would count apart, so the grid is shifted off round numbers.
class Welder {
 public:
  int index(const Eigen::Vector3f& p) {
    std::array<std::int64_t, 3> cell{};
    for (int i = 0; i < 3; ++i)
      cell[static_cast<std::size_t>(i)] = std::llround((static_cast<double>(p[i]) + 0.31e-4) / 1e-4);
    return corners_.try_emplace(cell, static_cast<int>(corners_.size())).first->second;
  }

 private:
  std::map<std::array<std::int64_t, 3>, int> corners_;
};

}  // namespace

MapCount count_map(const Scene& scene) {
  MapCount count;
  Welder welder;
  std::set<std::pair<int, int>> edges;
  for (const Part& part : scene.parts) {
    if (part.figure >= 0 || !part.in_map) continue;
    for (const auto& outline : part.mesh.polygons) {
      ++count.surfaces;
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const int a = welder.index(part.mesh.position_m[outline[i]]);
        const int b = welder.index(part.mesh.position_m[outline[(i + 1) % outline.size()]]);
        if (a != b) edges.emplace(std::min(a, b), std::max(a, b));
      }
    }
  }
  count.edges = static_cast<int>(edges.size());
  return count;
}

}  // namespace cgsr::sim
