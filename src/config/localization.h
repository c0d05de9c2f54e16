#pragma once

#include <filesystem>

#include "pipeline/localization/correction.h"
#include "pipeline/localization/localizer_parameters.h"
#include "pipeline/localization/pose_tracker.h"
#include "platform/config/reader.h"
#include "platform/error.h"

namespace cgsr::config {

/// How well the camera's pose is known before an image is looked at: standard deviations.
struct PriorParameters {
  double x_m = 0.15;
  double y_m = 0.15;
  double z_m = 0.15;
  double heading_deg = 4.0;
  double tilt_deg = 1.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("x_m", self.x_m, {1e-4, 10.0}, "m", "of the position along the world's x");
    visit.number("y_m", self.y_m, {1e-4, 10.0}, "m", "along its y");
    visit.number("z_m", self.z_m, {1e-4, 10.0}, "m", "of the height; small for a robot on a floor");
    visit.number("heading_deg", self.heading_deg, {0.01, 90.0}, "deg", "about the vertical");
    visit.number("tilt_deg", self.tilt_deg, {0.01, 90.0}, "deg", "about each horizontal axis");
  }

  [[nodiscard]] localization::PriorSigmas sigmas() const {
    constexpr double kRad = 3.14159265358979323846 / 180.0;
    return {x_m, y_m, z_m, heading_deg * kRad, tilt_deg * kRad};
  }
};

/// Chapter 4's own configuration (config/localization/*.toml), whose hash every report of chapter 4 prints. The shipped ones differ in the prior
/// and in how the pose is carried: `floor` for a robot on a floor, `free` for six free numbers.
struct Localization {
  PriorParameters prior;
  localization::LocalizerParameters localizer;
  localization::PoseTrackerParameters tracker;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("prior", self.prior, "What is believed of the pose before the image");
    visit.section("localizer", self.localizer, "How one image corrects a pose (4.2)");
    visit.section("tracker", self.tracker, "How the pose is carried from image to image");
  }
};

/// What config/localization/free.toml says, for a program that runs where no such file is; a test holds them together.
inline Localization six_free_numbers() {
  Localization free;
  free.tracker.floor = false;
  free.tracker.drift_m = 0.005;  // a hand moves without odometry
  free.tracker.drift_deg = 0.5;
  return free;
}

/// \return what the file says, the rest as shipped; six free numbers when `file` is empty; or every problem of the file.
inline Result<Localization> load_localization(const std::filesystem::path& file) {
  if (file.empty()) return six_free_numbers();
  return read_file<Localization>(file, Missing::kTakesDefault);
}

}  // namespace cgsr::config
