#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pipeline/render/edge_line.h"
#include "pipeline/render/expectation.h"
#include "pipeline/render/osmesa_context.h"
#include "pipeline/render/osmesa_parameters.h"
#include "pipeline/render/view.h"
#include "platform/error.h"

namespace cgsr::render {

/// The expectation as the dissertation draws it (4.2): with OpenGL, surfaces into the depth buffer, then every edge in a colour of its own with
/// the depth test on; the picture, read where it was drawn, says by its colours which pieces are visible.
///
/// Surfaces are pushed back by their slope per pixel (glPolygonOffset), so that edges lie before the surfaces that they belong to. The reference
/// for DepthRaster; it costs ten times as much and allocates inside of Mesa.
class OsmesaExpectation : public Expectation {
 public:
  /// \param map  outlives it.  \return an error where Mesa offers no context, or for a map of more than 2^32 - 2 edges.
  /// Takes 0.1 s or more: every state of the frame path is used once, so that no later look pays for it.
  static Result<std::unique_ptr<OsmesaExpectation>> make(const world::Map& map, const OsmesaParameters& parameters);

  ~OsmesaExpectation() override;
  OsmesaExpectation(const OsmesaExpectation&) = delete;
  OsmesaExpectation& operator=(const OsmesaExpectation&) = delete;

  /// As DepthRaster::look.
  void look(const geometry::Pose& X_WC, const geometry::Camera& camera, std::vector<VisiblePiece>& pieces) override;

 private:
  OsmesaExpectation(const world::Map& map, const OsmesaParameters& parameters, std::unique_ptr<OsmesaContext> context);

  void upload();
  void draw(const geometry::Pose& X_WC);
  void draw_surfaces(const Eigen::Vector3f& p_WC) const;
  void find_pieces(std::uint32_t edge, std::vector<VisiblePiece>& pieces) const;
  [[nodiscard]] bool shown(std::uint32_t edge, float s) const;

  const world::Map& map_;
  OsmesaParameters parameters_;
  std::unique_ptr<OsmesaContext> context_;
  ViewKeeper views_;
  const View* view_ = nullptr;
  Eigen::Vector3f middle_ = Eigen::Vector3f::Zero();  ///< of the map.
  float radius_ = 0.0F;
  std::uint32_t vertices_ = 0;  ///< OpenGL's names of buffers.
  std::uint32_t lines_ = 0;
  std::uint32_t colors_ = 0;
  std::vector<EdgeLine> line_;  ///< [edge], of this look; those out of view have no length.
  std::vector<VisiblePiece> found_;
  float depth_far_ = 1.0F;  ///< depth in the buffer = depth_far_ + depth_per_w_ / Z.
  float depth_per_w_ = 0.0F;
  std::span<const std::uint32_t> depths_;
};

}  // namespace cgsr::render
