#include "hal/socketcan/can_interfaces.h"

#include <net/if.h>
#include <net/if_arp.h>

#include <algorithm>
#include <fstream>
#include <system_error>

namespace cgsr::hal::socketcan {
namespace {

/// \return the number in a file of sysfs, decimal or 0x…; -1: there is none.
long number_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string text;
  if (!(in >> text)) return -1;
  char* end = nullptr;
  const long number = std::strtol(text.c_str(), &end, 0);
  return end == text.c_str() ? -1 : number;
}

}  // namespace

std::vector<CanInterface> can_interfaces(CanSocket& socket, const std::filesystem::path& root) {
  std::vector<CanInterface> found;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(root, ignored)) {
    if (number_in(entry.path() / "type") != ARPHRD_CAN) continue;
    CanInterface interface;
    interface.name = entry.path().filename().string();
    interface.up = (number_in(entry.path() / "flags") & IFF_UP) != 0;
    const auto driver = std::filesystem::read_symlink(entry.path() / "device" / "driver", ignored);
    interface.driver = driver.filename().string();
    interface.link = socket.report(interface.name);
    found.push_back(std::move(interface));
  }
  std::ranges::sort(found, {}, &CanInterface::name);
  return found;
}

}  // namespace cgsr::hal::socketcan
