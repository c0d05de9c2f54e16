#include "hal/sim/home/plan.h"

#include <algorithm>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

struct Layer {
  float height_m;  // of the highest corner
  hal::PlanPiece piece;
};

std::array<float, 3> color_of(const Material& material) {
  const Rgb linear = material.pattern == PatternKind::kPlain ? material.albedo
                                                             : Rgb(0.5F * (material.albedo + material.second_albedo));
  std::array<float, 3> srgb{};
  for (int i = 0; i < 3; ++i) {
    srgb[static_cast<std::size_t>(i)] = static_cast<float>(srgb_encode(static_cast<double>(linear[i])));
  }
  return srgb;
}

void add_layers(const Scene& scene, const Part& part, double ceiling_m, std::vector<Layer>& layers) {
  const auto color = color_of(scene.materials[static_cast<std::size_t>(part.material)]);
  for (const auto& triangle : part.mesh.triangles) {
    Layer layer{0.0F, {{}, color}};
    Eigen::AlignedBox3f box;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3f& corner = part.mesh.position_m[triangle.corner[i]];
      layer.piece.corners_m[i] = {corner.x(), corner.y()};
      box.extend(corner);
    }
    layer.height_m = std::min(box.max().z(), static_cast<float>(ceiling_m));
    if (static_cast<double>(box.min().z()) < ceiling_m) layers.push_back(layer);
  }
}

}  // namespace

hal::Plan make_plan(const Scene& scene, double ceiling_m) {
  std::vector<Layer> layers;
  for (const Part& part : scene.parts) {
    if (part.figure < 0) add_layers(scene, part, ceiling_m, layers);
  }
  std::stable_sort(layers.begin(), layers.end(),
                   [](const Layer& a, const Layer& b) { return a.height_m < b.height_m; });
  hal::Plan plan;
  Eigen::AlignedBox2f area;
  for (const Layer& layer : layers) {
    plan.pieces.push_back(layer.piece);
    for (const auto& corner : layer.piece.corners_m) area.extend(Eigen::Vector2f(corner[0], corner[1]));
  }
  if (!area.isEmpty()) {
    plan.min_x_m = static_cast<double>(area.min().x());
    plan.max_x_m = static_cast<double>(area.max().x());
    plan.min_y_m = static_cast<double>(area.min().y());
    plan.max_y_m = static_cast<double>(area.max().y());
  }
  return plan;
}

}  // namespace cgsr::sim
