#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/render/depth_buffer.h"
#include "pipeline/render/edge_line.h"
#include "pipeline/render/raster_parameters.h"
#include "pipeline/render/sphere_groups.h"
#include "pipeline/render/view.h"
#include "pipeline/world/map.h"

namespace cgsr::render {

/// Draws a map's surfaces into a depth buffer (4.2) and answers, for the pose that was drawn last, about single triangles at single places.
/// Made for one map, which outlives it; allocates nothing after construction.
class SurfaceRaster {
 public:
  /// Some of a surface's triangles, chosen or left out together.
  struct Part {
    std::uint32_t surface = 0;
    std::uint32_t first = 0;  ///< place in order_.
    std::uint32_t count = 0;
  };

  SurfaceRaster(const world::Map& map, const RasterParameters& parameters);

  /// \param view  of a camera without lens, outlives what is asked later.  \param buffer  of the view's size; cleared first.
  void draw(const geometry::Pose& X_WC, const View& view, DepthBuffer& buffer);

  [[nodiscard]] const View& view() const { return *view_; }
  /// Where the camera is, in W.
  [[nodiscard]] const Eigen::Vector3f& p_WC() const { return p_WC_; }
  [[nodiscard]] const Frustum& frustum() const { return frustum_; }
  /// How far from the camera everything that hides something was drawn (SphereGroups::reach_m).
  [[nodiscard]] float reach_m() const { return in_view_.reach_m(); }

  /// A corner of the map in this view.
  const ViewedCorner& corner(std::uint32_t vertex);

  [[nodiscard]] std::uint32_t surface_of(std::uint32_t triangle) const { return surface_of_[triangle]; }
  /// Of a surface that was drawn.
  [[nodiscard]] const DepthPlane& plane_of(std::uint32_t surface) const { return planes_[surface]; }
  /// Whether the camera is on the side that a drawn surface's normal points to.
  [[nodiscard]] bool from_front(std::uint32_t surface) const { return front_[surface] != 0; }
  /// Whether a triangle that was drawn covers a place of the raster, exactly.
  [[nodiscard]] bool covers(std::uint32_t triangle, float u, float v) const;

  /// Whether the camera may see some of a convex part of a plane: not all of it lies to one side of the view.
  [[nodiscard]] bool may_be_in_view(const std::array<Eigen::Vector3f, 4>& corners) const;

  /// Sets bits where a convex part of a plane stands before what a buffer of this view holds.
  ///
  /// \param corners  in W, metres.  \param lift  1/Z of the plane has to be so many times that of the buffer.  \param mask  a byte a cell.
  void mark(const std::array<Eigen::Vector3f, 4>& corners, const DepthPlane& plane, float lift,
            const DepthBuffer& buffer, std::uint8_t bits, std::vector<std::uint8_t>& mask) const;

  /// The plane n . p = offset of W in this view. \return false: it passes through the camera and is not seen.
  bool plane_in_view(const Eigen::Vector3f& normal, float offset_m, DepthPlane& plane) const;

 private:
  struct Corner : ViewedCorner {
    std::uint32_t look = 0;  ///< by which it was set.
  };

  static std::vector<Part> parts_of(const world::Map& map, std::vector<std::uint32_t>& order);
  void place(const geometry::Pose& X_WC, const View& view);
  void draw_clipped(const std::array<const ViewedCorner*, 3>& corners, const DepthPlane& plane, std::uint32_t triangle,
                    DepthBuffer& buffer) const;

  const world::Map& map_;
  RasterParameters parameters_;
  std::vector<std::uint32_t> order_;  ///< triangles, those of a part together.
  std::vector<Part> parts_;
  SphereGroups in_view_;                   ///< of the parts.
  std::vector<Corner> corners_;            ///< [vertex], as of the look that `look` says.
  std::vector<DepthPlane> planes_;         ///< [surface], likewise.
  std::vector<std::uint8_t> front_;        ///< [surface], likewise.
  std::vector<std::uint32_t> surface_of_;  ///< [triangle]
  View none_;
  const View* view_ = &none_;
  Frustum frustum_;
  Eigen::Matrix3f to_cells_ = Eigen::Matrix3f::Identity();  ///< from W, turned and scaled to homogeneous cells.
  Eigen::Matrix3f R_CW_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3f p_WC_ = Eigen::Vector3f::Zero();
  std::uint32_t look_ = 0;
};

}  // namespace cgsr::render
