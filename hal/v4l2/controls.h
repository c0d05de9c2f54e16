#pragma once

#include <cstdint>
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

}  // namespace cgsr::hal::v4l2
