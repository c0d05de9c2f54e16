#include "src/devices/listing.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "hal/socketcan/controller_state.h"
#include "hal/v4l2/controls.h"
#include "hal/v4l2/formats.h"

namespace cgsr::devices {
namespace {

using hal::v4l2::OfferedFormat;
using hal::v4l2::OfferedSize;

std::string rates_text(const OfferedSize& size) {
  std::string text;
  for (const double rate_hz : size.rates_hz) text += fmt::format("{}{:.3g}", text.empty() ? " at " : ", ", rate_hz);
  return text.empty() ? text : text + " Hz";
}

/// The format that suits colour vision best, and a size near what the stages are scheduled for.
std::string selecting_lines(const hal::v4l2::CameraNode& node, const std::vector<OfferedFormat>& formats) {
  std::string text =
      fmt::format("  camera.kind = \"v4l2\"\n  camera.v4l2.device = \"{}\"\n", node.id.empty() ? node.path : node.id);
  const auto offers = [&formats](std::uint32_t fourcc) -> const OfferedFormat* {
    const auto found = std::ranges::find(formats, fourcc, &OfferedFormat::fourcc);
    return found == formats.end() ? nullptr : &*found;
  };
  const OfferedFormat* format = offers(V4L2_PIX_FMT_YUYV);
  if (format == nullptr) {
    format = offers(V4L2_PIX_FMT_MJPEG);
    if (format == nullptr) return "  (neither YUYV nor MJPG: this program cannot read its images)\n";
    text += "  camera.v4l2.format = \"mjpeg\"\n";
  }
  const auto fits = [](const OfferedSize& size) { return size.holds(640, 480); };
  if (format->sizes.empty() || std::ranges::any_of(format->sizes, fits)) return text;
  const OfferedSize& other = format->sizes.front();
  return text + fmt::format("  camera.v4l2.width_px = {}\n  camera.v4l2.height_px = {}\n", other.max_width_px,
                            other.max_height_px);
}

std::string state_text(const hal::socketcan::CanInterface& interface) {
  if (!interface.up) return "down";
  if (!interface.link.known) return "up, virtual or without a report of its state";
  constexpr const char* kStates[] = {"active", "warning", "passive", "off the bus", "stopped"};
  const auto state = static_cast<std::size_t>(hal::socketcan::to_state(interface.link.can_state));
  return fmt::format("up, {}, {} bit/s", kStates[state], interface.link.bit_rate);
}

}  // namespace

std::string camera_text(const hal::v4l2::CameraNode& node, hal::v4l2::VideoDevice& device) {
  if (const int error = device.open(node.path); error != 0) {
    return fmt::format("{}  {}: {}\n", node.path, node.name, std::generic_category().message(error));
  }
  const auto facts = hal::v4l2::facts_of(device);
  if (!facts || !facts->captures) {
    device.close();
    return {};
  }
  const auto formats = hal::v4l2::offered_formats(device);
  std::string text = fmt::format("{}  {} ({})\n", node.path, facts->card, facts->driver);
  if (!node.id.empty()) text += fmt::format("  id {}\n", node.id);
  if (!node.port.empty()) text += fmt::format("  port {}\n", node.port);
  for (const auto& format : formats) {
    text += fmt::format("  {} ({})\n", hal::v4l2::fourcc_text(format.fourcc), format.name);
    for (const auto& size : format.sizes) {
      text += fmt::format("    {}{}\n", hal::v4l2::to_string(size), rates_text(size));
    }
  }
  for (const auto& control : hal::v4l2::offered_controls(device)) {
    text += fmt::format("  {} = {} ({} to {} in steps of {})\n", control.name, control.value, control.minimum,
                        control.maximum, control.step);
  }
  device.close();
  return text + "  selected by\n" + selecting_lines(node, formats);
}

std::string can_text(const hal::socketcan::CanInterface& interface) {
  return fmt::format(
      "{}  {}{}\n  selected by\n  base.kind = \"rmp\"\n  base.can = \"socketcan\"\n"
      "  base.socketcan.interface = \"{}\"\n",
      interface.name, state_text(interface), interface.driver.empty() ? "" : fmt::format(" ({})", interface.driver),
      interface.name);
}

std::string lines_text(const std::vector<hal::gpiod::ListedLine>& lines) {
  std::string text;
  std::string chip;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& line = lines[i];
    if (line.chip != chip) text += fmt::format("{}\n", line.chip);
    chip = line.chip;
    const auto plain = [&chip](const auto& other) {
      return other.chip == chip && other.name.empty() && other.consumer.empty();
    };
    std::size_t last = i;
    while (plain(line) && last + 1 < lines.size() && plain(lines[last + 1])) ++last;
    const std::string wish = line.name.empty() ? fmt::format("{}:{}", line.chip, line.offset) : line.name;
    if (last > i) {
      text += fmt::format("  {}:{} to {}  without names\n", chip, line.offset, lines[last].offset);
    } else {
      text += fmt::format("  {}:{}  {}  {}{}  switches.arming_line = \"{}\"\n", chip, line.offset,
                          line.name.empty() ? "(no name)" : line.name, line.output ? "output" : "input",
                          line.consumer.empty() ? "" : fmt::format(", used by {}", line.consumer), wish);
    }
    i = last;
  }
  return text;
}

}  // namespace cgsr::devices
