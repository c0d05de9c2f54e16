// What a look into a large map's index costs: `tools/count -- PATH/index_bench MAP [looks]` prints it. Views from random places 0.7 m above the
// floor, 25 m far.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include <fmt/core.h>
#include <Eigen/Geometry>

#include "pipeline/world/index.h"
#include "pipeline/world/load.h"
#include "platform/count_marks.h"

namespace cgsr::world {
namespace {

int run(const char* path, int looks) {
  const auto map = load_map(path);
  if (!map) {
    fmt::print(stderr, "{}\n", map.error().message);
    return 1;
  }
  const Index index(*map);
  Bounds box;
  for (const Eigen::Vector3f& p : map->vertices) box.add(p);
  std::mt19937 random(3);
  const auto unit = [&] { return static_cast<float>(random()) / 4294967296.0F; };
  std::vector<Cell> cells;
  cells.reserve(1'000'000);
  for (int i = 0; i < looks; ++i) {
    geometry::Pose X_WC = geometry::Pose::Identity();
    X_WC.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    X_WC.prerotate(Eigen::AngleAxisd(6.28 * static_cast<double>(unit()), Eigen::Vector3d::UnitZ()));
    X_WC.translation() = Eigen::Vector3d(static_cast<double>(box.low[0] + unit() * (box.high[0] - box.low[0])),
                                         static_cast<double>(box.low[1] + unit() * (box.high[1] - box.low[1])), 0.7);
    const double far_m = i % 2 == 0 ? 25.0 : 1000.0;
    count_stage_begin();
    index.edges_in(Frustum(X_WC, geometry::Camera(), 0.05, far_m), cells);
    count_stage_end(i % 2 == 0 ? "edges_25_m" : "edges_all");
    std::size_t edges = 0;
    for (const Cell& cell : cells) edges += cell.end - cell.first;
    fmt::print("{:.0f} m: {} cells, {} of {} edges\n", far_m, cells.size(), edges, map->edges.size());
    count_stage_begin();
    index.triangles_in(Frustum(X_WC, geometry::Camera(), 0.05, far_m), cells);
    count_stage_end(i % 2 == 0 ? "triangles_25_m" : "triangles_all");
    const auto forward = X_WC.linear().col(2).cast<float>();
    count_stage_begin();
    const float free = index.free_distance(X_WC.translation().cast<float>(), forward, 100.0F);
    count_stage_end("free_distance");
    fmt::print("free for {:.2f} m\n", static_cast<double>(free));
    count_image_end();
  }
  return 0;
}

}  // namespace
}  // namespace cgsr::world

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: index_bench MAP [looks]\n");
    return 2;
  }
  return cgsr::world::run(argv[1], argc > 2 ? std::atoi(argv[2]) : 10);
}
