#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/v4l2/parameters.h"
#include "hal/v4l2/video_device.h"

namespace cgsr::hal::v4l2 {

/// A setting that the robot wants of its camera, in the control's own unit.
struct ControlWish {
  std::uint32_t id = 0;
  std::int32_t value = 0;
  std::string name;
  bool required = true;  ///< false: a camera without this control is as good.
};

/// \return what the parameters want, in the order in which a camera takes it: each automatic off before its value, for a
/// value that is written while the automatic runs is ignored (uvcvideo) or undefined.
std::vector<ControlWish> wishes_of(const V4l2Parameters& parameters);

/// Sets each wish and reads it back. \return a sentence for each that did not take effect, with what did.
std::vector<std::string> apply_controls(VideoDevice& device, const std::vector<ControlWish>& wishes);

/// \return whether every wish that the camera has a control for still stands. Some cameras take an exposure only once
/// they stream.
bool all_stand(VideoDevice& device, const std::vector<ControlWish>& wishes);

/// A control that a camera has.
struct OfferedControl {
  std::uint32_t id = 0;
  std::string name;  ///< the driver's words.
  std::int32_t minimum = 0, maximum = 0, step = 1;
  std::int32_t value = 0;
};

/// \return every integer, menu and on/off control, in the driver's order; bounded against lists that never end.
std::vector<OfferedControl> offered_controls(VideoDevice& device);

/// \return the control's value; nothing when the camera has none of that id.
std::optional<std::int32_t> control_value(VideoDevice& device, std::uint32_t id);

/// Leaves exposure, gain and white balance to the camera, as far as it can.
void set_automatic(VideoDevice& device);

}  // namespace cgsr::hal::v4l2
