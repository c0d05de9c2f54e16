#pragma once

#include <optional>

#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/active_check.h"
#include "pipeline/illumination/lamp.h"
#include "pipeline/illumination/lamp_filter.h"
#include "pipeline/illumination/probe_observation.h"
#include "platform/image_view.h"

namespace cgsr {

/// What one image told about the lamp, and what all of them together say.
struct LampSight {
  bool has_board = false;  ///< else nothing below means anything.
  illumination::ObservationStatus observation = illumination::ObservationStatus::kNoImage;
  bool cone_missing = false;        ///< a probe of the board was not found: nothing here is trusted in this image.
  illumination::LampEstimate seen;  ///< of this image alone, its first lamp, robot frame.
  bool placed = false;              ///< where the robot is was known: this image counts in what follows.
  illumination::LampChange change;
  bool known = false;                      ///< there is a lamp that many images agree on.
  illumination::KnownLamp lamp;            ///< the best known one, world frame; read only when known.
  int lamps = 0;                           ///< how many are known so.
  illumination::CheckReport probes_check;  ///< the probe lamp switched: what that says of board and probes.
  illumination::CheckReport lamp_proof;    ///< the room lamp switched: what that says of the shadows.

  /// A lamp is being switched: what is said of shadows is the last image's before that.
  [[nodiscard]] bool switching() const {
    return probes_check.state == illumination::CheckState::kRunning ||
           lamp_proof.state == illumination::CheckState::kRunning;
  }
  /// No check speaks against what the probes say.
  [[nodiscard]] bool trusted() const;
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

/// The lamps that may be switched to make sure, as an image shows them; none is there by default.
struct CheckedLines {
  illumination::LineState probe_lamp;
  illumination::LineState room_lamp;
};

/// What is needed to check by switching.
struct CheckParameters {
  bool probe_lamp_there = false;
  bool room_lamp_there = false;
  illumination::ProbeLampParameters probe_lamp;
};

/// Chapter 5's first half as the vision loop holds it: probes, one image's lamp, and the lamps of the world. On demand it makes sure by switching a
/// lamp; what a check speaks against is not said any more: the lamp then counts as unknown.
///
/// Threads: one. After construction nothing here allocates.
class WhereIsTheLamp {
 public:
  WhereIsTheLamp(const illumination::Board& board, const illumination::ProbesParameters& probes,
                 const illumination::LampParameters& lamp, const CheckParameters& check = {});

  /// \param image  YUYV or grey, of the camera's size.  \param robot  null: not known; the image then moves no lamp of the world.
  LampSight look(const ImageView& image, const PlacedRobot* robot, const CheckedLines& lines = {});

  /// Wants a check that begins with the next image, if it can; to be asked until it runs. Without the line nothing happens. The robot should stand until
  /// it is over.
  void make_sure(illumination::CheckedLamp lamp) { asked_ = lamp; }
  /// \return the level that the lamp's line should have.
  [[nodiscard]] bool wants_on(illumination::CheckedLamp lamp) const {
    return (lamp == illumination::CheckedLamp::kProbeLamp ? probe_lamp_check_ : room_lamp_check_).wants_on();
  }

 private:
  void begin_check(illumination::CheckedLamp lamp, const PlacedRobot* robot);
  void observe(const ImageView& image, const PlacedRobot* robot, LampSight& sight);

  illumination::LampParameters lamp_;
  illumination::ProbeLampParameters probe_lamp_;
  illumination::ProbeObserver observer_;
  illumination::LampFilter filter_;
  illumination::ActiveCheck probe_lamp_check_;
  illumination::ActiveCheck room_lamp_check_;
  std::optional<illumination::CheckedLamp> asked_;
  LampSight last_;
};

}  // namespace cgsr
