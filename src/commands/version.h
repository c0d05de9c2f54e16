#pragma once

namespace cgsr::app {

inline constexpr const char* kVersion = "0.1.0";

}  // namespace cgsr::app
