#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipeline/stages/probes_stage.h"
#include "platform/error.h"
#include "src/commands/light_setup.h"
#include "src/input/image_input.h"
#include "src/input/pose_file.h"

namespace cgsr::app {

struct LightOptions {
  std::string config;
  std::string camera;
  std::string mount;  ///< a robot.toml of `cgsr sim export` or `cgsr calibrate mount`; empty: what `config` says.
  std::string input;
  std::string pose;
  std::string csv;
  bool force = false;
};

/// The work of `cgsr light`: the stage that finds lamps, an image at a time.
class LightRun {
 public:
  static Result<LightRun> open(const LightOptions& options);

  /// \return false at the end of the images.
  Result<bool> step();
  Result<void> finish();

  [[nodiscard]] int images() const { return images_; }
  [[nodiscard]] int answered() const { return answered_; }
  /// \return why the last image without a lamp had none.
  [[nodiscard]] std::string_view last_cause() const { return last_cause_; }
  [[nodiscard]] const config::Light& config() const { return config_; }
  /// For the terminal: where lamps are, and what was in the way.
  [[nodiscard]] std::vector<std::string> summary() const;

 private:
  LightRun(const LightOptions& options, LightSetup setup, std::vector<PoseRow> poses);

  /// \return the row of the robot's pose of an image; null: there is none.
  [[nodiscard]] const PoseRow* pose_of(int frame) const;
  /// Adds an image's rows. \return whether it shows a lamp.
  bool add_rows(int frame, const geometry::Pose* X_WR);

  LightOptions options_;
  config::Light config_;
  ImageInput input_;
  std::vector<PoseRow> poses_;
  stages::ProbesStage stage_;
  stages::LampReport report_;  // of the last image
  std::vector<int> causes_;    // images by ObservationStatus
  int without_a_cone_ = 0;     // images in which a probe of the board was not found
  std::string rows_;
  std::string_view last_cause_;
  std::vector<std::string> problems_;
  int images_ = 0;
  int answered_ = 0;
};

}  // namespace cgsr::app
