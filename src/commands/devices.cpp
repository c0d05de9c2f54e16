// `cgsr devices`: what this computer has, and the lines of a robot's file that select it.
#include <memory>
#include <string>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "hal/gpiod/line_access.h"
#include "hal/socketcan/can_interfaces.h"
#include "hal/socketcan/can_socket.h"
#include "hal/v4l2/find_camera.h"
#include "hal/v4l2/video_device.h"
#include "src/commands/command.h"
#include "src/devices/listing.h"

namespace cgsr::app {
namespace {

std::string or_none(const std::string& text, const char* hint) {
  return text.empty() ? fmt::format("none ({})\n", hint) : text;
}

int list_devices() {
  std::string cameras;
  const auto device = hal::v4l2::make_video_device();
  for (const auto& node : hal::v4l2::camera_nodes()) cameras += devices::camera_text(node, *device);
  std::string buses;
  const auto socket = hal::socketcan::make_can_socket();
  for (const auto& interface : hal::socketcan::can_interfaces(*socket)) buses += devices::can_text(interface);
  const std::string lines = devices::lines_text(hal::gpiod::list_lines());
  fmt::print("Cameras\n{}\nCAN interfaces\n{}\nLines (switches.kind = \"gpiod\")\n{}",
             or_none(cameras, "no /dev/video* delivers images, or udev is not there"),
             or_none(buses, "a USB adapter needs its kernel module; config/network/80-cgsr-can.network brings can0 up"),
             or_none(lines, "no /dev/gpiochip* may be opened"));
  return kSuccess;
}

}  // namespace

void add_devices_command(CLI::App& app, int& exit_code) {
  auto* command =
      app.add_subcommand("devices", "list cameras, CAN interfaces and lines, and the lines of a file that select them");
  command->require_subcommand(0, 1);
  add_devices_camera(*command, exit_code);
  add_devices_base(*command, exit_code);
  command->callback([command, &exit_code] {
    if (command->get_subcommands().empty()) exit_code = list_devices();
  });
}

}  // namespace cgsr::app
