#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hal/sim/render/pattern.h"
#include "hal/sim/render/tracer.h"
#include "hal/sim/scene/scene.h"

namespace cgsr::sim {

/// Where one ray met the scene, with all that shading needs. World frame; normals face the viewer.
struct Surfel {
  int part = -1;
  std::uint32_t polygon = 0;
  float depth_m = 0.0F;  ///< along the optical axis.
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();
  Eigen::Vector3f n_W = Eigen::Vector3f::UnitZ();       ///< smooth where the surface is.
  Eigen::Vector3f p_WShadow = Eigen::Vector3f::Zero();  ///< where shadow rays start.
  SurfacePoint at;                                      ///< left alone on surfaces of one colour.
  float open = 1.0F;                                    ///< share of the ambient light that gets there.
};

/// A ray of the camera; direction with unit depth, so that the distance along it is the depth.
struct Ray {
  Eigen::Vector3f origin;
  Eigen::Vector3f direction;
  float width = 0.0F;  ///< footprint per metre of depth: one pixel's, or its part.
};

/// What is the same about every surface point of a scene, computed once: frames of triangles and how open each place is to ambient light.
class Surfaces {
 public:
  /// Frames only; everything is open until bake() is asked for.
  explicit Surfaces(const Scene& scene);

  [[nodiscard]] Surfel at(const Tracer& tracer, const Met& met, const Ray& ray, float depth_m) const;

  /// The share of ambient light that reaches a static place: stored on a grid of about 12 cm per flat polygon, per corner on curved parts.
  struct OpenMap {
    Eigen::Vector3f origin;   // corner of the polygon's rectangle
    Eigen::Vector3f along_x;  // per metre: texels
    Eigen::Vector3f along_y;
    Eigen::Vector3f n;
    int width = 0;
    int height = 0;
    std::size_t first = 0;  // into `open_`
  };

 private:
  friend class OpenBaker;

  struct TriangleFrame {
    Eigen::Vector3f n;
    Eigen::Vector3f u_per_m;  // gradient of u on the plane
    Eigen::Vector3f v_per_m;
    std::int32_t map = -1;
  };
  struct PartData {
    std::vector<TriangleFrame> triangles;
    std::vector<float> open_at_corner;  // curved static parts, once baked
    bool moves = false;
    bool patterned = false;  // somebody looks at uv
  };

  void place(const Mesh& mesh, const Mesh::Triangle& triangle, const TriangleFrame& frame,
             const std::array<float, 3>& weight, const Tracer::Placement& X, const Ray& ray, Surfel& surfel) const;
  [[nodiscard]] float open_at(const OpenMap& map, const Eigen::Vector3f& p_W) const;

  const Scene* scene_;
  std::vector<PartData> parts_;
  std::vector<OpenMap> maps_;
  std::vector<float> open_;
};

}  // namespace cgsr::sim
