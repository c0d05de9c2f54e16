#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/camera.h"
#include "hal/simulation.h"
#include "hal/switches.h"
#include "pipeline/illumination/board.h"
#include "pipeline/motion/motion_loop.h"
#include "pipeline/vision_loop.h"
#include "platform/clock.h"
#include "platform/stop.h"
#include "src/config/robot.h"
#include "src/sinks/fan_out.h"
#include "src/sinks/statistics_sink.h"
#include "src/sinks/truth_sink.h"
#include "src/tasks/housekeeping_task.h"
#include "src/tasks/links.h"
#include "src/tasks/switch_task.h"
#include "src/tasks/vision_task.h"

namespace cgsr::boot {

/// The exit code of a program that a signal ends while it loads, as cgsr's other commands answer a signal before their end. Ours.
inline constexpr int kInterruptedWhileLoading = 3;

/// What the command line adds to a robot's file.
struct RunOptions {
  bool dry_run = false;
  bool arm = false;
  double duration_s = 0.0;  ///< 0: until the images end or a signal comes.
  std::string csv;
  std::string video;
  std::string trace;
  std::string recording;
  bool record_images = false;  ///< also where people are identified, whose pictures a recording leaves out otherwise.
  std::string status;          ///< rewritten every second for `cgsr top`.
  bool profile = false;        ///< the summary has a key "profile".
  sinks::FrameObserver observer = nullptr;  ///< for the lab; of a simulated robot in lock-step only.
  StopRequest* wait_for_devices =
      nullptr;  ///< a late device of this computer is waited for until it is requested; null: refused.
};

/// What a robot is to be.
struct Setup {
  config::Robot config;
  RunOptions options;

  [[nodiscard]] bool live() const { return config.run.pace == config::Pace::kLive; }
};

struct Clocks {
  RealClock real;
  SimulatedClock stamps;  ///< in lock-step the stamps of the images are the time.
};

/// The devices, each started.
struct Devices {
  std::unique_ptr<hal::Simulation> simulation;  ///< null: none of the devices is simulated. Outlives them.
  MonoTime simulation_origin{};                 ///< live: the clock's time at which the simulation's is 0.
  std::unique_ptr<hal::Camera> camera;
  hal::CameraMode mode;
  MonoTime next_due{};  ///< when the next image is there, in lock-step.
  std::unique_ptr<MotionLoop> base;
  std::unique_ptr<hal::Switches> switches;

  ~Devices();
};

/// Camera, mount and probe board, as far as the robot's file names them.
struct Calibration {
  std::optional<geometry::Camera> camera;  ///< in the size of the images that come.
  geometry::Pose X_RC = geometry::Pose::Identity();
  std::optional<illumination::Board> board;
};

/// The loop of the vision thread and what it is fed with.
struct Vision {
  std::shared_ptr<const world::Map> map;      ///< null: none.
  std::optional<color::ColorModel> model;     ///< of a file; none: it is learned from the first image, or not needed.
  std::optional<person::FaceTrainer> people;  ///< who is enrolled, until a recogniser takes it; none: nobody is.
  std::optional<person::FaceDetector> face_detector;  ///< while booting; afterwards it is the stage's.
  VisionParts parts;                                  ///< while booting; afterwards they are the loop's.
  std::optional<behavior::LearnedSize> learned;
  std::unique_ptr<runtime::StageRunner> runner;
  std::unique_ptr<VisionLoop> loop;
};

/// Who reads what the robot says.
struct Outputs {
  sinks::FanOut sinks;
  const sinks::StatisticsSink* statistics = nullptr;
  const sinks::TruthSink* truth = nullptr;  ///< null: nobody knows it.
};

/// What there is to say after booting, for people.
struct BootReport {
  std::vector<std::string> notes;
  std::vector<std::string> problems;         ///< what the robot does without, and why.
  std::vector<std::string> missing_devices;  ///< problems of devices of this computer, which a service would wait for.
};

/// Everything that a robot is made of. The order of the members is the order of their lifetimes: leases and threads go before what they
/// point to.
struct RobotState {
  Setup setup;
  Clocks clocks;
  BootReport report;
  Devices devices;
  Calibration calibration;
  tasks::Links links;
  Vision vision;
  Outputs outputs;
  std::optional<EndAtOnceOnSignals> loading;  ///< while a step of the boot does what cannot be interrupted.

  /// The next image before the loops run: what is learned from, or where a marker is looked for. Damaged images are passed
  /// over, for 5 s or, in lock-step, 30 images; a service waits until a stop is requested. Live, a stop signal ends the wait within
  /// 0.1 s and is an error: the camera is then closed in order, whatever else `loading` says.
  Result<ImageLease> first_image();
  [[nodiscard]] tasks::SwitchLines lines() const {
    return {setup.config.switches.arming_line, setup.config.switches.lamps()};
  }
  /// What vision keeps of the world beside the images.
  [[nodiscard]] tasks::VisionSurroundings surroundings() const;
};

}  // namespace cgsr::boot
