#pragma once

#include <functional>
#include <optional>

#include "hal/camera.h"
#include "platform/error.h"
#include "platform/time.h"

namespace cgsr::boot {

/// Takes images until one is whole. A camera that has just started may deliver damaged images or none for a while.
///
/// \param next_try  until when the next image is waited for; nullopt gives up.
/// \return the image; what was met instead, with the camera's last problem, after the last try or when the camera is gone or
///         its recording has ended.
Result<ImageLease> first_good_image(hal::Camera& camera, const std::function<std::optional<MonoTime>()>& next_try);

}  // namespace cgsr::boot
