#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "pipeline/render/surface_raster.h"
#include "pipeline/render/view.h"
#include "pipeline/shade/ball_in_shade.h"
#include "pipeline/shade/mask_growth.h"
#include "pipeline/shade/shade_parameters.h"
#include "pipeline/shade/silhouettes.h"
#include "platform/work_budget.h"

namespace cgsr::shade {

/// The two masks of shaded regions for one lamp, one byte a cell, 0 or 255, over the camera's image (lens included). A point counts as shaded
/// when the map hides the lamp's centre from it.
struct ShadeMasks {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> surface_shaded;   ///< the first surface of the map along the ray of the cell's middle is.
  std::vector<std::uint8_t> possibly_shaded;  ///< some point between the camera and that surface is. Holds the first.
};

/// What pose and lamp may be off by.
struct ShadeErrors {
  Eigen::Matrix3d lamp = Eigen::Matrix3d::Zero();        ///< covariance of p_WL, m^2.
  geometry::Matrix6d pose = geometry::Matrix6d::Zero();  ///< of the step from X_WC (geometry::moved), m and rad.
};

/// A ball as an image shows it.
struct BallInImage {
  Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();  ///< the pixel (x, y) has its middle at (x, y).
  double radius_px = 0.0;                               ///< of the circle that its outline is taken for.
  double radius_m = 0.0;                                ///< its own.
};

/// Shaded regions of the map (5.2) by shadow volumes, clipped by the map's depth.
///
/// The first mask asks for each cell's own ray, through the lens, whether the lamp sees where it ends (LampView). The second adds the sides of
/// the volumes: behind each silhouette edge that the lamp sees, away from it, what bounds the shade until it falls on something. Where a side stands
/// before the map's first surface, the ray passes through shade; it does so without a side only when it begins or ends there. So nothing needs
/// to be counted, volumes need no caps, and a camera inside of one is no special case.
///
/// What depends on lamp and map alone is kept while the lamp stays; with the same pose and camera as before the masks are kept as well. A new place
/// of the lamp costs many times a look: prepare() spreads it over images, and the place before stays until it is done.
class ShadowVolumes {
 public:
  /// \param map  outlives it.
  ShadowVolumes(const world::Map& map, const ShadeParameters& parameters);

  /// \param p_WL  the lamp's centre.  \param widen_cells  both masks grow by so many cells in every direction: what the errors of pose and lamp
  ///        move a shadow's border by.  \return the masks, until the next call. Allocates nothing.
  const ShadeMasks& look(const geometry::Pose& X_WC, const geometry::Camera& camera, const Eigen::Vector3d& p_WL,
                         int widen_cells = 0);

  /// The same, with the second mask widened by what the errors of lamp, pose and map may move its borders by, and by some of a cell, for a cell is
  /// marked by its middle alone; the first stays as it is.
  const ShadeMasks& look(const geometry::Pose& X_WC, const geometry::Camera& camera, const Eigen::Vector3d& p_WL,
                         const ShadeErrors& errors);

  /// Whether some of a ball may lie in shade where its size says that it is: one place, where a mask speaks of a whole ray, of which some point may be
  /// shaded far before the ball. With pose, camera and errors of the last look(), and the lamp that is prepared. Ours; the dissertation has
  /// the masks alone. \return true before the first look() as well.
  [[nodiscard]] bool may_be_shaded(const BallInImage& ball) const;

  /// Whether all of it lies in shade, wherever it may be. \return false before the first look().
  [[nodiscard]] bool is_shaded(const BallInImage& ball) const;

  /// Computes what depends on the lamp's place, a unit (Silhouettes::work_unit) for each grant, and goes on from there when called again with the
  /// same place. \return whether it is complete: look() at this place is then as cheap as at the last one. What is not complete leaves the place
  /// before prepared.
  bool prepare(const Eigen::Vector3d& p_WL, WorkBudget& budget);

  /// The lamp's place that is prepared, and the one that is being prepared; infinite: none.
  [[nodiscard]] const Eigen::Vector3d& lamp() const { return p_WL_; }
  [[nodiscard]] const Eigen::Vector3d& next_lamp() const { return p_WL_next_; }

  /// Stretches of edges that bound volumes, for the lamp that is prepared.
  [[nodiscard]] std::size_t silhouettes() const { return lamps_[now_].sides().size(); }

 private:
  /// The ray of a cell's middle.
  struct Ray {
    float u;  ///< where it passes the raster, cells.
    float v;
    float x;  ///< its ideal coordinates.
    float y;
    std::uint32_t around;   ///< the upper left of the four cells around it, in the buffer.
    std::uint32_t nearest;  ///< cell, in sides_.
  };
  /// Where a ray ends.
  struct End {
    std::uint32_t triangle = render::DepthBuffer::kNothing;
    std::uint32_t seen = LampView::kSeveral;  ///< by the lamp, around it.
    std::uint8_t shaded = 0;

    [[nodiscard]] bool like(const End& other) const {
      return triangle == other.triangle && seen == other.seen && seen != LampView::kSeveral && shaded == other.shaded;
    }
  };
  /// A side behind its edge: from both of its ends away from the lamp.
  struct Strip {
    Eigen::Vector3f a;
    Eigen::Vector3f b;
    Eigen::Vector3f to_a;  ///< from the lamp.
    Eigen::Vector3f to_b;

    /// The corners between two multiples of the way to the edge.
    [[nodiscard]] std::array<Eigen::Vector3f, 4> between(float from, float to) const;
  };
  /// Where a part of a strip begins or ends: multiple of the way to the edge, and what its corners may be off by, cells.
  struct PartEnd {
    float times;
    float least;
    float most;
  };
  /// The image's axes and the view's, in W.
  struct Axes {
    Eigen::Vector3f right = Eigen::Vector3f::UnitX();
    Eigen::Vector3f down = Eigen::Vector3f::UnitY();
    Eigen::Vector3f ahead = Eigen::Vector3f::UnitZ();
    Eigen::Vector3f p_WC = Eigen::Vector3f::Zero();
    float cells = 0.0F;  ///< of the masks, per tangent.
  };

  const ShadeMasks& look(const geometry::Pose& X_WC, const geometry::Camera& camera, const Eigen::Vector3d& p_WL,
                         int widen_cells, const ShadeErrors* errors);
  [[nodiscard]] UncertainBall place_of(const BallInImage& ball) const;
  void take_camera(const geometry::Camera& camera);
  void mark_sides(const Eigen::Vector3f& p_WL);
  void draw_side(const Silhouettes::Side& side, const Eigen::Vector3f& p_WL);
  [[nodiscard]] PartEnd end_of(const Strip& strip, float times) const;
  void draw_part(const Strip& strip, const render::DepthPlane& plane, const PartEnd& from, const PartEnd& to);
  [[nodiscard]] float moved_cells(const Eigen::Vector3f& p_W, float times) const;
  void write_masks();
  void mark_outlines();
  void shade_surfaces();
  void follow(const Ray& ray, std::uint32_t triangle, End& end) const;
  [[nodiscard]] std::uint32_t seen_around(const Ray& ray) const;
  [[nodiscard]] std::uint32_t seen_at(const Ray& ray) const;

  ShadeParameters parameters_;
  render::ViewKeeper views_;
  const render::View* view_;
  render::SurfaceRaster surfaces_;
  render::DepthBuffer buffer_;
  std::array<Silhouettes, 2> lamps_;  ///< what is looked at, and what is being prepared.
  std::size_t now_ = 0;               ///< the first of them.
  std::vector<Ray> rays_;
  std::vector<End> ends_;
  std::vector<std::uint8_t>
      sides_;  ///< of the raster: a volume's side stands before the surface; the bit says how uncertain its place is.
  MaskGrowth growth_;
  ShadeMasks masks_;
  bool valid_ = false;
  geometry::Pose X_WC_ = geometry::Pose::Identity();
  geometry::Camera camera_;
  inline static const Eigen::Vector3d kNowhere = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d p_WL_ = kNowhere;        ///< that is prepared,
  Eigen::Vector3d p_WL_next_ = kNowhere;   ///< that is being prepared,
  Eigen::Vector3d p_WL_drawn_ = kNowhere;  ///< of the masks.
  int widened_ = 0;
  bool uncertain_ = false;
  ShadeErrors errors_;
  Axes axes_;
  Eigen::Vector3f from_lamp_ = Eigen::Vector3f::Zero();  ///< to the camera.
};

}  // namespace cgsr::shade
