#pragma once

namespace cgsr::global_localization {

/// Images of a turn stand for so much to either side of where they look: twelve of them see all around.
inline constexpr int kKeyframes = 12;
/// With the one that closes the turn.
inline constexpr int kViews = kKeyframes + 1;

struct GlobalLocalizerParameters {
  double spacing_m = 0.4;    ///< of the grid of places that are compared.
  double clearance_m = 0.2;  ///< of these places from obstacles, for who makes the grid.
  double max_drift_m = 0.3;  ///< a robot that turns on the spot and is farther from where it began begins anew.
  int max_candidates = 4;
  double same_deg = 10.0;          ///< candidates that differ by no more, and are neighbours on the grid, are one.
  double place_sigma_m = 0.08;     ///< of a candidate's place along x and y, as the comparison of panoramas knows it.
  double heading_sigma_deg = 2.5;  ///< of its heading.
  /// How far the odometry may be off at the end of a whole turn, closed by its last image; evenly until then.
  double drift_sigma_m = 0.03;
  double drift_sigma_deg = 5.0;
  double fitted_sigma_m = 0.02;      ///< of the place at an image, fitted to all images of the turn together,
  double fitted_sigma_deg = 0.5;     ///< ... and of the heading.
  double corrected_sigma_m = 0.015;  ///< the same beside the last image that corrected the pose,
  double corrected_sigma_deg = 0.4;  ///< ... and of the heading.
  double turn_sigma_m = 0.03;        ///< the same of a whole turn, when an earlier view of it is seen again.
  double turn_sigma_deg = 1.5;       ///< of the heading then, the turn being closed.
  double min_likeness_share =
      0.85;                     ///< of the best candidate's: others are tried too, although the best one was right.
  int min_corrected = 4;        ///< images of the turn in which the localizer must correct a candidate's pose,
  int min_corrected_alone = 3;  ///< ... and half of those looked at, where no other one is nearly as alike.
  int enough_corrected = 5;  ///< with so many the trial ends, once the last image was among those that were looked at.
  /// Of the edges in the richest image of the turn; poorer images are left out, but six are looked at.
  double min_edges_share = 0.4;
  double max_rival_share = 0.5;  ///< of the best one's share of corrected images, what another place may have.
  double same_m = 0.3;           ///< tried candidates that come this near to each other are one place.
  int max_failed_fitted = 3;     ///< a candidate is given up when none of so many images corrected its fit,
  int max_failed_rival = 2;      ///< ... once a more alike one was corrected in enough of them, when none of so many;
  int max_failed =
      5;  ///< ... the most alike one is looked for about its panorama's place before, up to so many images.
  double max_sigma_m = 0.0167;  ///< the pose is told once it is known as well as this along the floor: a third of 5 cm,
  double max_sigma_deg = 0.5;   ///< ... and its heading to a third of 1.5 degrees.
  double agree_m = 0.04;        ///< two views agree that have the robot no farther apart, over the turn between them,
  double agree_deg = 1.0;       ///< ... nor turned by more.
  double max_settling_turn_deg = 450.0;  ///< to one side, after which no image confirmed the pose,
  int max_settling_images = 900;         ///< ... nor so many of a robot that stands meanwhile.
};

}  // namespace cgsr::global_localization
