#include "hal/v4l2/find_camera.h"

#include <libudev.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace cgsr::hal::v4l2 {
namespace {

struct Release {
  void operator()(udev* context) const { udev_unref(context); }
  void operator()(udev_enumerate* list) const { udev_enumerate_unref(list); }
  void operator()(udev_device* device) const { udev_device_unref(device); }
};

std::string text(const char* value) {
  return value == nullptr ? std::string{} : std::string{value};
}

int number_of(const std::string& path) {
  const auto digits = path.find_last_not_of("0123456789") + 1;
  return digits < path.size() && path.size() - digits < 6 ? std::stoi(path.substr(digits)) : 0;
}

}  // namespace

std::vector<CameraNode> camera_nodes() {
  std::vector<CameraNode> nodes;
  const std::unique_ptr<udev, Release> context(udev_new());
  if (!context) return nodes;
  const std::unique_ptr<udev_enumerate, Release> list(udev_enumerate_new(context.get()));
  if (!list || udev_enumerate_add_match_subsystem(list.get(), "video4linux") < 0 ||
      udev_enumerate_scan_devices(list.get()) < 0) {
    return nodes;
  }
  for (udev_list_entry* entry = udev_enumerate_get_list_entry(list.get()); entry != nullptr;
       entry = udev_list_entry_get_next(entry)) {
    const std::unique_ptr<udev_device, Release> device(
        udev_device_new_from_syspath(context.get(), udev_list_entry_get_name(entry)));
    if (!device) continue;
    const std::string path = text(udev_device_get_devnode(device.get()));
    if (path.rfind("/dev/video", 0) != 0) continue;
    nodes.push_back({path, text(udev_device_get_property_value(device.get(), "ID_SERIAL")),
                     text(udev_device_get_property_value(device.get(), "ID_PATH")),
                     text(udev_device_get_sysattr_value(device.get(), "name"))});
  }
  std::sort(nodes.begin(), nodes.end(),
            [](const CameraNode& a, const CameraNode& b) { return number_of(a.path) < number_of(b.path); });
  return nodes;
}

std::optional<std::string> find_camera(const std::string& wanted) {
  if (wanted.rfind('/', 0) == 0) {
    std::error_code ignored;
    return std::filesystem::exists(wanted, ignored) ? std::optional(wanted) : std::nullopt;
  }
  for (const auto& node : camera_nodes()) {
    if (!wanted.empty() && (node.id == wanted || node.port == wanted)) return node.path;
  }
  return std::nullopt;
}

}  // namespace cgsr::hal::v4l2
