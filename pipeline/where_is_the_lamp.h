#pragma once

#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/lamp.h"
#include "pipeline/illumination/lamp_filter.h"
#include "pipeline/illumination/probe_observation.h"
#include "platform/image_view.h"

namespace cgsr {

/// What one image told about the lamp, and what all of them together say.
struct LampSight {
  bool has_board = false;  ///< else nothing below means anything.
  illumination::ObservationStatus observation = illumination::ObservationStatus::kNoImage;
  illumination::LampEstimate seen;  ///< of this image alone, its first lamp, robot frame.
  bool placed = false;              ///< where the robot is was known: this image counts in what follows.
  illumination::LampChange change;
  bool known = false;            ///< there is a lamp that many images agree on.
  illumination::KnownLamp lamp;  ///< the best known one, world frame; read only when known.
  int lamps = 0;                 ///< how many are known so.
};

/// \return why this image says nothing of a lamp; empty when it says something.
std::string_view reason_of(const LampSight& sight);

/// The robot in the world and how sure that is.
struct PlacedRobot {
  geometry::Pose X_WR = geometry::Pose::Identity();
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  ///< of geometry::moved(X_WR, step).
};

/// \return X_WR and its covariance, from the camera's.
PlacedRobot robot_of(const geometry::Pose& X_WC, const geometry::Matrix6d& camera_covariance,
                     const geometry::Pose& X_CR);

/// Chapter 5's first half as the vision loop holds it: probes, one image's lamp, and the lamps of the world.
///
/// Threads: one. After construction nothing here allocates.
class WhereIsTheLamp {
 public:
  WhereIsTheLamp(const illumination::Board& board, const illumination::ProbesParameters& probes,
                 const illumination::LampParameters& lamp)
      : lamp_(lamp), observer_(board, probes, lamp.height_m - board.X_RB.translation().z()), filter_(board, lamp) {}

  /// \param image  YUYV or grey, of the camera's size.  \param robot  null: not known; the image then moves no lamp of the world.
  LampSight look(const ImageView& image, const PlacedRobot* robot);

 private:
  illumination::LampParameters lamp_;
  illumination::ProbeObserver observer_;
  illumination::LampFilter filter_;
};

}  // namespace cgsr
