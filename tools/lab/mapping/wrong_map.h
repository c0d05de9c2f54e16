#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "pipeline/mapping/elastic_map.h"
#include "pipeline/mapping/obj_map.h"
#include "tools/lab/localization/place.h"

namespace cgsr::lab {

/// How a map is wrong.
enum class MapError : std::uint8_t {
  kParts,    ///< every part as a whole: what a person measures wrong.
  kCorners,  ///< every corner by itself.
  kNone,
};

constexpr std::string_view to_string(MapError error) {
  switch (error) {
    case MapError::kParts:
      return "each part off";
    case MapError::kCorners:
      return "each corner off";
    case MapError::kNone:
      return "right";
  }
  return "";
}

/// A straight line in space.
struct Line {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();

  [[nodiscard]] double distance_to(const Eigen::Vector3d& p) const;
};

/// A home's map as it was measured wrongly, and where its corners really are.
struct WrongMap {
  mapping::ObjMap file;
  mapping::ElasticMap elastic;
  std::vector<Eigen::Vector3d> true_corners;  ///< of `elastic`, W [m].
  std::string moved;               ///< the thing that the map has half a metre beside where it stands; empty: none.
  std::vector<Line> moved_edges;   ///< where its edges really are.
  std::vector<bool> moved_corner;  ///< of `elastic`.
};

/// \param sigma_m  of the error along each axis.  \param move_chair  also has the map a piece of furniture half a metre off.
Result<WrongMap> wrong_map(const Place& place, MapError error, double sigma_m, bool move_chair, std::uint32_t seed,
                           const mapping::RefineParameters& parameters);

/// The outlines of all that stands in a place, map or not.
std::vector<Line> outlines_of(const sim::Scene& scene);

}  // namespace cgsr::lab
