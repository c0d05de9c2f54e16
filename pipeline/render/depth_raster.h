#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/render/depth_buffer.h"
#include "pipeline/render/edge_line.h"
#include "pipeline/render/expectation.h"
#include "pipeline/render/raster_parameters.h"
#include "pipeline/render/sphere_groups.h"
#include "pipeline/render/surface_raster.h"
#include "pipeline/render/view.h"

namespace cgsr::render {

/// The budget path of the expectation: surfaces into a small depth buffer that also knows whose each cell is, edges sampled against it, ends
/// of visible pieces found by halving. Ours; the dissertation (4.2) uses OpenGL.
///
/// The buffer only says which triangles may hide a sample: those of the four cells around it. Whether one does is then decided with its own
/// outline and plane, at the sample's own place. So neither the raster's coarseness nor a surface's slope needs a bias: creases, silhouettes and
/// tape a hair above the floor survive, and what is a little behind does not.
class DepthRaster : public Expectation {
 public:
  /// \param map  outlives it.
  DepthRaster(const world::Map& map, const RasterParameters& parameters);

  /// Pieces end where the lens of `camera` sees no further, which may be a little outside of the image without lens. A vector without any
  /// capacity is given one first; otherwise nothing allocates.
  void look(const geometry::Pose& X_WC, const geometry::Camera& camera, std::vector<VisiblePiece>& pieces) override;

  [[nodiscard]] bool covers(const Eigen::Vector2f& pixel) const override;

  /// What the last look drew: the map's triangle that is seen in each cell of `view()`.
  [[nodiscard]] const DepthBuffer& buffer() const { return buffer_; }
  [[nodiscard]] const View& view() const { return *view_; }

  /// Draws the surfaces alone: buffer() then holds them.
  void draw(const geometry::Pose& X_WC, const geometry::Camera& camera);

 private:
  struct Line : EdgeLine {
    std::array<std::uint32_t, 2> own{};  ///< surfaces that cannot hide it.
    float nearer = 1.0F;                 ///< factor on its 1/Z.
  };

  void look_at_edge(std::uint32_t edge);
  [[nodiscard]] bool visible(const Line& line, float s) const;
  [[nodiscard]] float last_visible(const Line& line, float seen, float hidden, float precision) const;
  void keep_longest(std::size_t capacity);

  const world::Map& map_;
  RasterParameters parameters_;
  ViewKeeper views_;
  const View* view_;
  SurfaceRaster surfaces_;
  SphereGroups edges_;
  DepthBuffer buffer_;
  std::vector<VisiblePiece> found_;
  std::vector<float> lengths_;
  Eigen::Vector2f cells_per_px_ = Eigen::Vector2f::Ones();  ///< of the last look's camera,
  Eigen::Vector2f first_cell_ = Eigen::Vector2f::Zero();    ///< where its pixel (0, 0) lies.
  float min_w_ = 0.0F;                                      ///< 1/Z [1/m]: edges are not looked at any further away.
};

}  // namespace cgsr::render
