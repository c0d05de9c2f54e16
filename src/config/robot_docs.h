#pragma once

#include <string>

namespace cgsr::config {

/// \return the whole text of docs/config.md.
std::string robot_docs();

}  // namespace cgsr::config
