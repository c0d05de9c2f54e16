#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/pose.h"
#include "pipeline/localization/correction.h"
#include "pipeline/localization/segment_table.h"

namespace cgsr::mapping {

/// An image of the drive: what was perceived in it, and from where it was taken.
struct View {
  std::int64_t number = 0;                           ///< of the image.
  geometry::Pose X_WC = geometry::Pose::Identity();  ///< as it is believed now.
  localization::Prior given;                         ///< as it was given.
  std::optional<geometry::Pose>
      X_CB;  ///< this camera in the frame of the view before, by odometry; nothing: it does not say.
  localization::SegmentTable edges{0};
};

/// A perceived line that a stretch of a map's edge was matched with: both of the stretch's ends lie on it (Eq. 4.1).
struct LineMatch {
  std::uint32_t view = 0;         ///< index of the View.
  std::uint32_t edge = 0;         ///< of the map.
  std::array<double, 2> along{};  ///< places of the ends on the edge: 0 at its first vertex, 1 at its second.
  Eigen::Vector2d normal = Eigen::Vector2d::UnitY();  ///< of the line, unit, pixels of the camera without lens.
  double offset_px = 0.0;
  double sigma_px = 1.0;
  double weight = 1.0;  ///< how sure it is that the line is the edge's, 0..1.
};

/// The end of a perceived line, and the corner of the map at which the edge that it was matched with ends: how far along the line that is.
struct EndMatch {
  std::uint32_t view = 0;    ///< index of the View.
  std::uint32_t corner = 0;  ///< of the ElasticMap.
  Eigen::Vector2d direction =
      Eigen::Vector2d::UnitX();  ///< of the expected edge, unit, pixels of the camera without lens.
  double offset_px = 0.0;        ///< of the line's end along that.
  double weight = 1.0;           ///< how sure it is that the line is the edge's, 0..1.
};

/// How often a map's edge was to be seen, and was.
struct EdgeSeen {
  int expected = 0;
  int matched = 0;
};

}  // namespace cgsr::mapping
