#pragma once

#include <cstddef>

#include "pipeline/geometry/pose.h"
#include "pipeline/global_localization/parameters.h"
#include "pipeline/global_localization/turn.h"
#include "pipeline/localization/localizer.h"
#include "platform/work_budget.h"

namespace cgsr::global_localization {

/// The robot's place and heading out of all images of a turn together. One image hardly tells a step aside from a turn; images of all around do, so that one
/// start is enough where one image alone needs many. Expectation and maximisation as for one image (4.1, Eq. 4.1 to 4.5) over six unknowns: place and heading
/// at the first image, and how far the odometry is off in each at the end of a whole turn, evenly from there.
///
/// Allocates nothing.
class TurnFit {
 public:
  /// \param localizer  outlives it; searches for nothing meanwhile.
  TurnFit(localization::Localizer& localizer, const geometry::Pose& X_RC, const GlobalLocalizerParameters& parameters);

  /// \param X_WR  where the robot may have been at the first image, level on the floor, as the comparison of panoramas knows it.
  void begin(const geometry::Pose& X_WR);

  /// Works as far as the budget goes: a look and a round for each image of the turn that a round of the fit takes. \return whether it has come to its end.
  bool go_on(const Turn& turn, WorkBudget& budget);

  /// The robot at an image of the turn, as it leans there.
  [[nodiscard]] geometry::Pose X_WR(const Turn& turn, const Keyframe& keyframe) const;

 private:
  void add(const Turn& turn, const Keyframe& keyframe);
  void step();
  void begin_round();
  [[nodiscard]] float radius_px() const;

  localization::Localizer* localizer_;
  geometry::Pose X_RC_;
  geometry::Pose X_WR_begun_ = geometry::Pose::Identity();
  /// From there: x, y and heading at the first image, and what they are off at the end of a whole turn; metres and radians, axes of W.
  geometry::Vector6d off_ = geometry::Vector6d::Zero();
  geometry::Vector6d prior_information_;
  geometry::Matrix6d information_ = geometry::Matrix6d::Zero();  ///< of this round's distances.
  geometry::Vector6d gradient_ = geometry::Vector6d::Zero();     ///< likewise.
  int round_ = 0;
  std::size_t view_ = 0;
};

}  // namespace cgsr::global_localization
