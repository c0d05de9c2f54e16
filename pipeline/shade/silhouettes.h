#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/shade/lamp_view.h"
#include "pipeline/shade/shade_parameters.h"
#include "pipeline/world/map.h"

namespace cgsr::shade {

/// What of the shadow volumes (5.2) depends on map and lamp alone: which surfaces are turned to the lamp, and the stretches of the silhouettes that
/// it sees. A new place costs many times a view of it, so it can be computed in steps.
///
/// Threads: one. After construction nothing here allocates.
class Silhouettes {
 public:
  /// A stretch of a silhouette that the lamp sees, and how many times as far as it its shade goes. World frame, metres.
  struct Side {
    Eigen::Vector3f a;
    Eigen::Vector3f b;
    float reach;
  };

  /// \param map  outlives it.
  Silhouettes(const world::Map& map, const ShadeParameters& parameters);

  /// Begins anew. \param p_WL  the lamp's centre.
  void begin(const Eigen::Vector3f& p_WL);
  /// One unit of work, about 0.2 million instructions, a row of cells or an edge more at most. \return whether all is computed.
  bool work_unit();

  /// The rest holds once all is computed.
  [[nodiscard]] const LampView& lamp() const { return lamp_; }
  [[nodiscard]] const std::vector<Side>& sides() const { return sides_; }
  /// \return whether the lamp is on the side of a surface that its normal points to.
  [[nodiscard]] bool in_front_of(std::uint32_t surface) const { return lamp_in_front_[surface] != 0; }

 private:
  std::size_t take_edge(const world::Edge& edge);
  [[nodiscard]] bool bounds_shade(const world::Edge& edge) const;
  [[nodiscard]] float reach_beyond(const Eigen::Vector3f& p_W, const Eigen::Vector3f& along) const;
  [[nodiscard]] float leaves_map_after(const Eigen::Vector3f& p_W) const;

  const world::Map& map_;
  Eigen::AlignedBox3f box_;
  LampView lamp_;
  Eigen::Vector3f p_WL_ = Eigen::Vector3f::Zero();
  std::vector<std::uint8_t> lamp_in_front_;  ///< [surface]
  std::vector<Side> sides_;
  std::size_t next_edge_ = 0;
  bool seen_ = false;  ///< the lamp's view is complete.
};

}  // namespace cgsr::shade
