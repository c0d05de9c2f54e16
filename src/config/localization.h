#pragma once

#include "pipeline/localization/localizer_parameters.h"
#include "pipeline/localization/pose_tracker.h"
#include "src/config/prior.h"

namespace cgsr::config {

/// Chapter 4's own configuration (config/localization/*.toml), whose hash every report of chapter 4 prints. The shipped ones differ in the prior
/// and in how the pose is carried: `floor` for a robot on a floor, `free` for six free numbers.
struct Localization {
  PriorParameters prior;
  localization::LocalizerParameters localizer;
  localization::PoseTrackerParameters tracker;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("prior", self.prior, "The uncertainty of the pose before the image");
    visit.section("localizer", self.localizer, "Correction of a pose with one image (4.2)");
    visit.section("tracker", self.tracker, "Propagation of the pose from image to image");
  }
};

/// What config/localization/free.toml says, for a program that runs where no such file is; a test holds them together.
inline Localization six_free_numbers() {
  Localization free;
  free.tracker.floor = false;
  free.tracker.drift_m = 0.005;  // a hand moves without odometry
  free.tracker.drift_deg = 0.5;
  free.localizer.min_evidence = 0.36;  // a model that is poorer than the thing agrees less with its images
  free.localizer.decision.max_error_log_odds = -1.0;  // mostly a small model from near, of few lines
  return free;
}

}  // namespace cgsr::config
