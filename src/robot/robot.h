#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/camera.h"
#include "hal/simulation.h"
#include "hal/switches.h"
#include "pipeline/illumination/board.h"
#include "pipeline/motion_loop.h"
#include "pipeline/vision_loop.h"
#include "platform/clock.h"
#include "platform/stop.h"
#include "src/config/robot.h"
#include "src/robot/housekeeping_task.h"
#include "src/robot/links.h"
#include "src/robot/switch_task.h"

namespace cgsr::robot {

/// What the command line adds to a robot's file.
struct RunOptions {
  bool dry_run = false;
  bool arm = false;
  double duration_s = 0.0;  ///< 0: until the images end or a signal comes.
  std::string csv;
  std::string video;
  Witness witness = nullptr;  ///< for the lab; lock-step only.
};

/// A robot, put together from its file: devices, loops and what connects them. Boot order: camera, model, schedule, stages, outputs, base,
/// switches; what fails is said and nothing behind it is touched.
class Robot {
 public:
  static Result<std::unique_ptr<Robot>> build(const config::Robot& config, const RunOptions& options);
  ~Robot();
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  /// Runs until the images end, the duration is over or `stop` is requested; zero is the last command in any case.
  Result<void> run(StopRequest& stop);

  [[nodiscard]] const config::Robot& config() const { return config_; }
  [[nodiscard]] const hal::CameraMode& camera_mode() const { return mode_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// What the robot does without, and why.
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }
  [[nodiscard]] const runtime::Schedule& schedule() const { return runner_->schedule(); }
  [[nodiscard]] const Links& links() const { return links_; }
  [[nodiscard]] HousekeepingTask& housekeeping() { return *housekeeping_; }

 private:
  Robot(const config::Robot& config, const RunOptions& options);

  Result<void> open_camera();
  Result<void> open_simulation();
  Result<ImageLease> first();
  Result<color::ColorModel> learn_or_load();
  Result<void> make_tracker(VisionParts& parts, std::optional<behavior::LearnedSize>& size);
  Result<void> make_whereabouts(VisionParts& parts);
  Result<void> make_light(VisionParts& parts);
  Result<void> read_calibration();
  Result<void> read_board();
  Result<void> do_without(const std::string& problem);
  Result<void> make_loops();
  Result<void> open_outputs();
  Result<void> open_base();
  [[nodiscard]] std::unique_ptr<hal::Drive> make_drive();
  [[nodiscard]] std::unique_ptr<hal::Switches> make_switches();
  [[nodiscard]] SwitchLines lines() const { return {config_.switches.arming_line, config_.switches.lamps()}; }

  void run_lock_step(StopRequest& stop);
  Result<void> leave_pose_for_next_run() const;
  Result<void> run_live(StopRequest& stop);
  /// \return what became of the camera. To be asked before the camera is told to stop, which counts as lost too.
  [[nodiscard]] Result<void> camera_outcome() const;

  config::Robot config_;
  RunOptions options_;
  RealClock real_clock_;
  SimulatedClock stamp_clock_;
  std::unique_ptr<hal::Simulation> simulation_;  // null with real devices and recordings; outlives its devices
  MonoTime first_due_{};                         // when the first image for the loops is there
  std::unique_ptr<hal::Camera> camera_;          // before everything that holds leases, so that it goes after them
  hal::CameraMode mode_;
  std::optional<geometry::Camera> camera_model_;  // as calibrated, in the size of the images that come
  geometry::Pose X_RC_ = geometry::Pose::Identity();
  std::optional<illumination::Board> board_;
  Links links_;
  std::vector<std::string> notes_;
  std::vector<std::string> problems_;
  std::unique_ptr<runtime::StageRunner> runner_;
  std::unique_ptr<VisionLoop> vision_;
  std::unique_ptr<MotionLoop> motion_;
  std::unique_ptr<hal::Switches> switches_;
  std::unique_ptr<HousekeepingTask> housekeeping_;
};

}  // namespace cgsr::robot
