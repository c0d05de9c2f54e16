#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hal/socketcan/can_socket.h"

namespace cgsr::hal::socketcan {

/// A CAN interface of this computer.
struct CanInterface {
  std::string name;
  bool up = false;
  std::string driver;  ///< empty: a virtual one.
  LinkReport link;
};

/// \param socket  reports each interface's state. \param root  the kernel's list of network interfaces.
/// \return the CAN interfaces, by name.
std::vector<CanInterface> can_interfaces(CanSocket& socket, const std::filesystem::path& root = "/sys/class/net");

}  // namespace cgsr::hal::socketcan
