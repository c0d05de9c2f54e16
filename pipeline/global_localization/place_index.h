#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/global_localization/panorama.h"
#include "pipeline/global_localization/parameters.h"
#include "pipeline/localization/expected.h"
#include "pipeline/render/depth_raster.h"
#include "pipeline/world/map.h"
#include "platform/work_budget.h"

namespace cgsr::global_localization {

/// Where a camera looks when the robot heads to azimuth 0, and which elevations it sees within `half_width` of that.
/// \param camera  without lens.
Sector seen_by(const geometry::Camera& camera, const geometry::Pose& X_RC, double half_width);

/// What the map's edges look like from places all over a home, as panoramas. Every other place of a grid comes first, as on a chessboard: in a large home
/// those are enough to say about which places the others matter.
///
/// Cost: 13 units for each place (localization/work.h). Memory: 38 kB a place.
class PlaceIndex {
 public:
  static constexpr int kSides = 3;  ///< to which a place is looked from.

  /// \param map  outlives it.  \param camera  without lens, in the size of the images worked on.  \param X_RC  the mount.
  /// \param places_m  of the robot on the floor, in W.  \param spacing_m  of the grid that they are of.
  PlaceIndex(const world::Map& map, const geometry::Camera& camera, const geometry::Pose& X_RC,
             std::vector<Eigen::Vector2d> places_m, double spacing_m);

  /// Goes on with all places. \param budget  asked before each look at the map. \return whether every place is in the index.
  bool build(WorkBudget& budget);
  /// The same of one place.
  bool build(std::size_t place, WorkBudget& budget);

  [[nodiscard]] std::size_t size() const { return places_m_.size(); }
  /// So many places come first, of which none is next to another one on the grid.
  [[nodiscard]] std::size_t apart() const { return apart_; }
  [[nodiscard]] bool holds(std::size_t index) const { return sides_[index] == kSides; }
  [[nodiscard]] const Eigen::Vector2d& place_m(std::size_t index) const { return places_m_[index]; }
  [[nodiscard]] const Panorama& panorama(std::size_t index) const { return panoramas_[index]; }

 private:
  void look(std::size_t place, int side);

  geometry::Pose X_RC_;
  geometry::Camera wide_;  ///< sees a third of the panorama.
  Sector sector_;          ///< of a look when the robot heads to azimuth 0.
  std::unique_ptr<render::DepthRaster> raster_;
  localization::ExpectedView view_;
  std::vector<render::VisiblePiece> visible_;
  std::vector<Eigen::Vector2d> places_m_;
  std::size_t apart_;
  std::vector<Panorama> panoramas_;
  std::vector<int> sides_;  ///< of each panorama that were looked at.
  std::size_t next_ = 0;
};

}  // namespace cgsr::global_localization
