#include "hal/v4l2/controls.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace cgsr::hal::v4l2 {
namespace {

int exchange(VideoDevice& device, unsigned long request, std::uint32_t id, std::int32_t& value) {
  v4l2_ext_control control{};
  control.id = id;
  control.value = value;
  v4l2_ext_controls list{};
  list.which = V4L2_CTRL_WHICH_CUR_VAL;
  list.count = 1;
  list.controls = &control;
  const int error = device.control(request, &list);
  value = control.value;
  return error;
}

/// \return the range of the control; nothing when the camera has none, or has switched it off for good.
std::optional<v4l2_queryctrl> range_of(VideoDevice& device, std::uint32_t id) {
  v4l2_queryctrl query{};
  query.id = id;
  if (device.control(VIDIOC_QUERYCTRL, &query) != 0) return std::nullopt;
  if ((query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) return std::nullopt;
  return query;
}

std::string apply_one(VideoDevice& device, const ControlWish& wish) {
  const auto range = range_of(device, wish.id);
  if (!range) {
    return wish.required ? fmt::format("{}: the camera has no such control, {} was requested", wish.name, wish.value)
                         : std::string{};
  }
  std::int32_t value = std::clamp(wish.value, range->minimum, range->maximum);
  const int error = exchange(device, VIDIOC_S_EXT_CTRLS, wish.id, value);
  const auto now = control_value(device, wish.id);
  if (now && *now == wish.value) return {};
  if (!wish.required && !now) return {};
  return fmt::format("{}: {} was requested, {} took effect{} (the camera offers {} to {} in steps of {})", wish.name,
                     wish.value, now ? std::to_string(*now) : "nothing that can be read",
                     error == 0 ? "" : fmt::format(", {}", error_words(error)), range->minimum, range->maximum,
                     range->step);
}

constexpr int kMaxControls = 256;

bool has_a_number(const v4l2_queryctrl& query) {
  return query.type == V4L2_CTRL_TYPE_INTEGER || query.type == V4L2_CTRL_TYPE_BOOLEAN ||
         query.type == V4L2_CTRL_TYPE_MENU;
}

}  // namespace

std::optional<std::int32_t> control_value(VideoDevice& device, std::uint32_t id) {
  std::int32_t value = 0;
  if (exchange(device, VIDIOC_G_EXT_CTRLS, id, value) != 0) return std::nullopt;
  return value;
}

std::vector<OfferedControl> offered_controls(VideoDevice& device) {
  std::vector<OfferedControl> controls;
  v4l2_queryctrl query{};
  for (int i = 0; i < kMaxControls; ++i) {
    query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
    if (device.control(VIDIOC_QUERYCTRL, &query) != 0) break;
    if ((query.flags & V4L2_CTRL_FLAG_DISABLED) != 0 || !has_a_number(query)) continue;
    const auto* end = std::find(std::cbegin(query.name), std::cend(query.name), std::uint8_t{0});
    controls.push_back({.id = query.id,
                        .name = std::string(std::cbegin(query.name), end),
                        .minimum = query.minimum,
                        .maximum = query.maximum,
                        .step = query.step,
                        .value = control_value(device, query.id).value_or(query.default_value)});
  }
  return controls;
}

void set_automatic(VideoDevice& device) {
  // UVC cameras know no exposure but the manual one and the one under aperture priority.
  for (std::int32_t automatic : {V4L2_EXPOSURE_APERTURE_PRIORITY, V4L2_EXPOSURE_AUTO}) {
    std::int32_t value = automatic;
    if (exchange(device, VIDIOC_S_EXT_CTRLS, V4L2_CID_EXPOSURE_AUTO, value) == 0) break;
  }
  for (const std::uint32_t id : {V4L2_CID_AUTOGAIN, V4L2_CID_AUTO_WHITE_BALANCE}) {
    std::int32_t on = 1;
    (void)exchange(device, VIDIOC_S_EXT_CTRLS, id, on);
  }
}

std::vector<ControlWish> wishes_of(const V4l2Parameters& parameters) {
  std::vector<ControlWish> wishes;
  // Never a lower rate in the dark: the robot's schedule counts on the period.
  wishes.push_back({V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0, "constant rate", false});
  wishes.push_back({V4L2_CID_BACKLIGHT_COMPENSATION, 0, "backlight compensation", false});
  if (parameters.power_line_hz != 0) {
    const int setting =
        parameters.power_line_hz == 60 ? V4L2_CID_POWER_LINE_FREQUENCY_60HZ : V4L2_CID_POWER_LINE_FREQUENCY_50HZ;
    wishes.push_back({V4L2_CID_POWER_LINE_FREQUENCY, setting, "power_line_hz", true});
  }
  if (parameters.exposure_s > 0.0) {
    wishes.push_back({V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, "manual exposure", true});
    constexpr double kUnit_s = 100e-6;
    wishes.push_back({V4L2_CID_EXPOSURE_ABSOLUTE,
                      static_cast<std::int32_t>(std::lround(parameters.exposure_s / kUnit_s)), "exposure_s [100 us]",
                      true});
  }
  if (parameters.gain >= 0) {
    wishes.push_back({V4L2_CID_AUTOGAIN, 0, "manual gain", false});
    wishes.push_back({V4L2_CID_GAIN, parameters.gain, "gain", true});
  }
  if (parameters.white_balance_k > 0) {
    wishes.push_back({V4L2_CID_AUTO_WHITE_BALANCE, 0, "manual white balance", true});
    wishes.push_back({V4L2_CID_WHITE_BALANCE_TEMPERATURE, parameters.white_balance_k, "white_balance_k", true});
  }
  return wishes;
}

std::vector<std::string> apply_controls(VideoDevice& device, const std::vector<ControlWish>& wishes) {
  std::vector<std::string> refused;
  for (const auto& wish : wishes) {
    if (auto problem = apply_one(device, wish); !problem.empty()) refused.push_back(std::move(problem));
  }
  return refused;
}

bool all_stand(VideoDevice& device, const std::vector<ControlWish>& wishes) {
  return std::all_of(wishes.begin(), wishes.end(), [&device](const ControlWish& wish) {
    const auto value = control_value(device, wish.id);
    return !value || *value == wish.value;
  });
}

}  // namespace cgsr::hal::v4l2
