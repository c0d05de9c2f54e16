#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/v4l2/parameters.h"
#include "hal/v4l2/v4l2_camera.h"
#include "hal/v4l2/video_device.h"
#include "platform/error.h"
#include "platform/image_view.h"
#include "src/devices/luma_histogram.h"

namespace cgsr::devices {

/// What `cgsr devices camera --setup` reaches the kernel through, so that a test can replace it.
struct CameraAccess {
  std::function<std::unique_ptr<hal::v4l2::VideoDevice>()> make_device;
  hal::v4l2::LocateCamera locate;
};

/// Settings that stay, and what the camera sees under them.
struct CameraSetup {
  hal::v4l2::V4l2Parameters parameters;  ///< exposure, gain and white balance fixed as far as the camera can.
  LumaHistogram histogram;
  std::vector<std::string> notes;  ///< what could not be fixed, and what the light lacks; one sentence each.
};

/// Fixes exposure, gain and white balance for what the camera sees now: lets its automatics settle, keeps their white
/// balance and gain, then searches the exposure under which bright parts are bright and not cut off (next_exposure_s),
/// within the camera's range and one period of images.
///
/// \param parameters  device, format, size and rate; the settings are replaced. \param show  called with each image that
/// is judged. \return the setup, or why the camera gives no images. Takes some seconds.
Result<CameraSetup> set_up_camera(hal::v4l2::V4l2Parameters parameters, const CameraAccess& access,
                                  const std::function<void(const ImageView&, const std::string&)>& show);

/// \return the lines of a robot's file that select these settings.
std::string setup_lines(const CameraSetup& setup);

}  // namespace cgsr::devices
