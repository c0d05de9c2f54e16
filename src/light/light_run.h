#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/illumination/lamp_filter.h"
#include "platform/error.h"
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
};

/// The camera on the robot.
struct MountParameters {
  std::array<double, 3> position_m{0.0, 0.0, 1.2};
  double down_deg = 20.0;
  std::array<double, 3> turn_deg{0.0, 0.0, 0.0};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.numbers("position_m", self.position_m, {-5.0, 5.0}, "m", "of the optical centre, robot frame");
    visit.number("down_deg", self.down_deg, {-90.0, 90.0}, "deg", "how far a camera that looks forward is tilted down");
    visit.numbers("turn_deg", self.turn_deg, {-45.0, 45.0}, "deg",
                  "what calibration says it is turned beside that: a rotation vector, robot frame");
  }
  [[nodiscard]] geometry::Pose X_RC() const;
};

/// A file as config/illumination/lamp-robot.toml.
struct LightConfig {
  MountParameters mount;
  illumination::ProbesParameters probes;
  illumination::LampParameters lamp;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("mount", self.mount, "The camera on the robot");
    visit.section("probes", self.probes, "Board and probes, and how they are looked at (Alg. 5.1)");
    visit.section("lamp", self.lamp, "What is known of lamps, and how observations become one (Eq. 5.1, 5.2)");
  }
};

/// Takes the probe board that a robot.toml states, where it states one.
Result<void> take_board(const std::string& robot_file, illumination::BoardParameters& board);

/// The work of `cgsr light`, an image at a time.
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
  [[nodiscard]] const LightConfig& config() const { return config_; }
  /// For the terminal: where lamps are, and what was in the way.
  [[nodiscard]] std::vector<std::string> summary() const;

 private:
  /// \return the robot's pose of an image; null: nobody said.
  [[nodiscard]] const geometry::Pose* pose_of(int frame) const;

  LightRun(const LightOptions& options, const LightConfig& config, const illumination::Board& board, ImageInput input,
           std::vector<PoseRow> poses);

  LightOptions options_;
  LightConfig config_;
  ImageInput input_;
  std::vector<PoseRow> poses_;
  illumination::ProbeObserver observer_;
  illumination::LampFilter filter_;
  std::vector<int> causes_;  // images by ObservationStatus
  std::string rows_;
  std::string_view last_cause_;
  std::vector<std::string> problems_;
  int images_ = 0;
  int answered_ = 0;
};

}  // namespace cgsr::app
