// `cgsr devices base --test`: listens to the base; moves it only with --arm, and after a person has confirmed it.
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include "hal/rmp/rmp_drive.h"
#include "platform/clock.h"
#include "platform/stop.h"
#include "src/boot/device_kinds.h"
#include "src/commands/command.h"
#include "src/commands/option_checks.h"
#include "src/config/load.h"
#include "src/devices/base_test.h"

namespace cgsr::app {
namespace {

struct Options {
  bool test = false;
  std::string config;
  std::string interface;
  devices::BaseTestOptions base;
};

bool confirmed(const devices::BaseTestOptions& base) {
  if (isatty(STDIN_FILENO) == 0) {
    fmt::print("no terminal to confirm on: the base is not moved\n");
    return false;
  }
  fmt::print(
      "The base will drive {:.2f} m forward and then turn left by about {:.0f} degrees. Keep the emergency stop at "
      "hand. Type 'move' to start: ",
      base.forward_mps * base.move_s, base.left_radps * base.move_s * 57.3);
  std::fflush(stdout);
  std::string answer;
  return std::getline(std::cin, answer) && answer == "move";
}

int run_test(const Options& options) {
  config::Base base;
  if (!options.config.empty()) {
    const auto robot = config::load_sections(options.config);
    if (!robot) return report(robot.error());
    base = robot->base;
  }
  if (!options.interface.empty()) base.socketcan.interface = options.interface;
  StopRequest stop;
  const StopOnSignals signals(stop);
  RealClock clock;
  hal::rmp::RmpDrive drive(boot::make_socketcan_bus(base.socketcan), base.rmp);
  const devices::BaseTestObserver observer{[](const std::string& line) { fmt::print("{}\n", line); },
                                           [&options] { return confirmed(options.base); },
                                           [&stop] { return stop.requested(); }};
  const auto passed = devices::test_base(drive, base.rmp, clock, options.base, observer);
  return passed ? kSuccess : report(passed.error());
}

}  // namespace

void add_devices_base(CLI::App& devices, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* command = devices.add_subcommand("base", "listen to the Segway: odometry, status, faults");
  command->add_flag("--test", options->test, "listen, show, and send nothing")->required();
  command->add_option("--config", options->config, "a robot's file whose base and scales are taken");
  command->add_option("--interface", options->interface, "the CAN interface instead of the one that the file names");
  command->add_option("--duration", options->base.listen_s, "listen for that many seconds")
      ->check(in_range(0.1, 3600))
      ->capture_default_str();
  command->add_flag("--arm", options->base.arm,
                    "afterwards move a little forward and left, once a person has confirmed it");
  command->callback([options, &exit_code] { exit_code = run_test(*options); });
}

}  // namespace cgsr::app
