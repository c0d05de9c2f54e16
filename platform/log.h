#pragma once

#include <string_view>

#include "platform/error.h"

namespace cgsr {

/// Sends spdlog's default logger to standard error from `level` on: one line each with time, level and text. Call it
/// once at boot.
///
/// Logging formats, locks and writes: it is for the service and housekeeping threads. Real-time threads record into
/// rings instead.
/// \param level "trace", "debug", "info", "warning", "error" or "off". \return an error that lists them when it is
///       another word.
Result<void> set_up_log(std::string_view level);

}  // namespace cgsr
