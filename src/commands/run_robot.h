#pragma once

#include <optional>
#include <string>

#include "src/boot/robot_state.h"

namespace cgsr::app {

/// Whom `cgsr people follow` follows.
struct FollowedPerson {
  std::string identities;  ///< empty: the identities file that the robot's file names.
  std::string name;        ///< as it stands there; empty: whoever is identified first.
};

/// What `cgsr run` and `cgsr profile` take from the command line.
struct RunCommand {
  std::string config = "config/robots/video.toml";
  std::string input;
  std::string model;
  std::string json;
  std::string log_level = "info";
  int seed = -1;
  std::optional<FollowedPerson> person;  ///< the task is to follow somebody, whatever the robot's file says.
  bool wait_for_devices = false;
  bool force = false;
  boot::RunOptions run;
};

/// Runs the robot in the foreground until its end, and prints what it came to. \return the exit code.
int run_robot(const RunCommand& options);

}  // namespace cgsr::app
