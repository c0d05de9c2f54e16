#pragma once

#include <string>

#include "platform/error.h"

namespace CLI {
class App;
}

namespace cgsr::app {

/// What the program answers the shell with.
enum ExitCode : int {
  kSuccess = 0,
  kFailure = 1,      ///< the work could not be done; the reason stands on standard error.
  kUsage = 2,        ///< the command line was not understood.
  kInterrupted = 3,  ///< told to stop before the end; what was written until then is readable.
};

// Each subcommand adds its options to the program and, once chosen, leaves its exit code in `exit_code`.
void add_run_command(CLI::App& app, int& exit_code);
void add_calibrate_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_completion_command(CLI::App& app, int& exit_code);
void add_config_command(CLI::App& app, int& exit_code);
void add_devices_command(CLI::App& app, int& exit_code);
void add_learn_command(CLI::App& app, int& exit_code);
void add_track_command(CLI::App& app, int& exit_code);
void add_map_command(CLI::App& app, int& exit_code);
void add_profile_command(CLI::App& app, int& exit_code);
void add_top_command(CLI::App& app, int& exit_code);
void add_people_command(CLI::App& app, int& exit_code);
void add_reproduce_command(CLI::App& app, int& exit_code);
void add_light_command(CLI::App& app, int& exit_code);
void add_localize_command(CLI::App& app, int& exit_code);
void add_shade_command(CLI::App& app, int& exit_code);
void add_sim_command(CLI::App& app, int& exit_code);

// What `calibrate` is made of.
void add_calibrate_camera(CLI::App& calibrate, int& exit_code);
void add_calibrate_mount(CLI::App& calibrate, int& exit_code);
void add_calibrate_probes(CLI::App& calibrate, int& exit_code);
void add_calibrate_odometry(CLI::App& calibrate, int& exit_code);

// What `devices` is made of.
void add_devices_camera(CLI::App& devices, int& exit_code);
void add_devices_base(CLI::App& devices, int& exit_code);

/// Prints `error: …` to standard error. \return kFailure.
int report(const Error& error);

}  // namespace cgsr::app
