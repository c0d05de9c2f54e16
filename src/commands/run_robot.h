#pragma once

#include <string>

#include "src/boot/robot_state.h"

namespace cgsr::app {

/// What `cgsr run` and `cgsr profile` take from the command line.
struct RunCommand {
  std::string config = "config/robots/video.toml";
  std::string input;
  std::string model;
  std::string json;
  std::string log_level = "info";
  int seed = -1;
  bool wait_for_devices = false;
  bool force = false;
  boot::RunOptions run;
};

/// Runs the robot in the foreground until its end, and prints what it came to. \return the exit code.
int run_robot(const RunCommand& options);

}  // namespace cgsr::app
